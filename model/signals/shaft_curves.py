"""Curves for a crankshaft: for all its cylinders or one, at constant speed or with a speed profile.

Each cylinder is a single crank at the angle theta + lead, in axes that are rotated with its bank. Speed and
acceleration of the shaft are w p and w^2 p p', where p is the profile at the shaft's own angle; a constant acceleration
is added. Every curve is the magnitude of a vector with two components, or its first component; components add up over
the cylinders. All numbers are complex, so one compiled formula gives values, slopes over the crank angle and
derivatives with respect to the design.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    Segment,
    find_segment_pieces,
    frictionless_cut_imaginary_shift,
    load_on_slider,
)
from ..dynamics.speed_ratio import SpeedRatio, speed_ratio_at
from ..dynamics.torque import reflected_inertia, shaking_force_and_moment
from ..dynamics.torque_with_friction import (
    Sides,
    friction_signs_in_segment,
    guide_side_function,
    joint_forces_with_optional_friction,
    rotation_sense,
    torque_without_crank_loads,
)
from ..kernel.arithmetic import STEP, analytic, magnitude, root
from ..kernel.kernel import ComplexCube, ComplexTable, Cube, Integers, IntegerTable, Row, Table, rarely_used_kernel
from ..kinematics.position import third_slider_derivative
from ..machine.design import Design, design_at
from ..machine.raw_machine_vector import Loads
from .signals import Signal, design_motion, slider_pin_to_guide_centre

TOUCH, WORK = 100, 101
"""Curves besides signals: one with the sign of the guide force (`rubbing.guide_side_function`), and from `WORK` on
those of `turn_work`, in order."""
CURVES = 5
VECTORS = (
    Signal.PIVOT_FORCE,
    Signal.CRANK_PIN_FORCE,
    Signal.SLIDER_PIN_FORCE,
    Signal.SHAKING_FORCE,
    Signal.ROCKING_COUPLE,
)
"""Signals that are the magnitude of a vector; the others are one component, with its sign."""
_TORQUE, _PIVOT, _CRANK_PIN, _SLIDER_PIN, _GUIDE, _GUIDE_MOMENT, _POWER, _LINE, *_OTHERS = map(int, Signal)
_SPEED, _ACCELERATION, _JERK, _, _, _INERTIA, _SHAKING_FORCE, _SHAKING_MOMENT, _ROCKING_COUPLE = _OTHERS
_ROW_SPEED, _ROW_ACCELERATION, _ROW_X, _ROW_Y = (
    Design._fields.index(name) for name in ("speed", "acceleration", "gravity_x", "gravity_y")
)


class Axes(NamedTuple):
    """The cylinders (m,): lead of each crank angle over the shaft angle, rad, cosine and sine of bank, position, m."""

    lead: Row
    cosine: Row
    sine: Row
    place: Row


class Evaluations(NamedTuple):
    """Arguments for p evaluations: design, shaft angle that identifies the segment, angles, their rates, half.

    row, probe: (p,). angle: (p, k), rad. rate: (p, v), derivative of the angle with respect to each number of the
    design, if derivatives are needed. half: (p, m), half of a two-turn cycle that each cylinder is in.
    """

    row: Integers
    probe: Row
    angle: Table
    rate: Table
    half: IntegerTable


class CurveArrays(NamedTuple):
    """Results. curve: (p, k, 2 + v), value, slope over the crank angle and, if needed, design derivatives.

    size: (p, k), sum of the cylinders' magnitudes. outward: (p, m), 1 if the slider moves outward.
    """

    curve: Cube
    size: Table
    outward: IntegerTable


class Blocks(NamedTuple):
    """Derived designs for h halves.

    plain: (n h, rows, 1). stepped: (n h (1 + v), rows, 1), the first without a step.
    """

    plain: Cube
    stepped: ComplexCube


@analytic
def components_of_force_signal(kind: Any, f: Any, m: Any, d: Any) -> Any:
    """Return the components of a signal that follows from the joint forces alone, or of a force in `turn_work`."""
    zero = 0.0 * d.r
    if kind in (_PIVOT, WORK + 2):
        return f.pivot_x, f.pivot_y
    if kind in (_CRANK_PIN, WORK + 3):
        return f.crank_pin_x, f.crank_pin_y
    if kind in (_SLIDER_PIN, WORK + 4):
        return f.slider_pin_x, f.slider_pin_y
    if kind == _LINE:
        return f.slider_pin_x, zero
    if kind == _GUIDE_MOMENT:
        return f.guide * slider_pin_to_guide_centre(m, d), zero
    return f.guide, zero


@analytic
def components_of_motion_signal(kind: Any, s: Any, c: Any, m: Any, d: Any, rate: Any) -> Any:
    """Return the components of a signal without joint forces. rate: slope of the acceleration over the crank angle."""
    zero = 0.0 * d.r
    if kind == _SPEED:
        return m.x_1 * d.speed, zero
    if kind == _ACCELERATION:
        return m.x_2 * d.speed * d.speed + m.x_1 * d.acceleration, zero
    if kind == _JERK:
        third = third_slider_derivative(s, c, m, d.r)
        return (third * d.speed * d.speed + 3.0 * m.x_2 * d.acceleration + m.x_1 * rate) * d.speed, zero
    if kind == _INERTIA:
        return reflected_inertia(s, c, m, d), zero
    x, y, moment = shaking_force_and_moment(s, c, m, d)
    return (moment, zero) if kind == _SHAKING_MOMENT else (x, y)


@analytic
def _curve_components_of_cylinder(kind: Any, s: Any, c: Any, m: Any, d: Any, sides: Any, place: Any, rate: Any) -> Any:
    """Return one cylinder's components of a curve.

    place: its crank angle, and the segment there. rate: slope of the acceleration over the crank angle, rad/s^2.
    """
    zero = 0.0 * d.r
    theta, segment = place
    load = load_on_slider(m, d, theta, segment)
    if kind == TOUCH:
        return guide_side_function(s, c, m, d, load, sides.turn, sides.swing), zero
    if kind > _LINE and kind < WORK:
        return components_of_motion_signal(kind, s, c, m, d, rate)
    f = joint_forces_with_optional_friction(s, c, m, d, load, sides)
    if kind in (_TORQUE, _POWER):
        torque = torque_without_crank_loads(f.torque, theta, rotation_sense(d), segment)
        return (torque * d.speed, zero) if kind == _POWER else (torque, zero)
    x, y = components_of_force_signal(kind, f, m, d)
    if kind < WORK:
        return x, y
    if kind == WORK:
        return -rotation_sense(d) * d.branch * load * m.x_1, zero
    if kind == WORK + 1:
        return magnitude(x * m.x_1), zero
    turned = 1.0 + zero if kind == WORK + 2 else 1.0 - m.rod_1 if kind == WORK + 3 else magnitude(m.rod_1)
    return root(x * x + y * y) * turned, zero


class ShaftCurve(NamedTuple):
    """One curve. kind: a signal, `TOUCH`, `WORK` or a constant after `WORK`. members: summed cylinders.

    vector: whether both components count. rubbing: whether friction is included.
    """

    kind: int
    members: Integers
    vector: bool
    rubbing: bool


class Crankshaft(NamedTuple):
    """Cylinders and speed of a shaft. turns: halves of its cycle, with loads `first_turn` and `second_turn`."""

    axes: Axes
    pace: SpeedRatio
    blocks: Blocks
    first_turn: Loads
    second_turn: Loads
    turns: int


class _Workspace(NamedTuple):
    """Work space. real, stepped: one cylinder's numbers. piece, shift, sides: those of the members, in a segment."""

    real: Table
    stepped: ComplexTable
    piece: IntegerTable
    shift: Table
    sides: Table


