"""Work on the load, and each joint's force times its sliding speed, as means over crank angle.

Over one turn, per radian and in the sense of rotation, with phi' = d phi / d theta:

- load: -F dx/dtheta, the work done against the load on the slider;
- guide: |N| |x'|; crank pivot: |P|; crank pin: |A| (1 - phi'); slider pin: |B| |phi'|.

Friction heat is the coefficient of friction times the guide's mean, and the radius of a friction circle times each
pin's. A pin's radius times its own mean is pressure times sliding. The sizes turn sharply where a force passes close to
zero, with or without friction: panels are halved until the last Legendre coefficients of each curve and its derivatives
have died out for the mean. Forces jump with the load, so cuts that move with the design add the jump times their own
motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..dynamics.contact import cut_contacts, rubs, shift_of, sides_of
from ..dynamics.rubbing import always_drives, joint_forces
from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    angle_within,
    breakpoint_capacity,
    crowded,
    cut_cycle,
    enter,
    load_on_slider,
    uncrowded,
)
from ..kernel.arithmetic import STEP, analytic, magnitude, root
from ..kernel.batches import in_chunks, turning
from ..kernel.kernel import ComplexCube, Cube, Row, Table, kernel
from ..kinematics.position import motion_of
from ..machine.derived import derived
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.members import is_shaft
from ..machine.memoise import memoise_by_batch
from ..machine.numbers import numbers_of
from ..machine.raw import Loads
from ..machine.two_turns import cycle_turns, halves
from .quadrature import DEEPEST, EVEN, NOISE, PANELS, RESOLVED, gaps_of, panel_rule, rough, square_along
from .shaft_statistics import shaft_turn_work
from .signal_inputs import signal_inputs
from .signals import Signal

LOAD, GUIDE, CRANK_PIVOT, CRANK_PIN, SLIDER_PIN = range(5)
"""Places of the curves."""
_CURVES, _POINTS = 5, 16
_WATCH = CycleWindow(0, 0.0, 1.0, True, True)  # |x'|, |phi'|: kinks at the dead centres and where the rod turns back
_TURN = 2.0 * math.pi
_SHARE = 0.1
"""Permissible tail in a panel's mean, as a fraction of that in a curve: the narrower a panel, the less its tail counts.

