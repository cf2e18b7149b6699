"""States of many swinging designs at many fractions of the time: one kernel, complex throughout for derivatives."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..dynamics.segments import CycleWindow, Segment, find_segment_pieces, load_on_slider
from ..dynamics.torque import add_crank_couple, balance_before_pin_force
from ..dynamics.torque_with_friction import (
    friction_signs_in_segment,
    joint_forces_with_optional_friction,
    torque_without_crank_loads,
)
from ..kernel.arithmetic import analytic, inverse, magnitude
from ..kernel.kernel import ComplexCube, ComplexTable, Cube, Integers, Row, Table, rarely_used_kernel
from ..kinematics.position import motion
from ..machine.design import Design, design_at
from ..machine.raw_machine_vector import Loads
from ..signals.position_error import influences, worst_case
from .forces import (
    PinSides,
    frictionless_pin_force,
    newton_step,
    pin_distance_from_crank_line,
    rod_and_crank_residuals,
)
from .law import law_code, travel_and_derivatives_at
from .swing import Swing

Complexes = NDArray[np.complex128]

DRIVE, POWER, ERROR, GUIDE, PLACE, PACE, ANGLE, RATE = range(8)
"""Columns of states: drive, power, error at the driven side, guide force, slider position x, dx / d(crank angle), crank
angle, derivative of the driver position with respect to the fraction of time."""
_STATES = 8
_STILL = 1e-200  # rad/s: gives the sense of rotation, with negligible inertia
_NEWTON = 40
_CONVERGED = 1e-15
_SPEED, _ACCELERATION = Design._fields.index("speed"), Design._fields.index("acceleration")


class KernelSwing(NamedTuple):
    """A swing in the kernel's form. slider: whether the slider drives. law: code. per_time: 1 / s, 0 if slow."""

    slider: bool
    law: int
    per_time: float
    tolerance: float
    rubbing: bool
    forces: bool
    table: Table


def kernel_swing(swing: Swing, *, rubbing: bool, forces: bool) -> KernelSwing:
    """Return a swing for the kernel. rubbing: whether friction is included. forces: whether forces are needed."""
    per_time = 0.0 if swing.duration is None else 1.0 / swing.duration
    law = law_code(swing.law)
    return KernelSwing(
        swing.driver == "slider", law, per_time, swing.actuator_tolerance, rubbing, forces, swing.law_pieces
    )


@analytic
def slider_position_at(theta: Any, d: Any) -> Any:
    """Return the slider position at a crank angle, m."""
    m = motion(math.sin(theta), math.cos(theta), d.r, d.l, d.e, d.branch)
    return m.x


@analytic
def _crank_angle(x: Any, r: Any, l: Any, e: Any, branch: Any, start: float, end: float) -> Any:
    """Return the crank angle that puts the slider at x, as `forces.crank_angles_at_slider` does."""
    size = math.sqrt(x * x + e * e)
    ratio = (r * r + size * size - l * l) / (2.0 * r * size)
    half = math.acos(min(1.0, max(-1.0, ratio)))
    middle = 0.5 * (start + end)
    sine, cosine = math.sin(middle), math.cos(middle)
    side = pin_distance_from_crank_line(sine, cosine, motion(sine, cosine, r, l, e, branch))
    theta = math.atan2(e, x) + (half if side > 0.0 else -half)
    theta = theta + 2.0 * math.pi * math.floor((middle - theta) / (2.0 * math.pi) + 0.5)
    low, high = min(start, end), max(start, end)
    for _ in range(2):
        m = motion(math.sin(theta), math.cos(theta), r, l, e, branch)
        theta = min(high, max(low, theta - (m.x - x) / m.x_1))
    return theta


