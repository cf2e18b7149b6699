"""Greatest stresses of crank and rod, and greatest swings of stress, exact over crank angle and place, with gradients.

Of every point of a bar, share xi of its length from the crank pin and face +-, the stress is a smooth curve over each
segment of the cycle (`segments`). Sought is the greatest value of

    p sigma(xi, theta) - q sigma(xi, phi),    p, q >= 0,

over place, face and two crank angles: with (p, q) = (1, 0) and (0, 1) the greatest tension and compression, and with

    2 p = 1 / S_e + 1 / S_m,   2 q = 1 / S_e - 1 / S_m      and      2 p = 2 q = 1 / S_e

the greatest amplitude / S_e + mean / S_m of one point over the cycle, a mean that is compression left out (Goodman's
line with its horizontal part, Shigley, "Mechanical Engineering Design", 9th ed., eq. 6-46): the pair of angles that is
greatest is that of the point's own greatest and least stress, since p, q >= 0.

Samples over crank angle and stations along the bar tell the highest maxima (`stress_search`). Each is then followed
between samples of its own, closer and closer, until the cubics between them are exact to rounding. Place and angles are
stationary, or at an end that moves with the design, so the gradient is the partial derivative there (envelope theorem).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask, Whole
from ..errors import InputError
from ..kernel.batches import in_chunks, turning
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_batch
from ..machine.two_turns import cycle_turns, halves
from .places import Place, Places, places_of
from .section_forces import Stress, at_share
from .stress_points import field_of
from .stress_search import LISTED, STATIONS, Candidates, choose, climb, first_candidates, propose, room_for

KEPT = 8
"""Maxima kept of a design, highest first."""
_NEAR, _WIDE = 0.05, 0.2  # how far below the highest sample a maximum is refined: for the value, for pieces
_TURN = 2.0 * math.pi
_EDGE = 1e-11  # rad, from a breakpoint: on it
_OTHER = 7.0  # weight of the second angle in a label, more than a turn
_EQUAL = 1e-6  # relative; what cubics between the samples of the cycle tell of two maxima, with two digits to spare
# Of the spacing of samples: how far off the ends of a cubic are, and within how much of its foretold place a maximum is
# then taken as it is: such a cubic is off by a millionth of what the last one was. Then how much closer the next is.
_CLOSE, _FORETOLD, _CLOSER, _ROUNDS = 0.01, 1e-3, 30.0, 10
_SECOND_TURN = 1e5  # of a label, more than all parts of a quantity take
APART, CLASSES = 60.0, 12
"""Distance of the labels of maxima that are no neighbours, more than a turn; how many classes there are of these."""


@dataclass(frozen=True)
class StressPeaks:
    """Local maxima of n designs, highest first.

    values: (n, k), -inf beyond the last one; inf where friction locks the design. labels: (n, k), what tells those of
    neighbouring designs apart. places: (n, k, 4), share of the length from the crank pin, face, both angles, rad.
    gradients: (n, k, 3 + v); None unless asked for.
    """

    values: Array
    labels: Array
    places: Array
    gradients: Array | None


@dataclass
class _Maxima:
    """Maxima of places, c of them: bar, number of face and criterion (c,); share of the length, value (c,).

    angle: (c, 2). segment: (c, 2). used: (c, 2), whether the angle counts. spacing: (c, 2), of samples there, rad.
    """

    which: Whole
    face: Whole
    pull: Whole
    share: Array
    value: Array
    angle: Array
    segment: Whole
    used: Mask
    spacing: Array

    def __post_init__(self) -> None:
        """Give an angle that does not count the value of the other one."""
        self.angle = np.where(self.used, self.angle, self.angle[:, ::-1])

    def at(self, rows: Whole) -> _Maxima:
        """Return some of them."""
        return _Maxima(**{name: each[rows] for name, each in vars(self).items()})


def _of_samples(bars: Places, faces: Array, criteria: Array, near: float, kept: int) -> _Maxima:
    """Return the highest maxima of the cubics between the samples of the cycle."""
    start, theta, first, segment, stress = bars.samples
    n = len(start) - 1
    # Every second station, face and criterion may be one, with all pairs of angles.
    room = n * len(faces) * len(criteria) * (STATIONS + 1) // 2 * LISTED**2
    space = np.empty((STATIONS, int(np.diff(start).max(initial=1)))), np.empty((2, LISTED), np.int64)
    best = np.empty((len(faces), len(criteria), STATIONS))
    found = room_for(room)
    count = propose(start, first, stress, 0, faces, criteria, near, *space, best, found)
    found = first_candidates(found, count)
    values, angles, chosen = np.empty(count), np.empty((count, 2)), np.empty((n, kept), np.int64)
    climb(theta, first, stress, 0, faces, criteria, found, values, angles)
    choose(found, criteria, values, angles, chosen)
    rows = chosen[chosen >= 0]
    at = found.at[rows]
    here, further = theta[at], np.minimum(at + 1, len(theta) - 1)
    ahead = (segment[further] == segment[at]) & (theta[further] > here)
    spacing = np.abs(theta[np.where(ahead, further, at - 1)] - here)
    return _Maxima(
        found.which[rows],
        found.face[rows],
        found.pull[rows],
        found.share[rows],
        values[rows],
        angles[rows],
        segment[at],
        criteria[found.pull[rows]] > 0.0,
        spacing,
    )


def _close_in(bars: Places, faces: Array, criteria: Array, maxima: _Maxima) -> None:
    """Follow maxima between samples of their own, until these are so close that the cubics are exact."""
    begin, end = bars.ends(np.repeat(maxima.which, 2), maxima.segment.ravel())
    begin, end = begin.reshape(-1, 2), end.reshape(-1, 2)
    width, near = _CLOSE * maxima.spacing, _FORETOLD * maxima.spacing
    waiting = np.arange(len(maxima.which))
    for _ in range(_ROUNDS):
        if not len(waiting):
            return
        used, c = maxima.used[waiting], len(waiting)
        low = np.maximum(begin[waiting], maxima.angle[waiting] - width[waiting])
        high = np.minimum(end[waiting], maxima.angle[waiting] + width[waiting])
        theta = np.stack([low[used], high[used]], axis=1).ravel()
        which = np.repeat(np.broadcast_to(maxima.which[waiting, None], (c, 2))[used], 2)
        stress = bars.at(which, np.repeat(maxima.segment[waiting][used], 2), theta)
        at = np.zeros((c, 2), np.int64)
        at[used] = 2 * np.arange(len(theta) // 2)
        own = Candidates(maxima.which[waiting], maxima.face[waiting], maxima.pull[waiting], at, maxima.share[waiting])
        values, angles = np.empty(c), np.full((c, 2), np.nan)
        climb(theta, np.arange(len(theta)) % 2 == 0, stress, 0, faces, criteria, own, values, angles)
        angles = np.where(used, angles, angles[:, ::-1])
        moved = np.abs(angles - maxima.angle[waiting])
        maxima.value[waiting], maxima.share[waiting], maxima.angle[waiting] = values, own.share, angles
        settled = np.all(moved <= near[waiting], axis=1)
        inside = (angles > low) | (low <= begin[waiting])
        inside &= (angles < high) | (high >= end[waiting])
        closer = waiting[np.all(inside | ~used, axis=1)]
        width[closer] /= _CLOSER
        near[closer] *= _CLOSER  # what is left is off by less, wherever it was foretold
        waiting = waiting[~settled]


def _gradients(bars: Places, faces: Array, criteria: Array, maxima: _Maxima, pins: Whole) -> Array:
    """Return the derivatives (c, 3 + k) of maxima on breakpoints `pins` (c, 2), or on none (-1)."""
    used = maxima.used
    which = np.broadcast_to(maxima.which[:, None], used.shape)[used]
    slopes = bars.slopes(which, maxima.segment[used], maxima.angle[used], pins[used])
    shares, sides = (np.repeat(each, used.sum(axis=1))[:, None] for each in (maxima.share, faces[maxima.face]))
    weights = (criteria[maxima.pull] * np.array([1.0, -1.0]))[used]
    own = weights[:, None] * at_share(Stress(*np.moveaxis(slopes, 2, 0)), sides, shares)
    summed = np.zeros((len(used), own.shape[1]))
    np.add.at(summed, np.nonzero(used)[0], own)
    return summed


_FACES = np.array([1.0, -1.0])


_kept_field = memoise_by_batch(field_of)


def _peaks(bars: Places, criteria: Array, gradients: bool, kept: int) -> StressPeaks:
    n, width = bars.rows, bars.rates.shape[1]
    found = StressPeaks(
        np.full((n, kept), -np.inf),
        np.zeros((n, kept)),
        np.full((n, kept, 4), np.nan),
        np.zeros((n, kept, width)) if gradients else None,
    )
    # Of several that are equal to the samples' accuracy each may be the highest.
    maxima = _of_samples(bars, _FACES, criteria, _NEAR if kept == 1 else _WIDE, max(kept, 3))
    if kept == 1:
        top = np.full(n, -np.inf)
        np.maximum.at(top, maxima.which, maxima.value)
        maxima = maxima.at(np.flatnonzero(maxima.value >= (top - _EQUAL * np.abs(top))[maxima.which]))
    _close_in(bars, _FACES, criteria, maxima)
    own = Candidates(maxima.which, maxima.face, maxima.pull, np.zeros((len(maxima.which), 2), np.int64), maxima.share)
    chosen = np.empty((n, kept), np.int64)
    choose(own, criteria, maxima.value, maxima.angle, chosen)
    there = chosen >= 0
    maxima = maxima.at(chosen[there])
    begin, end = (each.reshape(-1, 2) for each in bars.ends(np.repeat(maxima.which, 2), maxima.segment.ravel()))
    early, late = maxima.angle - begin < _EDGE, end - maxima.angle < _EDGE
    maxima.angle = np.where(early, begin, np.where(late, end, maxima.angle))
    after = (maxima.segment + 1) % bars.many(maxima.which)[:, None]
    pins = np.where(early, maxima.segment, np.where(late, after, -1))
    ended = np.where(maxima.share == 0.0, 1, np.where(maxima.share == 1.0, 2, 0))
    turned = np.where(maxima.used, maxima.angle - _TURN * np.floor(maxima.angle / _TURN), 0.0)
    number = (maxima.face * len(criteria) + maxima.pull) * 3 + ended
    found.values[there] = maxima.value
    found.labels[there] = APART * number + turned[:, 0] + _OTHER * turned[:, 1]
    found.places[there] = np.column_stack([maxima.share, _FACES[maxima.face], maxima.angle])
    if found.gradients is not None:
        found.gradients[there] = _gradients(bars, _FACES, criteria, maxima, pins)
    found.values[bars.locked, 0] = np.inf
    return found


def _require_one_sided(criteria: Array) -> None:
    """Raise `InputError` for criteria that compare two crank angles, which may be of different turns."""
    if (criteria > 0.0).all(axis=1).any():
        raise InputError(
            "greatest and least stress of one place are those of one turn; got a cycle of 720 deg; leave the fatigue "
            "safety out"
        )


def _of_both(first: StressPeaks, second: StressPeaks, kept: int) -> StressPeaks:
    """Return the highest maxima of two turns."""
    order = np.argsort(-np.concatenate([first.values, second.values], axis=1), axis=1, kind="stable")[:, :kept]

    def taken(one: Array, two: Array) -> Array:
        both = np.concatenate([one, two], axis=1)
        return np.take_along_axis(both, order.reshape(*order.shape, *[1] * (both.ndim - 2)), axis=1)

    slopes, later = None, second.places + np.array([0.0, 0.0, _TURN, _TURN])
    if first.gradients is not None and second.gradients is not None:
        slopes = taken(first.gradients, second.gradients)
    labels = taken(first.labels, second.labels + _SECOND_TURN)
    return StressPeaks(taken(first.values, second.values), labels, taken(first.places, later), slopes)


def stress_peaks(
    mechanism: Mechanism,
    places: Sequence[Place],
    designs: Array,
    criteria: Array,
    *,
    gradients: bool = False,
    kept: int = KEPT,
) -> list[StressPeaks]:
    """Return the greatest p sigma - q sigma of designs (n, 3 + k) at each place; see `Place` for what sigma is.

    criteria: (m, 2), p and q of each, none negative. kept: maxima returned a design; with one only the highest ones are
    followed. The links of the places must be `Bar`.
    """
    designs = turning(designs)
    criteria = np.ascontiguousarray(criteria, dtype=np.float64)
    if cycle_turns(mechanism) > 1:
        _require_one_sided(criteria)
        turns = (
            stress_peaks(half, places, designs, criteria, gradients=gradients, kept=kept) for half in halves(mechanism)
        )
        return [_of_both(first, second, kept) for first, second in zip(*turns, strict=True)]
    many, n = len(places), len(designs)
    values, labels, where = np.empty((many, n, kept)), np.empty((many, n, kept)), np.empty((many, n, kept, 4))
    slopes = np.empty((many, n, kept, designs.shape[1])) if gradients else None

    def work(begin: int, end: int) -> None:
        own = designs[begin:end]
        found = _peaks(places_of(_kept_field(mechanism, own), mechanism, own, places), criteria, gradients, kept)
        for target, part in ((values, found.values), (labels, found.labels), (where, found.places)):
            target[:, begin:end] = part.reshape(many, end - begin, *part.shape[1:])
        if slopes is not None and found.gradients is not None:
            slopes[:, begin:end] = found.gradients.reshape(many, end - begin, kept, -1)

    in_chunks(n, work)
    return [StressPeaks(values[p], labels[p], where[p], None if slopes is None else slopes[p]) for p in range(many)]
