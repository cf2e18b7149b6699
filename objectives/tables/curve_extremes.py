"""Minimum and maximum of every curve of one design, over the continuous crank angle.

The turn is cut at possible jumps and kinks of torque and forces (`model.cycle.cycle.breakpoints`), at the dead centres,
and where the crank is normal to the slider line. Within a piece every curve is sampled densely, and each of its highest
and lowest samples is refined by golden sections between its neighbours. At the ends of a piece the one-sided limits
count. Golden-section search needs no derivative, and so also finds the cusps of magnitudes. Source: R. P. Brent,
Algorithms for Minimization without Derivatives (1973), chapter 5.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...model.cycle.crank_speed import speed_knots
from ...model.cycle.cycle import breakpoints
from ...model.cycle.multi_cylinder import multi_cylinder_breakpoints
from ...model.cycle.self_locking import locking_margin
from ...model.dynamics.segments import crank_angle_from_crowded, crowded_from_crank_angle, crowding_parameter
from ...model.linkage.linkage import Linkage
from ...model.linkage.require_single_linkage import require_single_rotating_linkage
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.links_and_joints import Friction
from ...model.machine.mechanism import Mechanism
from ...model.signals.panel_polynomials import index_of_first_maximum, wrap_into_cycle
from ..kinds import Kind
from ..machine_needs import DRIVEN, LOADED, PIVOT_LOADED, SPEED, TOLERANCES, Need
from ..motion_deviation import POSITION_ERROR, POSITION_ERROR_RSS
from ..quantity import Array
from .cycle_curves import Curve, cycle_curves

_TURN = 2.0 * math.pi
_SAMPLES = 2048
"""Over a turn, in crowded angles, which are denser where the curves are steep. The nearest singularity is then dozens
of samples away."""
_LEAST_SAMPLES = 33  # minimum in a piece, however short
_INSET = 1e-8
"""Distance from an end of a piece, rad, at which the stroke is unambiguous; limits are extrapolated from there."""
_TOLERATED_STEPS = 4.0
"""Rise of a curve above a sample, in differences between neighbouring samples: one at a cusp, less where it is
smooth."""
_CANDIDATES = 60  # maximum per curve and side; only samples that agree to within rounding would give more
_SECTIONS = 64  # 0.618^64 = 4e-14 of a bracket
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
_EQUAL = 1e-14  # of the curve's magnitude: within it, an end of a piece counts as high as its neighbourhood
_CONSTANT = 1e-12  # relative to the maximum magnitude of all curves with the same unit
_NEEDS: dict[str, tuple[Need, ...]] = {
    **dict.fromkeys(("slider_velocity", "slider_acceleration", "slider_jerk"), (SPEED,)),
    "torque": (DRIVEN,),
    "power": (SPEED, DRIVEN),
    **dict.fromkeys(("pivot", "pivot_x", "pivot_y"), (PIVOT_LOADED,)),
    **dict.fromkeys(("crank_pin", "crank_pin_x", "crank_pin_y"), (LOADED,)),
    **dict.fromkeys(("slider_pin", "slider_pin_x", "slider_pin_y", "guide"), (LOADED,)),
    **{quantity.name: (TOLERANCES,) for quantity in (POSITION_ERROR, POSITION_ERROR_RSS)},
}


@dataclass(frozen=True)
class Extreme:
    """An extreme value of a curve, SI, with crank angle in the cycle, rad, and slider position, m.

    Among equal values, the first counts (`index_of_first_maximum`). Angle and position are NaN for a constant curve;
    all three are NaN for a curve that friction leaves undetermined at some crank angle.
    """

    value: float
    crank_angle: float
    slider_position: float


@dataclass(frozen=True)
class CurveExtremes:
    """Extremes of one curve in `cycle_curves`, or of the magnitude of a joint force."""

    name: str
    title: str
    kind: Kind
    least: Extreme
    greatest: Extreme


def curve_extremes(mechanism: Mechanism, linkage: Linkage) -> list[CurveExtremes]:
    """Return the extremes of every curve that the machine defines, for one fully rotating linkage.

    Omits velocity, acceleration, jerk and power without a crank speed, torque and joint forces without masses and
    loads, the load without loads, and position errors without tolerances. At a jump, an extreme is the one-sided limit.
    For a spike narrower than a few hundred-millionths of a radian, the values beside it count. Raises `InputError` for
    arrays of linkages and for a linkage on another branch than the mechanism's.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    first = defined_curves(mechanism, linkage, np.zeros(1))

    def values(angles: Array) -> Array:
        return np.stack([curve.values for curve in defined_curves(mechanism, linkage, angles)])

    pieces = _smooth_pieces(mechanism, linkage)
    samples = [values(piece) for piece in pieces]
    sizes = _curve_magnitudes(first, samples)
    period = cycle_turns(mechanism) * _TURN
    least, greatest = _minima_and_maxima(values, pieces, samples, sizes, period)
    extremes = []
    for row, curve in enumerate(first):
        ends = []
        for value, angle in (least[row], greatest[row]):
            position = math.nan if math.isnan(angle) else float(linkage.at(angle).slider_position)
            ends.append(Extreme(value, angle, position))
        extremes.append(CurveExtremes(curve.name, curve.title, curve.kind, *ends))
    return extremes