@analytic
def _slider_drive_and_guide_force(
    crank_sine: Any, crank_cosine: Any, m: Any, d: Any, load: Any, crank_couple: Any, rod_1: float, rubbing: bool
) -> Any:
    """Return the slider force that turns a free crank, along +x or NaN, and the guide force.

    on_crank: negative torque of the loads on the crank, N m. rod_1: phi' within the piece, whose sign counts at a cut.
    """
    b = add_crank_couple(balance_before_pin_force(crank_sine, crank_cosine, m, d, load), crank_couple)
    bx, by = frictionless_pin_force(crank_sine, crank_cosine, m, d, b)
    turn = 1.0 if d.speed.real > 0.0 else -1.0
    if rubbing:
        crank_pin_side, slider_pin_side = (1.0 if rod_1 < 1.0 else -1.0), (1.0 if rod_1 > 0.0 else -1.0)
        sides = PinSides(
            d.crank_pin_circle * (crank_pin_side * turn),
            d.slider_pin_circle * (slider_pin_side * turn),
            d.crank_pivot_circle * turn,
        )
        size = math.inf
        for _ in range(_NEWTON):
            step_x, step_y = newton_step(rod_and_crank_residuals(bx, by, crank_sine, crank_cosine, m, d, b, sides))
            bx, by = bx + step_x, by + step_y
            size = abs(step_x.real) + abs(step_y.real)
            if size <= _CONVERGED * (abs(bx.real) + abs(by.real)):
                break
        if not size <= 1e-9 * (abs(bx.real) + abs(by.real)):
            bx = bx * math.nan
        else:  # the imaginary part lags one step behind
            step_x, step_y = newton_step(rod_and_crank_residuals(bx, by, crank_sine, crank_cosine, m, d, b, sides))
            bx, by = bx + step_x, by + step_y
    guide = -by - d.slider_mass * d.gravity_y
    slide = turn if m.x_1.real > 0.0 else -turn
    mu = d.guide_friction * (slide if rubbing else 0.0)
    return b.pull + mu * magnitude(guide) - bx, guide


class Points(NamedTuple):
    """Points (p,) in swings: index of the block and of the stepped block, fraction of the time, its imaginary part.

    probe: a fraction of the time within the same piece. back: 0 forward, 1 back. Fractions count from the start of each
    stroke.
    """

    design: Integers
    stepped: Integers
    share: Row
    slip: Row
    probe: Row
    back: Row


class _Workspace(NamedTuple):
    """Work space: a design's numbers, real and stepped, with pieces and shifts of its loads."""

    block: Table
    stepped: ComplexTable
    piece: Integers
    shift: Row


@analytic
def _travel_and_derivatives_in_stroke(path: KernelSwing, share: Any, probe: Any, back: Any) -> Any:
    """Return the fraction of the travel and its first three derivatives, counted forward."""
    w, w_1, w_2, w_3 = travel_and_derivatives_at(path.law, path.table, share, probe)
    if back > 0.5:
        w, w_1, w_2, w_3 = 1.0 - w, -w_1, -w_2, -w_3
    return w, w_1, w_2, w_3


@analytic
def _motion_with_imaginary_step(theta: Any, step: Any, z: Any) -> Any:
    """Return sine, cosine and motion at a crank angle with an imaginary part."""
    sine, cosine = math.sin(theta), math.cos(theta)
    zs, zc = complex(sine, cosine * step), complex(cosine, -sine * step)
    return zs, zc, motion(zs, zc, z.r, z.l, z.e, z.branch)


@analytic
def _probe_angle(path: KernelSwing, d: Any, s: Any, start: Any, end: Any) -> Any:
    """Return the crank angle at a fraction s of the travel."""
    if path.slider:
        first, final = slider_position_at(start, d), slider_position_at(end, d)
        return _crank_angle(first + (final - first) * s, d.r, d.l, d.e, d.branch, start, end)
    return start + (end - start) * s


@analytic
def _drive_power_error_guide(
    path: KernelSwing, z: Any, place: Any, probe_angle: float, turning: float, loads: Loads, space: _Workspace
) -> tuple[Any, Any, Any, Any]:
    """Return drive, power, error at the driven side and guide force.

    place: crank angle and its imaginary part, sine, cosine, motion and speed there. probe_angle: within the same piece.
    """
    theta, moved, zs, zc, m, speed = place
    drive, guide, power = 0j, 0j, 0j
    d, angle, outward = design_at(space.block, 0), complex(theta, moved), False
    if path.forces:
        watch = CycleWindow(0, 0.0, 1.0, False, False)
        _, outward = find_segment_pieces(d, space.block, 0, probe_angle, loads, watch, space.piece, space.shift)
    segment = Segment(space.stepped, loads, outward, space.piece, space.shift)
    load = load_on_slider(m, z, angle, segment) if path.forces else 0j
    j = influences(zs, zc, m, z.l)
    if path.slider:
        if path.forces:
            on_crank = torque_without_crank_loads(0j, angle, turning, segment)
            rod_1 = motion(math.sin(probe_angle), math.cos(probe_angle), d.r, d.l, d.e, d.branch).rod_1
            drive, guide = _slider_drive_and_guide_force(zs, zc, m, z, load, on_crank, rod_1, path.rubbing)
            power = drive * m.x_1 * speed
        off = magnitude(j.crank) * z.crank_error + magnitude(j.rod) * z.rod_error
        off = off + magnitude(j.offset) * z.offset_error + path.tolerance
        error = off * inverse(magnitude(m.x_1))
    else:
        if path.forces:
            sides = friction_signs_in_segment(
                probe_angle, d, Segment(space.block, loads, outward, space.piece, space.shift), path.rubbing
            )
            f = joint_forces_with_optional_friction(zs, zc, m, z, load, sides)
            drive = torque_without_crank_loads(f.torque, angle, turning, segment)
            guide, power = f.guide, drive * speed
        error = worst_case(j, z)
    return drive, power, error, guide