@analytic
def _fill_cylinder_numbers(source: Any, ratio: Any, slope: Any, axes: Axes, k: int, out: Any) -> None:
    """Fill `out` with the numbers of cylinder k: speed, acceleration (p = ratio, p' = slope), gravity in its axes."""
    for row in range(out.shape[0]):
        out[row, 0] = source[row, 0]
    speed, x, y = source[_ROW_SPEED, 0], source[_ROW_X, 0], source[_ROW_Y, 0]
    out[_ROW_SPEED, 0] = speed * ratio
    out[_ROW_ACCELERATION, 0] = source[_ROW_ACCELERATION, 0] + speed * speed * ratio * slope
    out[_ROW_X, 0] = axes.cosine[k] * x + axes.sine[k] * y
    out[_ROW_Y, 0] = axes.cosine[k] * y - axes.sine[k] * x


@analytic
def _enter_segment(
    curve: ShaftCurve, shaft: Crankshaft, items: Evaluations, p: int, space: _Workspace, out: Any
) -> None:
    """Fix strokes, load pieces and signs of the members in the segment of evaluation p."""
    watch = CycleWindow(0, 0.0, 1.0, False)
    ratio, slope, _, _ = speed_ratio_at(items.probe[p], shaft.pace)
    for i in range(curve.members.shape[0]):
        k = curve.members[i]
        half = items.half[p, k]
        loads = shaft.first_turn if half == 0 else shaft.second_turn
        _fill_cylinder_numbers(
            shaft.blocks.plain[items.row[p] * shaft.turns + half], ratio, slope, shaft.axes, k, space.real
        )
        d, local = design_at(space.real, 0), items.probe[p] + shaft.axes.lead[k]
        _, outward = find_segment_pieces(d, space.real, 0, local, loads, watch, space.piece[i], space.shift[i])
        segment = Segment(space.real, loads, outward, space.piece[i], space.shift[i])
        signs = friction_signs_in_segment(local, d, segment, curve.rubbing)
        space.sides[i, 0], space.sides[i, 1], space.sides[i, 2] = signs.turn, signs.slide, signs.swing
        space.sides[i, 3], space.sides[i, 4] = signs.press, signs.grip
        out.outward[p, i] = 1 if outward else 0


