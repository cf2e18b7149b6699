"""Maximum stresses and stress ranges in crank and rod, exact over crank angle and location, with gradients.

At every point of a bar (fraction xi of its length from the crank pin, face +-), the stress is a smooth curve in each
segment of the cycle (`segments`). This module finds the maximum of

    p sigma(xi, theta) - q sigma(xi, phi),    p, q >= 0,

over location, face and two crank angles: (p, q) = (1, 0) and (0, 1) give the maximum tension and compression, while

    2 p = 1 / S_e + 1 / S_m,   2 q = 1 / S_e - 1 / S_m      and      2 p = 2 q = 1 / S_e

give the maximum of amplitude / S_e + mean / S_m at one point over the cycle, ignoring compressive mean stress
(Goodman's line with its horizontal part, Shigley, "Mechanical Engineering Design", 9th ed., eq. 6-46). Since p, q >= 0,
the maximising pair of angles is that of the point's own maximum and minimum stress.

Samples over crank angle and stations along the bar locate the highest maxima (`stress_search`). Each is then followed
using samples of its own at ever smaller distances, until the cubics between them are exact to rounding. Location and
angles are stationary, or at an end that moves with the design. The gradient is therefore the partial derivative there
(envelope theorem).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IntArray, Mask
from ..kernel.batches import require_full_rotation, run_in_chunks
from ..machine.cylinders_and_turns import machines_of_turns
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_batch
from ..signals.two_turn_peaks import angles_within_both_turns
from .section_forces import Stress, stress_at_length_fraction
from .stress_locations import StressLocation, StressLocations, stress_at_locations
from .stress_points import stress_field_of
from .stress_search import (
    LISTED,
    STATIONS,
    Candidates,
    SampledStress,
    choose_highest_candidates,
    climb_to_maxima,
    first_rows_of_candidates,
    list_maximum_candidates,
    uninitialised_candidates,
)

STORED_MAXIMA = 8
"""Maxima stored per design, highest first."""
_NEAR, _WIDE = 0.05, 0.2  # depth below the highest sample down to which maxima are refined: for the value, for pieces
_TURN = 2.0 * math.pi
_EDGE = 1e-11  # rad, distance from a breakpoint within which an angle is at it
_OTHER = 7.0  # weight of the second angle in a label, more than a turn
_EQUAL = 1e-6  # relative; accuracy of cubics between samples when comparing maxima, with two digits to spare
# Fractions of the spacing of samples: distance of the ends of a cubic, and of a maximum from its predicted place within
# which it is accepted (such a cubic has a millionth of the last one's error); then the ratio to the next distance.
_CLOSE, _FORETOLD, _CLOSER, _ROUNDS = 0.01, 1e-3, 30.0, 10
LABEL_STEP, CLASSES = 60.0, 12
"""Distance between labels of maxima that are not neighbours, more than a turn; number of their classes."""


@dataclass(frozen=True)
class StressPeaks:
    """Local maxima for n designs, highest first.

    values: (n, k), -inf beyond the last one; inf where friction locks the design. labels: identifiers (n, k) that match
    maxima between neighbouring designs. places: (n, k, 4), fraction of the length from the crank pin, face, both crank
    angles within the cycle, rad. gradients: (n, k, 3 + v); None unless requested.
    """

    values: Array
    labels: Array
    places: Array
    gradients: Array | None


@dataclass
class _Maxima:
    """Maxima at c locations: bar, index of side and criterion (c,); fraction of the length, value (c,).

    angle: (c, 2). segment: (c, 2). is_counted: (c, 2), whether the angle counts. spacing: (c, 2), between samples, rad.
    """

    bar: IntArray
    side: IntArray
    pull: IntArray
    share: Array
    value: Array
    angle: Array
    segment: IntArray
    is_counted: Mask
    spacing: Array

    def __post_init__(self) -> None:
        """Give an angle that does not count the value of the other angle."""
        self.angle = np.where(self.is_counted, self.angle, self.angle[:, ::-1])

    def select(self, rows: IntArray) -> _Maxima:
        """Return a selection of the maxima."""
        return _Maxima(**{name: column[rows] for name, column in vars(self).items()})


def _maxima_of_samples(bars: StressLocations, sides: Array, criteria: Array, margin: float, limit: int) -> _Maxima:
    """Return the highest maxima of the cubics between the samples of the cycle."""
    start, theta, first, segment, stress = bars.samples
    n = len(start) - 1
    # Every second station may have a maximum for each face and criterion, with all pairs of angles.
    candidate_count = n * len(sides) * len(criteria) * (STATIONS + 1) // 2 * LISTED**2
    space = np.empty((STATIONS, int(np.diff(start).max(initial=1)))), np.empty((2, LISTED), np.int64)
    best = np.empty((len(sides), len(criteria), STATIONS))
    candidates = uninitialised_candidates(candidate_count)
    samples = SampledStress(theta, first, stress, sides)
    count = list_maximum_candidates(start, samples, criteria, margin, *space, best, candidates)
    candidates = first_rows_of_candidates(candidates, count)
    values, angles, chosen = np.empty(count), np.empty((count, 2)), np.empty((n, limit), np.int64)
    climb_to_maxima(samples, criteria, candidates, values, angles)
    turns = bars.turns_of_segments(segment[candidates.samples])
    choose_highest_candidates(candidates, criteria, values, angles, turns, chosen)
    rows = chosen[chosen >= 0]
    at = candidates.samples[rows]
    angle_there, further = theta[at], np.minimum(at + 1, len(theta) - 1)
    ahead = (segment[further] == segment[at]) & (theta[further] > angle_there)
    spacing = np.abs(theta[np.where(ahead, further, at - 1)] - angle_there)
    return _Maxima(
        candidates.bar[rows],
        candidates.side[rows],
        candidates.pull[rows],
        candidates.share[rows],
        values[rows],
        angles[rows],
        segment[at],
        criteria[candidates.pull[rows]] > 0.0,
        spacing,
    )


def _refine_maxima(bars: StressLocations, sides: Array, criteria: Array, maxima: _Maxima) -> None:
    """Follow maxima using samples of their own, until these are so close that the cubics are exact."""
    begin, end = bars.segment_end_angles(np.repeat(maxima.bar, 2), maxima.segment.ravel())
    begin, end = begin.reshape(-1, 2), end.reshape(-1, 2)
    width, near = _CLOSE * maxima.spacing, _FORETOLD * maxima.spacing
    waiting = np.arange(len(maxima.bar))
    for _ in range(_ROUNDS):
        if not len(waiting):
            return
        is_counted, c = maxima.is_counted[waiting], len(waiting)
        low = np.maximum(begin[waiting], maxima.angle[waiting] - width[waiting])
        high = np.minimum(end[waiting], maxima.angle[waiting] + width[waiting])
        theta = np.stack([low[is_counted], high[is_counted]], axis=1).ravel()
        rows = np.repeat(np.broadcast_to(maxima.bar[waiting, None], (c, 2))[is_counted], 2)
        stress = bars.stress_at(rows, np.repeat(maxima.segment[waiting][is_counted], 2), theta)
        sample_rows = np.zeros((c, 2), np.int64)
        sample_rows[is_counted] = 2 * np.arange(len(theta) // 2)
        candidates = Candidates(
            maxima.bar[waiting], maxima.side[waiting], maxima.pull[waiting], sample_rows, maxima.share[waiting]
        )
        samples = SampledStress(theta, np.arange(len(theta)) % 2 == 0, stress, sides)
        values, angles = np.empty(c), np.full((c, 2), np.nan)
        climb_to_maxima(samples, criteria, candidates, values, angles)
        angles = np.where(is_counted, angles, angles[:, ::-1])
        moved = np.abs(angles - maxima.angle[waiting])
        maxima.value[waiting], maxima.share[waiting], maxima.angle[waiting] = values, candidates.share, angles
        is_converged = np.all(moved <= near[waiting], axis=1)
        is_inside = (angles > low) | (low <= begin[waiting])
        is_inside &= (angles < high) | (high >= end[waiting])
        closer = waiting[np.all(is_inside | ~is_counted, axis=1)]
        width[closer] /= _CLOSER
        near[closer] *= _CLOSER  # the remaining ones err by less, wherever they were predicted
        waiting = waiting[~is_converged]


def _maxima_gradients(
    bars: StressLocations, all_sides: Array, criteria: Array, maxima: _Maxima, pins: IntArray
) -> Array:
    """Return the derivatives (c, 3 + k) of maxima at breakpoints `pins` (c, 2), or at none (-1)."""
    is_counted = maxima.is_counted
    counted_bars = np.broadcast_to(maxima.bar[:, None], is_counted.shape)[is_counted]
    slopes = bars.design_slopes(counted_bars, maxima.segment[is_counted], maxima.angle[is_counted], pins[is_counted])
    shares, sides = (
        np.repeat(column, is_counted.sum(axis=1))[:, None] for column in (maxima.share, all_sides[maxima.side])
    )
    weights = (criteria[maxima.pull] * np.array([1.0, -1.0]))[is_counted]
    weighted = weights[:, None] * stress_at_length_fraction(Stress(*np.moveaxis(slopes, 2, 0)), sides, shares)
    summed = np.zeros((len(is_counted), weighted.shape[1]))
    np.add.at(summed, np.nonzero(is_counted)[0], weighted)
    return summed


_SIDES = np.array([1.0, -1.0])


_memoised_field = memoise_by_batch(stress_field_of)


def _peaks_at_locations(
    mechanism: Mechanism, designs: Array, bars: StressLocations, criteria: Array, gradients: bool, limit: int
) -> StressPeaks:
    n, width = bars.bar_count, bars.rates.shape[1]
    peaks = StressPeaks(
        np.full((n, limit), -np.inf),
        np.zeros((n, limit)),
        np.full((n, limit, 4), np.nan),
        np.zeros((n, limit, width)) if gradients else None,
    )
    # Any of several maxima that are equal to the samples' accuracy may be the highest.
    maxima = _maxima_of_samples(bars, _SIDES, criteria, _NEAR if limit == 1 else _WIDE, max(limit, 3))
    if limit == 1:
        top = np.full(n, -np.inf)
        np.maximum.at(top, maxima.bar, maxima.value)
        maxima = maxima.select(np.flatnonzero(maxima.value >= (top - _EQUAL * np.abs(top))[maxima.bar]))
    _refine_maxima(bars, _SIDES, criteria, maxima)
    candidates = Candidates(
        maxima.bar, maxima.side, maxima.pull, np.zeros((len(maxima.bar), 2), np.int64), maxima.share
    )
    chosen = np.empty((n, limit), np.int64)
    choose_highest_candidates(
        candidates, criteria, maxima.value, maxima.angle, bars.turns_of_segments(maxima.segment), chosen
    )
    is_found = chosen >= 0
    maxima = maxima.select(chosen[is_found])
    begin, end = (
        ends.reshape(-1, 2) for ends in bars.segment_end_angles(np.repeat(maxima.bar, 2), maxima.segment.ravel())
    )
    early, late = maxima.angle - begin < _EDGE, end - maxima.angle < _EDGE
    maxima.angle = np.where(early, begin, np.where(late, end, maxima.angle))
    next_segment = bars.next_segments(np.repeat(maxima.bar, 2), maxima.segment.ravel()).reshape(-1, 2)
    pins = np.where(early, maxima.segment, np.where(late, next_segment, -1))
    ended = np.where(maxima.share == 0.0, 1, np.where(maxima.share == 1.0, 2, 0))
    turn, turns = bars.turns_of_segments(maxima.segment), len(bars.fields)
    within_turn = maxima.angle - _TURN * np.floor(maxima.angle / _TURN)
    turned = np.where(maxima.is_counted, (within_turn + _TURN * turn) / turns, 0.0)
    label_class = (maxima.side * len(criteria) + maxima.pull) * 3 + ended
    peaks.values[is_found] = maxima.value
    peaks.labels[is_found] = LABEL_STEP * label_class + turned[:, 0] + _OTHER * turned[:, 1]
    angles = maxima.angle
    if turns > 1:
        angles = angles_within_both_turns(mechanism, designs[bars.designs_of_bars(maxima.bar)], angles, turn)
    peaks.places[is_found] = np.column_stack([maxima.share, _SIDES[maxima.side], angles])
    if peaks.gradients is not None:
        peaks.gradients[is_found] = _maxima_gradients(bars, _SIDES, criteria, maxima, pins)
    peaks.values[bars.locked_bars, 0] = np.inf
    return peaks


def stress_peaks(
    mechanism: Mechanism,
    places: Sequence[StressLocation],
    designs: Array,
    criteria: Array,
    *,
    gradients: bool = False,
    limit: int = STORED_MAXIMA,
) -> list[StressPeaks]:
    """Return the maximum of p sigma - q sigma for designs (n, 3 + k) at each `StressLocation`.

    criteria: (m, 2), p and q of each, none negative. limit: maxima returned per design; if 1, only the highest ones are
    followed. The links at the locations must be `Bar`.
    """
    designs = require_full_rotation(designs)
    criteria = np.ascontiguousarray(criteria, dtype=np.float64)
    location_count, n = len(places), len(designs)
    values, labels, peak_places = (
        np.empty((location_count, n, limit)),
        np.empty((location_count, n, limit)),
        np.empty((location_count, n, limit, 4)),
    )
    slopes = np.empty((location_count, n, limit, designs.shape[1])) if gradients else None

    def work(begin: int, end: int) -> None:
        chunk = designs[begin:end]
        fields = [_memoised_field(machine, chunk) for machine in machines_of_turns(mechanism)]
        bars = stress_at_locations(fields, mechanism, chunk, places)
        peaks = _peaks_at_locations(mechanism, chunk, bars, criteria, gradients, limit)
        for target, part in ((values, peaks.values), (labels, peaks.labels), (peak_places, peaks.places)):
            target[:, begin:end] = part.reshape(location_count, end - begin, *part.shape[1:])
        if slopes is not None and peaks.gradients is not None:
            slopes[:, begin:end] = peaks.gradients.reshape(location_count, end - begin, limit, -1)

    run_in_chunks(n, work)
    return [
        StressPeaks(values[p], labels[p], peak_places[p], None if slopes is None else slopes[p])
        for p in range(location_count)
    ]