def defined_curves(mechanism: Mechanism, linkage: Linkage, crank_angle: Array) -> list[Curve]:
    """Return the curves that `curve_extremes` examines, at crank angles (n,), rad.

    On the crossed branch, the rod angle is about pi; it is given in [0, 2 pi), where it does not jump.
    """
    every = every_curve(mechanism, linkage, crank_angle)
    return [curve for curve in every if not undefined_curve_reason(curve.name, mechanism)]


def every_curve(mechanism: Mechanism, linkage: Linkage, crank_angle: Array) -> list[Curve]:
    """Return the curves of `defined_curves` plus those that the machine does not define, which are meaningless."""
    every = {curve.name: curve for curve in cycle_curves(mechanism, linkage, crank_angle)}
    del every["crank_angle"]
    if linkage.branch == "crossed":
        rod = every["rod_angle"]
        every["rod_angle"] = replace(rod, values=np.mod(rod.values, _TURN))
    curves = []
    for curve in every.values():
        joint = curve.name.removesuffix("_x")
        if joint != curve.name:  # the magnitude comes before its components
            size = np.hypot(curve.values, every[f"{joint}_y"].values)
            curves.append(Curve(joint, f"{joint.replace('_', ' ')} force", size, curve.kind))
        curves.append(curve)
    return curves


def undefined_curve_reason(name: str, mechanism: Mechanism) -> str:
    """Return the reason why a machine does not define a curve; empty if it does."""
    if name == "load" and not mechanism.loads:
        return 'it needs loads; got none; add a [[load]], for example force = "200 N"'
    return next((need.missing for need in _NEEDS.get(name, ()) if not need.is_met(mechanism)), "")


