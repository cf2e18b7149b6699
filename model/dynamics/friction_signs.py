"""Friction over the cycle: signs of sliding in each segment, and angles at which the guide force changes sides.

Friction reverses with the slider (dead centres), with the rod (where the crank is normal to the slider line) and with
the guide force. The first two are cuts from `segments.cut_cycle`. The third, a kink in every curve, is located here.
"""

from __future__ import annotations

import math
from typing import Any

from ..kernel.arithmetic import STEP, analytic
from ..kinematics.position import motion
from ..machine.mechanism import Mechanism
from .segments import (
    Cuts,
    CycleWindow,
    Segment,
    add_cut,
    angle_identifying_segment,
    crank_angle_from_crowded,
    crowded_from_crank_angle,
    crowding_parameter,
    find_segment_pieces,
    frictionless_cut_imaginary_shift,
    load_on_slider,
)
from .torque_with_friction import Sides, guide_side_function

CONTACT = 5
"""Code of a cut at which the guide force changes sides."""
_SAMPLES = 192
_BISECTIONS = 60
_TURN = 2.0 * math.pi


def needs_friction_kernel(mechanism: Mechanism) -> bool:
    """Whether kernels must include friction."""
    return bool(mechanism.with_largest_variables.friction.acts)


@analytic
def _guide_side_function(theta: Any, d: Any, segment: Segment, grip: Any, swing: Any) -> Any:
    sine, cosine = math.sin(theta), math.cos(theta)
    m = motion(sine, cosine, d.r, d.l, d.e, d.branch)
    load = load_on_slider(m, d, theta, segment)
    return guide_side_function(sine, cosine, m, d, load, grip, swing)


@analytic
def _rotation_signs(probe: Any, d: Any) -> Any:
    """Rotation signs of crank, rod, and crank relative to rod, 1 or -1."""
    turn = 1.0 if d.speed >= 0.0 else -1.0
    m = motion(math.sin(probe), math.cos(probe), d.r, d.l, d.e, d.branch)
    return turn, 1.0 if m.rod_1 * turn > 0.0 else -1.0, turn if m.rod_1 < 1.0 else -turn


@analytic
def friction_signs_in_segment(probe: Any, d: Any, segment: Segment, rubbing: Any) -> Any:
    """Return the `Sides` for the segment around the crank angle `probe`."""
    if not rubbing:
        return Sides(0.0, 0.0, 0.0, 0.0, 0.0)
    turn, swing, grip = _rotation_signs(probe, d)
    slide = d.branch.real * (1.0 if segment.outward else -1.0)
    guide = _guide_side_function(probe, d, segment, grip, swing)
    return Sides(turn, slide, swing, -1.0 if guide > 0.0 else 1.0, grip)


@analytic
def add_guide_force_change_cuts(
    d: Any, block: Any, loads: Any, watch: CycleWindow, cuts: Cuts, count: int, piece: Any, shift: Any
) -> int:
    """Add cuts at which the guide force changes sides to the first `count` cuts; return their new number.

    Changes are found between neighbouring samples: two changes within one spacing, where the force is almost zero, are
    ignored. The curves there follow one side, with an error of at most the friction due to that force.
    """
    kappa = crowding_parameter(d.r, d.l, d.e)
    first, ahead, n = cuts.angle[0], 0, count
    for s in range(count - 1, -1, -1):  # backwards, so that insertions move only cuts that have already been processed
        while cuts.angle[ahead] < first:  # except those after the last cut that lie before the first one
            ahead += 1
        a = cuts.angle[ahead + s]
        b = cuts.angle[ahead + s + 1] if s + 1 < count else first + _TURN
        if b - a < 1e-12:
            continue
        probe = angle_identifying_segment(a, b)
        _, outward = find_segment_pieces(d, block, 0, probe, loads, watch, piece, shift)
        segment = Segment(block, loads, outward, piece, shift)
        _, swing, grip = _rotation_signs(probe, d)
        low, high = crowded_from_crank_angle(a, kappa), crowded_from_crank_angle(b, kappa)
        points = max(3, int(_SAMPLES * (high - low) / _TURN) + 1)
        left, before, right, after = a, 0.0, a, 0.0
        p, q, halvings, i = a, a, 0, 0
        # Samples and bisection share one call site, into which all loads are inlined.
        while i <= points:
            sampled = (
                a if i == 0 else b if i == points else crank_angle_from_crowded(low + (high - low) * i / points, kappa)
            )
            theta = sampled if halvings == 0 else 0.5 * (p + q)
            now = _guide_side_function(theta, d, segment, grip, swing)
            if halvings > 0:
                halvings += 1
                if now * before > 0.0:
                    p = theta
                else:
                    q = theta
            else:
                right, after = theta, now
                if i > 0 and now * before < 0.0 and n < cuts.angle.shape[0] - 2:
                    p, q, halvings = left, right, 1
            at = 0.5 * (p + q)
            if 0 < halvings <= _BISECTIONS and p < at < q:
                continue
            if halvings > 0 and at - a > 1e-12 and b - at > 1e-12:
                n = add_cut(cuts, n, at, CONTACT, 0.0, -1)
            left, before, halvings = right, after, 0
            i += 1
    return n


@analytic
def contact_cut_imaginary_shift(z: Any, stepped: Segment, d: Any, segment: Segment, theta: Any, sides: Any) -> float:
    """Return the imaginary part of such a cut's angle when the design `z` carries an imaginary step; `d` is without."""
    moved = _guide_side_function(theta, z, stepped, sides.grip, sides.swing).imag
    sine, cosine = math.sin(theta), math.cos(theta)
    s, c = complex(sine, cosine * STEP), complex(cosine, -sine * STEP)
    m = motion(s, c, d.r, d.l, d.e, d.branch)
    load = load_on_slider(m, d, complex(theta, STEP), segment)
    rise = guide_side_function(s, c, m, d, load, sides.grip, sides.swing).imag / STEP
    return float(-moved / rise)


@analytic
def cut_imaginary_shift(
    z: Any, stepped: Segment, d: Any, segment: Segment, theta: Any, cuts: Cuts, i: Any, sides: Any
) -> float:
    """Return the imaginary part of any cut's angle, at an end of a segment, as in `contact_cut_imaginary_shift`."""
    if cuts.code[i] == CONTACT:
        return contact_cut_imaginary_shift(z, stepped, d, segment, theta, sides)
    return frictionless_cut_imaginary_shift(z, stepped.block, 0, theta, cuts, i)