Otherwise rounding, which halving does not reduce, would halve every panel of a linkage that nearly locks.
"""


@dataclass(frozen=True)
class TurnWork:
    """Means over crank angle of n designs, N m (pins: N). mean: (n, 5). gradients: (n, 5, 3 + k) or None.

    Where friction locks a design all means are infinite.
    """

    mean: Array
    gradients: Array | None


@analytic
def _curves(
    theta: Any, square: Any, d: Any, block: Any, outward: Any, loads: Any, piece: Any, shift: Any, sides: Any
) -> Any:
    """Return the five curves; square: the real l^2 cos^2(phi)."""
    sine, cosine = math.sin(theta), math.cos(theta)
    l_sin = d.e - d.r * sine
    plain = d.l * d.l - l_sin * l_sin
    m = motion_of(sine, cosine, d.r, l_sin, d.branch * root(plain + (square - plain.real)))
    load = load_on_slider(m, d, block, 0, theta, outward, loads, piece, shift)
    f = joint_forces(sine, cosine, m, d, load, sides)
    turn = 1.0 if d.speed.real >= 0.0 else -1.0
    return (
        -turn * d.branch * load * m.x_1,
        magnitude(f.guide * m.x_1),
        root(f.pivot_x * f.pivot_x + f.pivot_y * f.pivot_y),
        root(f.crank_pin_x * f.crank_pin_x + f.crank_pin_y * f.crank_pin_y) * (1.0 - m.rod_1),
        root(f.slider_pin_x * f.slider_pin_x + f.slider_pin_y * f.slider_pin_y) * magnitude(m.rod_1),
    )


@kernel
def _integrate(
    blocks: Cube,
    steps: ComplexCube,
    gaps: Row,
    loads: Loads,
    watch: CycleWindow,
    rule: tuple[Row, Row, Table],
    mean: Table,
    slopes: Cube,
    rubbing: bool,
) -> None:
    nodes, weights, tail = rule
    capacity = breakpoint_capacity(loads)
    cuts = Cuts(
        np.empty(capacity),
        np.empty(capacity, np.int64),
        np.empty(capacity),
        np.empty(capacity, np.int64),
    )
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    nv = slopes.shape[2] if slopes.shape[0] else 0
    # Row 0 of the rates is the curve itself, the others are its derivatives.
    rates, weight = np.empty((_CURVES, nv + 1, _POINTS)), np.empty(_POINTS)
    greatest = np.empty((_CURVES, nv + 1))
    stack = np.empty((DEEPEST + 2, 3))
    for n in range(blocks.shape[0]):
        block, stepped = blocks[n], steps[n * nv : (n + 1) * nv]
        mean[n, :] = 0.0
        if nv:
            slopes[n] = 0.0
        d = design_at(block, 0)
        if rubbing and not always_drives(d) > 0.0:
            mean[n, :] = np.inf
            continue
        kappa = math.sqrt(math.sqrt(gaps[n] * (gaps[n] + 2.0 * d.r)) / (gaps[n] + d.r))
        denser = math.ceil(max(1.0, EVEN / kappa))
        resolved = max(1.0, NOISE / (kappa * kappa))
        count = cut_cycle(d, block, 0, loads, watch, cuts)
        if rubbing:
            count = cut_contacts(d, block, 0, loads, watch, cuts, count, piece, shift)
        cuts.angle[count] = cuts.angle[0] + _TURN
        greatest[:] = 0.0
        for s in range(count):
            a, b = cuts.angle[s], cuts.angle[s + 1]
            probe = angle_within(a, b)
            _, outward = enter(d, block, 0, probe, loads, watch, piece, shift)
            sides = sides_of(probe, d, block, 0, outward, loads, piece, shift, rubbing)
            low, high = crowded(a, kappa), crowded(b, kappa)
            panels = denser * (int(PANELS * (high - low) / _TURN) + 1)
            for p in range(panels):
                width = (high - low) / panels
                stack[0, 0], stack[0, 1], stack[0, 2] = low + width * p, width, 0.0
                top = 1
                while top > 0:
                    top -= 1
                    begin, width, depth = stack[top, 0], stack[top, 1], stack[top, 2]
                    for i in range(_POINTS):
                        tau = begin + width * nodes[i]
                        theta = uncrowded(tau, kappa)
                        c, y = math.cos(tau), math.sin(tau)
                        weight[i] = weights[i] * width / _TURN * kappa / (c * c + kappa * kappa * y * y)
                        square = square_along(theta, d, gaps[n])
                        f = _curves(theta, square, d, block, outward, loads, piece, shift, sides)
                        for k in range(_CURVES):
                            rates[k, 0, i] = f[k]
                        for v in range(nv):
                            z = design_at(stepped[v], 0)
                            g = _curves(theta, square, z, stepped[v], outward, loads, piece, shift, sides)
                            for k in range(_CURVES):
                                rates[k, v + 1, i] = g[k].imag / STEP
                    halve, tolerance_factor = False, _SHARE * _TURN / width
                    for k in range(_CURVES):
                        for v in range(nv + 1):
                            greatest[k, v] = max(greatest[k, v], np.abs(rates[k, v]).max())
                            allowed = RESOLVED[0 if v == 0 else 1] * resolved * greatest[k, v] * tolerance_factor
                            halve = halve or rough(rates[k, v], tail, allowed)
                    if halve and depth < DEEPEST:
                        for half in range(2):  # the left one on top: panels are added up in order
                            stack[top, 0] = begin + 0.5 * width * (1 - half)
                            stack[top, 1], stack[top, 2] = 0.5 * width, depth + 1.0
                            top += 1
                        continue
                    for k in range(_CURVES):
                        for i in range(_POINTS):
                            mean[n, k] += weight[i] * rates[k, 0, i]
                            for v in range(nv):
                                slopes[n, k, v] += weight[i] * rates[k, v + 1, i]
            for end in range(2 if nv else 0):
                i, theta = (s + 1) % count if end else s, b if end else a
                f = _curves(theta, square_along(theta, d, gaps[n]), d, block, outward, loads, piece, shift, sides)
                sign = (1.0 if end else -1.0) / (STEP * _TURN)
                for v in range(nv):
                    z = design_at(stepped[v], 0)
                    slip = shift_of(z, stepped[v], d, block, theta, cuts, i, outward, loads, piece, shift, sides)
                    for k in range(_CURVES):
                        slopes[n, k, v] += sign * f[k] * slip


@memoise_by_batch
def turn_work(mechanism: Mechanism, designs: Array, *, gradients: bool = False) -> TurnWork:
    """Return the means of fully turning designs (n, 3 + k): crank, rod, offset, m, then the machine's varying numbers.

    For a cycle of two turns they cover both turns; for several cylinders they are sums.
    """
    designs = turning(designs)
    if is_shaft(mechanism):
        return TurnWork(*shaft_turn_work(mechanism, designs, gradients=gradients))
    if cycle_turns(mechanism) > 1:
        first, second = (turn_work(half, designs, gradients=gradients) for half in halves(mechanism))
        slopes = None
        if first.gradients is not None and second.gradients is not None:
            slopes = 0.5 * (first.gradients + second.gradients)
        return TurnWork(0.5 * (first.mean + second.mean), slopes)
    n = len(designs)
    mean = np.empty((n, _CURVES))
    raw, loads = signal_inputs(mechanism, Signal.CRANK_PIN_FORCE)
    numbers = numbers_of(mechanism, designs, limit=len(raw), gradients=gradients)
    columns, designs = numbers.columns, numbers.values
    slopes_by_raw = np.empty((n if gradients else 0, _CURVES, len(columns)))
    rule, gaps = panel_rule(), gaps_of(*designs.T[:3])

    def work(begin: int, end: int) -> None:
        blocks, steps = derived(raw, loads, columns, designs[begin:end], steps=gradients)
        _integrate(
            blocks,
            steps,
            gaps[begin:end],
            loads,
            _WATCH,
            rule,
            mean[begin:end],
            slopes_by_raw[begin:end] if gradients else slopes_by_raw,
            rubs(mechanism),
        )

    in_chunks(n, work, knots=len(loads.at))
    return TurnWork(mean, numbers.chain(slopes_by_raw) if gradients else None)