def crank_angles_of_cuts(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return ascending crank angles (k,) in a cycle from 0, rad, between which every curve is smooth.

    If friction locks the linkage, the angles are those without friction, because the forces are undetermined anyway.
    """
    dimensions = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    locks = not float(locking_margin(mechanism.friction, dimensions)[0][0]) > 0.0
    cuts = breakpoints(replace(mechanism, friction=Friction()) if locks else mechanism, linkage)
    ends = [float(angle) for angle in linkage.dead_centre_angles]
    fixed = np.mod([*ends, 0.5 * math.pi, 1.5 * math.pi], _TURN)
    fixed = np.concatenate([fixed, np.mod(speed_knots(mechanism), _TURN)])
    every = [cuts, *(fixed + turn * _TURN for turn in range(cycle_turns(mechanism)))]
    if mechanism.arrangement is not None:
        every.append(
            multi_cylinder_breakpoints(replace(mechanism, friction=Friction()) if locks else mechanism, linkage)
        )
    return np.unique(np.mod(np.concatenate(every), cycle_turns(mechanism) * _TURN))


def _smooth_pieces(mechanism: Mechanism, linkage: Linkage) -> list[Array]:
    """Return the crank angles of each smooth piece of the turn, with its ends moved inward by `_INSET`."""
    cuts = crank_angles_of_cuts(mechanism, linkage)
    kappa = crowding_parameter(float(linkage.crank), float(linkage.rod), float(linkage.offset))
    pieces = []
    for start, end in zip(cuts, [*cuts[1:], cuts[0] + cycle_turns(mechanism) * _TURN], strict=True):
        if end - start < 8.0 * _INSET:
            continue  # cuts that agree to within rounding
        low, high = crowded_from_crank_angle(start, kappa), crowded_from_crank_angle(end, kappa)
        count = max(_LEAST_SAMPLES, math.ceil((high - low) / _TURN * _SAMPLES))
        inner = [crank_angle_from_crowded(tau, kappa) for tau in np.linspace(low, high, count)[1:-1]]
        sides = [start + _INSET, start + 2.0 * _INSET, end - 2.0 * _INSET, end - _INSET]
        inner = [angle for angle in inner if sides[1] < angle < sides[2]]
        pieces.append(np.array([*sides[:2], *inner, *sides[2:]]))
    return pieces


def _curve_magnitudes(curves: list[Curve], samples: list[Array]) -> Array:
    """Return the maximum magnitude (m, 2) of each curve, and of all curves with its unit; NaN if undetermined."""
    magnitudes = np.max([np.abs(values).max(axis=1) for values in samples], axis=0)
    units = [curve.kind.unit for curve in curves]
    shared = [
        np.nanmax([0.0, *(size for size, curve_unit in zip(magnitudes, units, strict=True) if curve_unit == unit)])
        for unit in units
    ]
    return np.stack([magnitudes, shared], axis=1)


def _minima_and_maxima(
    values: Callable[[Array], Array], pieces: list[Array], samples: list[Array], sizes: Array, period: float
) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Return the minimum of each curve with its crank angle, and likewise its maximum.

    All brackets are refined together: many take hardly longer than a few.
    """
    sides = [_coarse_extremes(pieces, samples, sizes, sign) for sign in (-1.0, 1.0)]
    rows, left, right = (np.concatenate(parts) for parts in zip(*(side[1:] for side in sides), strict=True))
    at, signs = rows.astype(np.intp), np.repeat([-1.0, 1.0], [len(side[1]) for side in sides])
    tops, angles = golden_section_maxima(lambda theta: signs * values(theta)[at, np.arange(len(at))], left, right)
    ends = []
    for sign, (coarse, *_) in zip((-1.0, 1.0), sides, strict=True):
        refined = list(coarse)
        for row in np.unique(at[signs == sign]):
            candidates = np.flatnonzero((at == row) & (signs == sign))
            best = candidates[np.argmax(tops[candidates])]
            value, angle = refined[row]
            if tops[best] > value + _EQUAL * sizes[row, 0]:
                value, angle = float(tops[best]), float(angles[best])
            places, heights = _maxima_at_cuts([sign * values[row] for values in samples], pieces)
            away = np.all(np.abs(np.subtract.outer(angles[candidates], places)) > 4.0 * _INSET, axis=1)
            places = np.concatenate([[angle], places, angles[candidates][away]])
            first = index_of_first_maximum(np.concatenate([[value], heights, tops[candidates][away]]), places, period)
            refined[row] = (sign * value + 0.0, wrap_into_cycle(float(places[first]), period))
        ends.append(refined)
    return ends[0], ends[1]


def _coarse_extremes(
    pieces: list[Array], samples: list[Array], sizes: Array, sign: float
) -> tuple[list[tuple[float, float]], Array, Array, Array]:
    """Return each curve's highest value at a piece end, times the sign, and the brackets that may contain a higher one.

    For a constant or undetermined curve, return its value instead. Brackets: row of the curve, left and right crank
    angle.
    """
    ends: list[tuple[float, float]] = []
    brackets: list[tuple[int, float, float]] = []
    for row, (magnitude, shared) in enumerate(sizes):
        curve = [sign * values[row] for values in samples]
        top, bottom = max(values.max() for values in curve), min(values.min() for values in curve)
        if math.isnan(magnitude):
            ends.append((math.nan, math.nan))
        elif top - bottom <= _CONSTANT * shared:
            ends.append((0.0 if magnitude <= _CONSTANT * shared else sign * top, math.nan))
        else:
            ends.append(_highest_piece_end(curve, pieces))
            brackets += [(row, *bracket) for bracket in _maximum_brackets(curve, pieces)]
    rows, left, right = np.array(brackets, dtype=float).reshape(-1, 3).T
    return ends, rows, left, right


def _highest_piece_end(curve: list[Array], pieces: list[Array]) -> tuple[float, float]:
    """Return the maximum one-sided limit at the piece ends, linearly extrapolated, and its crank angle."""
    ends = []
    for angles, values in zip(pieces, curve, strict=True):
        ends.append((2.0 * values[0] - values[1], angles[0] - _INSET))
        ends.append((2.0 * values[-1] - values[-2], angles[-1] + _INSET))
    value, angle = max(ends, key=lambda end: end[0])
    return float(value), float(angle)


def _maxima_at_cuts(curve: list[Array], pieces: list[Array]) -> tuple[Array, Array]:
    """Return crank angles and values of the cuts that are local maxima: kinks, jumps and smooth maxima."""
    begin, end = (np.array([2.0 * v[a] - v[b] for v in curve]) for a, b in ((0, 1), (-1, -2)))
    rises, falls = np.array([v[1] > v[0] for v in curve]), np.array([v[-1] < v[-2] for v in curve])
    left, rising = np.roll(end, 1), ~np.roll(falls, 1)  # end of the piece before each cut
    top = np.where(left >= begin, rising & ((left > begin) | ~rises), ~rises)
    at = np.array([angles[0] - _INSET for angles in pieces])
    return at[top], np.maximum(left, begin)[top]


def _maximum_brackets(curve: list[Array], pieces: list[Array]) -> list[tuple[float, float]]:
    """Return the neighbours on both sides of each local maximum that may be next to the global maximum."""
    brackets: list[tuple[float, float, float]] = []
    for angles, values in zip(pieces, curve, strict=True):
        padded = np.concatenate([[-np.inf], values, [-np.inf]])
        highest = np.flatnonzero((values >= padded[:-2]) & (values >= padded[2:]))
        before, after = np.maximum(highest - 1, 0), np.minimum(highest + 1, len(angles) - 1)
        steps = np.abs(np.diff(values))  # two on each side: the last step of a piece may be short
        step = np.max([steps[np.clip(highest + k, 0, len(steps) - 1)] for k in (-2, -1, 0, 1)], axis=0)
        bounds = (values[highest] + _TOLERATED_STEPS * step).tolist()
        brackets += zip(bounds, angles[before].tolist(), angles[after].tolist(), strict=True)
    best = max(values.max() for values in curve)
    brackets.sort(key=lambda bracket: -bracket[0])
    return [(low, high) for bound, low, high in brackets[:_CANDIDATES] if bound >= best]


def golden_section_maxima(
    function: Callable[[Array], Array], left: Array, right: Array, sections: int = _SECTIONS
) -> tuple[Array, Array]:
    """Return the maximum of a function (n,) -> (n,) in each bracket, and its location, by golden sections."""
    if not len(left):
        return left, right
    low, high = left + (1.0 - _GOLDEN) * (right - left), left + _GOLDEN * (right - left)
    at_low, at_high = function(low), function(high)
    for _ in range(sections):
        lower = at_low >= at_high
        left, right = np.where(lower, left, low), np.where(lower, high, right)
        fresh = np.where(lower, left + (1.0 - _GOLDEN) * (right - left), left + _GOLDEN * (right - left))
        value = function(fresh)
        low, high = np.where(lower, fresh, high), np.where(lower, low, fresh)
        at_low, at_high = np.where(lower, value, at_high), np.where(lower, at_low, value)
    lower = at_low >= at_high
    return np.where(lower, at_low, at_high), np.where(lower, low, high)