@analytic
def _fill_state(
    path: KernelSwing, points: Points, p: int, ends: Any, loads: Loads, space: _Workspace, out: Any
) -> None:
    """Fill row p of `out` with the state at point p."""
    begin, ending = ends[points.stepped[p], 0], ends[points.stepped[p], 1]
    start, end = begin.real, ending.real
    turning = (1.0 if end > start else -1.0) * (1.0 - 2.0 * points.back[p])
    d, z = design_at(space.block, 0), design_at(space.stepped, 0)
    s, s_1, s_2, _ = _travel_and_derivatives_in_stroke(path, points.probe[p], points.probe[p], points.back[p])
    probe_angle = _probe_angle(path, d, s, start, end)
    w, w_1, w_2, w_3 = _travel_and_derivatives_in_stroke(path, points.share[p], points.probe[p], points.back[p])
    a, a_1, a_2 = (
        complex(w, w_1 * points.slip[p]),
        complex(w_1, w_2 * points.slip[p]),
        complex(w_2, w_3 * points.slip[p]),
    )
    if path.slider:
        begin, ending = (
            _motion_with_imaginary_step(start, begin.imag, z)[2].x,
            _motion_with_imaginary_step(end, ending.imag, z)[2].x,
        )
    place = begin + (ending - begin) * a
    rate = (ending - begin) * a_1
    speed = rate * path.per_time
    rise = (ending - begin) * a_2 * (path.per_time * path.per_time)
    theta, moved = place.real, place.imag
    if path.slider:
        theta = _crank_angle(place.real, d.r, d.l, d.e, d.branch, start, end)
        at = _motion_with_imaginary_step(theta, 0.0, z)[2]
        moved = (place.imag - at.x.imag) / at.x_1.real
    zs, zc, m = _motion_with_imaginary_step(theta, moved, z)
    if path.slider:
        speed = speed * inverse(m.x_1)
        rise = (rise - m.x_2 * speed * speed) * inverse(m.x_1)
    if speed.real == 0.0:
        speed = speed + turning * _STILL
    # Signs are those within the piece: at its place, speed and acceleration.
    fast, faster = speed.real, rise.real
    if not path.slider:
        fast = (end - start) * s_1 * path.per_time
        faster = (end - start) * s_2 * (path.per_time * path.per_time)
    space.block[_SPEED, 0], space.block[_ACCELERATION, 0] = turning * max(abs(fast), _STILL), faster
    space.stepped[_SPEED, 0], space.stepped[_ACCELERATION, 0] = speed, rise
    z = design_at(space.stepped, 0)
    drive, power, error, guide = _drive_power_error_guide(
        path, z, (theta, moved, zs, zc, m, speed), probe_angle, turning, loads, space
    )
    out[p, DRIVE], out[p, POWER], out[p, ERROR], out[p, GUIDE] = drive, power, error, guide
    out[p, PLACE], out[p, PACE], out[p, ANGLE], out[p, RATE] = m.x, m.x_1, complex(theta, moved), rate


@rarely_used_kernel
def _fill_states(
    blocks: Cube,
    steps: ComplexCube,
    points: Points,
    ends: ComplexTable,
    loads: Loads,
    path: KernelSwing,
    out: ComplexTable,
) -> None:
    rows, count = blocks.shape[1], loads.kind.shape[0]
    block, stepped = np.empty((rows, 1)), np.empty((rows, 1), np.complex128)
    space = _Workspace(block, stepped, np.zeros(count, np.int64), np.zeros(count))
    last, last_step = -1, -1
    for p in range(points.share.shape[0]):
        if points.design[p] != last:
            last = points.design[p]
            block[:, :] = blocks[last]
        if points.stepped[p] != last_step:
            last_step = points.stepped[p]
            stepped[:, :] = steps[last_step]
        _fill_state(path, points, p, ends, loads, space, out)


def swing_states(
    blocks: Array, steps: Complexes, loads: Loads, path: KernelSwing, points: Points, ends: Complexes
) -> Complexes:
    """Return states (p, 8) at points.

    blocks: (n, rows, 1), for designs that close over the swing. steps: (k, rows, 1), the same designs with imaginary
    steps. ends: crank angles (k, 2) of both ends of the swing, with these steps.
    """
    out = np.empty((len(points.share), _STATES), np.complex128)
    _fill_states(blocks, steps, points, ends, loads, path, out)
    return out
