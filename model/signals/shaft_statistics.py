"""Peaks and averages of a machine treated as a shaft: of totals, and of single cylinders.

Torque and power, moving inertia, shaking force, moment and rocking couple are totals of all cylinders. Joint forces and
slider motion are those of the cylinder with the largest value, whose crank angle is counted from its own slider line.
Without a profile, cylinders with equal gravity have equal values. Geometry depends neither on cylinders nor on the
profile.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..kernel.batches import run_in_chunks
from ..machine.cylinders_and_turns import TURN, cylinder_count, machine_of_each_cylinder, single_cylinder_machine
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_machine
from ..machine.raw_machine_vector import load_knot_count
from ..machine.work_absorption import may_do_work_over_a_turn
from .panel_polynomials import resolve_curves
from .shaft import Shaft
from .shaft_averages import MEAN, SQUARE, shaft_means, shaft_peaks
from .shaft_curves import CURVES, WORK
from .shaking_balance import has_rocking_couple
from .signals import Signal

PeakArrays = tuple[Array, Array, Array | None]

SUMS = (
    Signal.TORQUE,
    Signal.POWER,
    Signal.REFLECTED_INERTIA,
    Signal.SHAKING_FORCE,
    Signal.SHAKING_MOMENT,
    Signal.ROCKING_COUPLE,
)
"""Signals that add up over the cylinders."""
_GEOMETRY = (Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS)
_CHUNK = 128  # designs
_STROKES = {"cycle": None, "outward stroke": True, "inward stroke": False}


def equivalent_single_cranks(mechanism: Mechanism, kind: Signal) -> tuple[Mechanism, ...]:
    """Return single-crank machines at constant speed that have the same highest peak as the shaft, if there are any."""
    if kind in _GEOMETRY:
        return (single_cylinder_machine(mechanism),)
    banked = any(cylinder.bank for cylinder in machine_of_each_cylinder(mechanism))
    turned = banked and any(path.startswith("gravity.") for item in mechanism.varying for path in item.paths)
    if kind in SUMS or mechanism.speed_profile is not None or turned:
        return ()
    return tuple(
        {cylinder.mechanism.gravity: cylinder.mechanism for cylinder in machine_of_each_cylinder(mechanism)}.values()
    )


def shaft_signal_peaks(
    mechanism: Mechanism, kind: Signal, designs: Array, *, during: str, gradients: bool, limit: int
) -> PeakArrays:
    """Return values, angles (n, kept) and derivatives for the highest local peaks of a signal; see `find_peaks`.

    NaN for several cylinders over one stroke, and for a rocking couple of cylinders in one plane.
    """
    cylinders = cylinder_count(mechanism)
    if (during != "cycle" and cylinders > 1) or (kind is Signal.ROCKING_COUPLE and not has_rocking_couple(mechanism)):
        nothing = np.full((len(designs), limit), np.nan)
        return nothing, nothing.copy(), np.full((len(designs), limit, designs.shape[1]), np.nan) if gradients else None
    groups = [tuple(range(cylinders))] if kind in SUMS else [(k,) for k in range(cylinders)]
    values, angles = (np.empty((len(designs), len(groups), limit)) for _ in range(2))
    slopes = np.empty((len(designs), len(groups), limit, designs.shape[1])) if gradients else None

    def work(begin: int, end: int) -> None:
        part = designs[begin:end]
        for index, group in enumerate(groups):
            shaft = Shaft(mechanism, int(kind), part, members=group, during=during, gradients=gradients)
            peaks = shaft_peaks(shaft, limit=limit, stroke=_STROKES[during])
            values[begin:end, index], angles[begin:end, index] = peaks[:2]
            if len(group) == 1 and cylinders > 1:
                angles[begin:end, index] = np.mod(
                    peaks[1] + machine_of_each_cylinder(mechanism)[index].lead, shaft.period
                )
            if slopes is not None:
                slopes[begin:end, index] = peaks[2]

    run_in_chunks(len(designs), work, size=_CHUNK, knots=load_knot_count(mechanism))
    return merge_highest_peaks(
        [(values[:, p], angles[:, p], None if slopes is None else slopes[:, p]) for p in range(len(groups))]
    )


def merge_highest_peaks(parts: list[PeakArrays]) -> PeakArrays:
    """Return the highest among several lists of peaks (n, k), as many as each has."""
    if len(parts) == 1:
        return parts[0]
    limit = parts[0][0].shape[1]
    values, angles = (np.concatenate([part[index] for part in parts], axis=1) for index in range(2))
    order = np.argsort(-values, axis=1, kind="stable")[:, :limit]
    slopes = None
    if all(part[2] is not None for part in parts):
        all_slopes = np.concatenate([np.asarray(part[2]) for part in parts], axis=1)
        slopes = np.take_along_axis(all_slopes, order[:, :, None], axis=1)
    return np.take_along_axis(values, order, axis=1), np.take_along_axis(angles, order, axis=1), slopes


def shaft_signal_averages(
    mechanism: Mechanism, kind: Signal, designs: Array, *, gradients: bool
) -> tuple[Array, Array | None]:
    """Return `Averages` (3, n) of a signal that adds up, and their derivatives (3, n, 3 + k); see `signal_averages`.

    The mean of a signal judged by its magnitude is NaN, except for the reflected inertia.
    """
    members = tuple(range(cylinder_count(mechanism)))
    averages, slopes = _curve_averages(mechanism, [int(kind)], designs, members, gradients)
    values, slopes = averages[:, :, 0], None if slopes is None else slopes[:, :, 0]
    locks = np.isnan(values[1])
    values[1:, locks] = np.inf
    if kind is Signal.TORQUE and not may_do_work_over_a_turn(mechanism):  # exact, without rounding error
        values[0] = np.where(locks, np.nan, 0.0)
        if slopes is not None:
            slopes[0] = 0.0
    elif kind not in (Signal.TORQUE, Signal.REFLECTED_INERTIA):
        values[0] = np.nan
        if slopes is not None:
            slopes[0] = np.nan
    return values, slopes


def _curve_averages(
    mechanism: Mechanism, kinds: Sequence[int], designs: Array, members: tuple[int, ...], gradients: bool
) -> tuple[Array, Array | None]:
    """Return `Averages` (3, n, c) of curves and their derivatives (3, n, c, 3 + k).

    NaN where friction locks the design.
    """
    shape = 3, len(designs), len(kinds)
    values, slopes = np.empty(shape), np.empty((*shape, designs.shape[1])) if gradients else None

    def work(begin: int, end: int) -> None:
        part = designs[begin:end]
        shaft = Shaft(mechanism, kinds[0], part, members=members, gradients=gradients)
        for index, kind in enumerate(kinds):
            means = shaft_means(shaft.with_curve(kind), len(part))
            roots = np.where(means.nothing, 0.0, np.sqrt(means.values[SQUARE:]))
            values[0, begin:end, index] = np.where(means.nothing, 0.0, means.values[MEAN])
            values[1:, begin:end, index] = roots
            if slopes is not None and means.gradients is not None:
                is_positive = (roots > 0.0)[:, :, None]
                slopes[0, begin:end, index] = np.where(means.nothing[:, None], 0.0, means.gradients[MEAN])
                half = 0.5 / np.where(is_positive, roots[:, :, None], 1.0)
                slopes[1:, begin:end, index] = np.where(is_positive, half * means.gradients[SQUARE:], 0.0)

    run_in_chunks(len(designs), work, size=_CHUNK, knots=load_knot_count(mechanism))
    return values, slopes


def shaft_turn_work(mechanism: Mechanism, designs: Array, *, gradients: bool) -> tuple[Array, Array | None]:
    """Return the means (n, 5) from `turn_work`, added up over the cylinders, and their derivatives (n, 5, 3 + k)."""
    mean = np.zeros((len(designs), CURVES))
    slopes = np.zeros((len(designs), CURVES, designs.shape[1])) if gradients else None
    for member in range(cylinder_count(mechanism)):
        member_mean, member_slopes = _curve_averages(
            mechanism, range(WORK, WORK + CURVES), designs, (member,), gradients
        )
        mean += member_mean[0]
        if slopes is not None and member_slopes is not None:
            slopes += member_slopes[0]
    locks = np.isnan(mean)
    if slopes is not None:
        slopes[locks] = 0.0
    return np.where(locks, np.inf, mean), slopes


def mean_speed_ratio(mechanism: Mechanism) -> float:
    """Return the mean speed over time divided by that over the crank angle; 1 without a profile."""
    return 1.0 if mechanism.speed_profile is None else mechanism.speed_profile.time_mean_over_angle_mean


@memoise_by_machine
def greatest_speed_ratio(mechanism: Mechanism) -> float:
    """Return the maximum speed over the crank angle divided by its mean; 1 without a profile."""
    profile = mechanism.speed_profile
    if profile is None:
        return 1.0
    ends = np.union1d(np.linspace(0.0, TURN, 9), np.mod(profile.knots, TURN))
    return resolve_curves(lambda angle: profile.speed_ratio(angle)[None], ends, np.ones(1)).extremes(0)[1].value