@analytic
def _sum_members(
    curve: ShaftCurve, shaft: Crankshaft, items: Evaluations, p: int, place: Any, space: _Workspace, out: Any
) -> Any:
    """Return the curve and its magnitude at one angle of evaluation p.

    place: shaft angle, its imaginary step, p with three derivatives there, and the index of the stepped design.
    """
    theta, step, (p_0, p_1, p_2, p_3), v = place
    axes, sides, numbers = shaft.axes, space.sides, shaft.blocks.stepped.shape[0] // max(1, shaft.blocks.plain.shape[0])
    ratio, slope, bend = complex(p_0, step * p_1), complex(p_1, step * p_2), complex(p_2, step * p_3)
    sum_x, sum_y = 0j, 0j
    size = 0.0
    for i in range(curve.members.shape[0]):
        k = curve.members[i]
        half = items.half[p, k]
        loads = shaft.first_turn if half == 0 else shaft.second_turn
        source = shaft.blocks.stepped[(items.row[p] * shaft.turns + half) * numbers + v]
        _fill_cylinder_numbers(source, ratio, slope, axes, k, space.stepped)
        speed = source[_ROW_SPEED, 0]
        rate = speed * speed * (slope * slope + ratio * bend)
        z, local = design_at(space.stepped, 0), theta + axes.lead[k]
        sine, cosine = math.sin(local), math.cos(local)
        s, c = complex(sine, cosine * step), complex(cosine, -sine * step)
        segment = Segment(space.stepped, loads, out.outward[p, i] == 1, space.piece[i], space.shift[i])
        signs = Sides(sides[i, 0], sides[i, 1], sides[i, 2], sides[i, 3], sides[i, 4])
        x, y = _curve_components_of_cylinder(
            curve.kind, s, c, design_motion(s, c, z), z, signs, (complex(local, step), segment), rate
        )
        if curve.kind in (_SHAKING_FORCE, _ROCKING_COUPLE):
            x, y = axes.cosine[k] * x - axes.sine[k] * y, axes.sine[k] * x + axes.cosine[k] * y
        if curve.kind == _ROCKING_COUPLE:
            x, y = -axes.place[k] * y, axes.place[k] * x
        sum_x, sum_y = sum_x + x, sum_y + y
        size += abs(x.real) + abs(y.real)
    return (root(sum_x * sum_x + sum_y * sum_y) if curve.vector else sum_x), size


@rarely_used_kernel
def fill_curves(curve: ShaftCurve, shaft: Crankshaft, items: Evaluations, out: CurveArrays) -> None:
    """Fill `out` with a curve for each design, added up over its members."""
    rows, count, loads = shaft.blocks.plain.shape[1], curve.members.shape[0], shaft.first_turn.kind.shape[0]
    real, stepped = np.empty((rows, 1)), np.empty((rows, 1), np.complex128)
    space = _Workspace(
        real, stepped, np.zeros((count, loads), np.int64), np.zeros((count, loads)), np.zeros((count, 5))
    )
    for p in range(items.row.shape[0]):
        _enter_segment(curve, shaft, items, p, space, out)
        for a in range(items.angle.shape[1]):
            theta = items.angle[p, a]
            ratios = speed_ratio_at(theta, shaft.pace)
            for v in range(out.curve.shape[2] - 1):
                step = STEP if v == 0 else STEP * items.rate[p, v - 1]
                value, size = _sum_members(curve, shaft, items, p, (theta, step, ratios, v), space, out)
                out.curve[p, a, 1 + v] = value.imag / STEP
                if v == 0:
                    out.curve[p, a, 0], out.size[p, a] = value.real, size


@rarely_used_kernel
def fill_breakpoint_gradients(
    chosen: Integers, angle: Row, code: Integers, number: Row, load: Integers, stepped: ComplexCube, out: Table
) -> None:
    """Fill `out` (p, v) with the derivatives of breakpoints, at the cylinders' own angles, by the design."""
    cuts = Cuts(angle, code, number, load)
    for p in range(chosen.shape[0]):
        for v in range(out.shape[1]):
            block = stepped[chosen[p] * (out.shape[1] + 1) + 1 + v]
            out[p, v] = frictionless_cut_imaginary_shift(design_at(block, 0), block, 0, angle[p], cuts, p) / STEP
