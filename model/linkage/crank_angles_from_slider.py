"""All crank angles of one linkage for a slider position, with crank speeds and accelerations; range of the slider."""

import math
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from ..errors import AssemblyError, InputError
from ..kinematics.position import motion
from .inverse_kinematics import ROUNDING, Dimensions, Solution, crank_angle_at, crank_motion, require_finite

_DIGITS = 9  # decimals of a position in messages, m: nanometres
_LOCKED = 1e-7
"""Fraction of the rod. This close to an end where the rod is normal to the slider line, rounding decides whether it is
locked.

There l - |e - r sin(theta)| is half the square of the distance, and the square of 1e-8 is the rounding error of a
double.
"""


@dataclass(frozen=True)
class CrankSolution:
    """A crank motion that produces a slider motion.

    crank_angle: rad in [0, 2 pi). speed: rad/s; None if no slider velocity is given, and at a dead centre, where any
    crank speed leaves the slider at rest. acceleration: rad/s^2; None where the speed is None, and if no slider
    acceleration is given. stroke: the slider's stroke at that angle if the crank turns counter-clockwise; None at a
    dead centre.
    """

    crank_angle: float
    speed: float | None
    acceleration: float | None
    stroke: Solution | None


@dataclass(frozen=True)
class _SliderMotion:
    """Slider position, m, velocity, m/s, and acceleration, m/s^2."""

    position: float
    velocity: float | None
    acceleration: float | None


def crank_solutions(
    linkage: Dimensions, position: ArrayLike, velocity: ArrayLike | None, acceleration: ArrayLike | None
) -> tuple[CrankSolution, ...]:
    """Return the crank motions of one linkage for a slider motion, SI, as `Linkage.from_slider` describes.

    Where the rod is nearly normal to the slider line, rounding of the angle moves the slider by about 1e-8 cranks.
    """
    crank, rod, offset = _require_real_lengths(linkage)
    slider_motion = _SliderMotion(
        _require_number("slider position", position),
        None if velocity is None else _require_number("slider velocity", velocity),
        None if acceleration is None else _require_number("slider acceleration", acceleration),
    )
    if slider_motion.acceleration is not None and slider_motion.velocity is None:
        raise InputError(
            "a slider acceleration also needs the slider velocity; got acceleration "
            f"{slider_motion.acceleration:g} m/s^2 alone; add the velocity, 0 for a slider at rest"
        )
    distance, rounding = math.hypot(slider_motion.position, offset), ROUNDING * (crank + rod)
    to_outer, to_inner = crank + rod - distance, distance - abs(rod - crank)
    if min(to_outer, to_inner) < -rounding:
        raise _unreachable_position_error(linkage, slider_motion.position)
    if distance <= rounding:
        raise AssemblyError(
            "the slider pin must not lie on the crank pivot, which leaves the crank angle undetermined; got "
            f"position {1e3 * slider_motion.position:.9g} mm with rod = crank = {1e3 * crank:g} mm and no offset; "
            "move the position, or make rod and crank differ"
        )
    if min(to_outer, to_inner) <= rounding:
        angle = math.atan2(offset, slider_motion.position) + (math.pi if to_inner < to_outer and rod > crank else 0.0)
        return (_solution_at_dead_centre(linkage, angle, slider_motion),)
    solutions = [
        solution for stroke in get_args(Solution) for solution in _crank_solutions(linkage, stroke, slider_motion)
    ]
    if not solutions:
        raise _unreachable_position_error(linkage, slider_motion.position)
    return tuple(solutions)


def slider_ranges(linkage: Dimensions) -> tuple[tuple[float, float], ...]:
    """Return the ranges of slider positions, m, that one linkage reaches on its branch, in ascending order.

    There is one range, or two if the crank moves within two separate arcs, rod + |offset| < crank. They end at a dead
    centre or, exclusive, where the rod is normal to the slider line: there the linkage locks.
    """
    crank, rod, offset = _require_real_lengths(linkage)
    sines = ((offset - rod) / crank, (offset + rod) / crank)
    normal = [crank * math.sqrt((1.0 - sine) * (1.0 + sine)) for sine in sines if abs(sine) < 1.0]
    right, left = list(normal), [-x for x in normal]  # by the side of the pivot on which the crank pin lies
    stretched_side, folded_side = (right, left) if linkage.sign > 0.0 else (left, right)
    longest, shortest = rod + crank, rod - crank
    stretched_side.append(linkage.sign * math.sqrt((longest - offset) * (longest + offset)))
    if abs(offset) <= abs(shortest):
        folded = math.sqrt((shortest - offset) * (shortest + offset))
        folded_side.append(linkage.sign * math.copysign(folded, shortest))
    arcs = (right, left) if len(normal) == 2 else (right + left,)
    return tuple(sorted((min(arc), max(arc)) for arc in arcs))


def _crank_solutions(linkage: Dimensions, stroke: Solution, target: _SliderMotion) -> list[CrankSolution]:
    """Return the solution for a stroke away from the dead centres; none if it is on the other branch."""
    try:
        angle = float(crank_angle_at(linkage, target.position, solution=stroke))
    except AssemblyError:
        return []
    if abs(linkage.offset - linkage.crank * math.sin(angle)) >= linkage.rod:  # locked up to rounding
        return []
    if target.velocity is None:
        return [CrankSolution(angle, None, None, stroke)]
    with np.errstate(over="ignore", invalid="ignore"):
        crank = crank_motion(
            linkage,
            target.position,
            velocity=target.velocity,
            acceleration=target.acceleration or 0.0,
            solution=stroke,
        )
    speed, acceleration = float(crank.speed) + 0.0, float(crank.acceleration) + 0.0  # -0 is 0
    if not (math.isfinite(speed) and math.isfinite(acceleration)):
        raise InputError(
            "crank speed and acceleration must be finite numbers; "
            f"got slider velocity {target.velocity:g} m/s at position {1e3 * target.position:.9g} mm; "
            "give a smaller one"
        )
    return [CrankSolution(angle, speed, None if target.acceleration is None else acceleration, stroke)]


def _solution_at_dead_centre(linkage: Dimensions, angle: float, target: _SliderMotion) -> CrankSolution:
    """Return the solution at a dead centre. Raises `InputError` for a slider motion that is impossible there."""
    crank, rod, offset = _require_real_lengths(linkage)
    if linkage.sign * (target.position - crank * math.cos(angle)) <= 0.0:
        raise _unreachable_position_error(linkage, target.position)
    m = motion(math.sin(angle), math.cos(angle), crank, rod, offset, linkage.sign)
    place = f"at the dead centre, position {1e3 * target.position:.9g} mm"
    remedy = "or a position farther away"
    if target.velocity:
        raise InputError(
            f"the slider velocity must be 0 {place}, where the slider is at rest at any crank speed; got "
            f"{target.velocity:g} m/s; give 0, {remedy}"
        )
    # x' = 0 leaves a = x'' speed^2.
    if target.acceleration is not None and target.acceleration * float(m.x_2) < 0.0:
        sign = "negative" if m.x_2 < 0.0 else "positive"
        raise InputError(
            f"the slider acceleration must be {sign} or 0 {place}, from which the slider can only return; got "
            f"{target.acceleration:g} m/s^2; reverse its sign, {remedy}"
        )
    angle_in_turn = math.fmod(angle + 2.0 * math.pi, 2.0 * math.pi)
    return CrankSolution(angle_in_turn, None, None, None)


def _unreachable_position_error(linkage: Dimensions, position: float) -> AssemblyError:
    crank, rod, offset = _require_real_lengths(linkage)
    # Rounded inward, and away from ends where the linkage locks: an end entered as reported is within reach.
    inward = 0.0 if rod > crank + abs(offset) else _LOCKED * rod
    up, down = Context(_DIGITS, ROUND_CEILING), Context(_DIGITS, ROUND_FLOOR)
    ends = (
        (up.create_decimal(repr(1e3 * (low + inward))), down.create_decimal(repr(1e3 * (high - inward))))
        for low, high in slider_ranges(linkage)
    )
    ranges = " or ".join(f"{float(low):.{_DIGITS}g} mm to {float(high):.{_DIGITS}g} mm" for low, high in ends)
    sizes = f"crank {1e3 * crank:g} mm, rod {1e3 * rod:g} mm, offset {1e3 * offset:g} mm"
    return AssemblyError(
        f"the slider position must be within reach of the {linkage.branch} branch, {ranges}; "
        f"got {1e3 * position:.12g} mm with {sizes}; move the position within reach, or change a length"
    )


def _require_real_lengths(linkage: Dimensions) -> tuple[float, float, float]:
    """Return crank, rod and offset, m. Raises `InputError` for an array of linkages and for complex dimensions."""
    sizes = (linkage.crank, linkage.rod, linkage.offset)
    shape = np.broadcast_shapes(*(np.shape(size) for size in sizes))
    if shape:
        raise InputError(
            f"the inverse problem accepts only one linkage at a time; got an array of shape {shape}; loop over it"
        )
    if any(np.iscomplexobj(size) for size in sizes):
        raise InputError("the inverse problem needs real dimensions; got complex ones; leave out the imaginary part")
    return float(linkage.crank), float(linkage.rod), float(linkage.offset)


def _require_number(name: str, value: ArrayLike) -> float:
    array = require_finite(name, value)
    if array.ndim:
        raise InputError(f"{name} must be one number; got an array of shape {array.shape}; loop over it")
    return float(array)
