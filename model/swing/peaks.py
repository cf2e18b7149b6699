"""Peaks of a curve over a swing for many designs, to machine precision, with exact derivatives.

Each piece is sampled; tops between samples are refined on the slope over the time, which the complex step gives
exactly. The derivative of a peak by a design's number is the partial one at its share of the time (envelope theorem);
a peak on a cut moves with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..arrays import Array, Whole
from ..kernel.arithmetic import STEP
from ..kernel.batches import in_chunks
from ..machine.mechanism import Mechanism
from .closure import passes
from .many import Many, Pieces
from .points import DRIVE, ERROR
from .swing import Swing

KEPT = 6
"""Peaks kept of a design, highest first."""
_LEAST, _ALL = 9, 41  # samples of a piece, and of a way in one piece
_NEAR = 0.1  # tops this much below the highest sample, relative, cannot be the highest peak
_ITERATIONS = 60
_SAME = 1e-9
_CHUNK = 128


@dataclass(frozen=True)
class SwingPeaks:
    """Local peaks of n designs, highest first.

    values: (n, k), SI, -inf beyond the last peak; NaN for a design that cannot swing as asked, +inf where friction
    locks it. places: (n, k), share of the time of the way, 1 more on the way back. gradients: (n, k, v), by the
    design's numbers; None unless asked for.
    """

    values: Array
    places: Array
    gradients: Array | None


@dataclass(frozen=True)
class _Tops:
    """Candidates (p,) of many designs: where they are, and between which shares."""

    design: Whole
    piece: Whole
    cut: Whole
    share: Array
    low: Array
    high: Array


def swing_peaks(
    mechanism: Mechanism, swing: Swing, state: int, designs: Array, *, gradients: bool = False, kept: int = KEPT
) -> SwingPeaks:
    """Return the greatest sizes of a state (`points.DRIVE`, `POWER` or `ERROR`) for designs (n, 3 + k).

    kept: peaks returned of a design.
    """
    found = partial(_peaks, state=state, kept=kept, gradients=gradients)
    return _gathered(mechanism, swing, designs, kept, gradients, found, forces=state != ERROR)


def least_drives(
    mechanism: Mechanism, swing: Swing, designs: Array, *, back: bool, gradients: bool = False, kept: int = KEPT
) -> SwingPeaks:
    """Return the least drives along the motion of one way, without inertia, negated: local peaks, highest first.

    Where the least one is below zero, loads push the linkage on, and the drive holds it back.
    """

    def found(many: Many) -> tuple[Array, Array, Array]:
        first, last = (many.driver_at(end) for end in (many.ends.start, many.ends.end))
        toward = np.where(last > first, -1.0, 1.0) * (-1.0 if back else 1.0)
        own = many.pieces(back=back)
        return _of_way(many, own, DRIVE, kept, gradients, toward)

    return _gathered(mechanism, swing, designs, kept, gradients, found, slow=True)


def holding_peaks(
    mechanism: Mechanism, swing: Swing, designs: Array, *, free: bool = False, gradients: bool = False
) -> SwingPeaks:
    """Return the sizes of the drive at the ends of designs (n, 3 + k), without inertia. free: without friction."""
    one = np.ones((1, 3 + len(mechanism.varying)))
    ways = 2 if Many(mechanism, swing, one, slopes=False, slow=True, free=free).both else 1
    found = partial(_at_ends, gradients=gradients)
    return _gathered(mechanism, swing, designs, 2 * ways, gradients, found, slow=True, free=free)


def _gathered(
    mechanism: Mechanism,
    swing: Swing,
    designs: Array,
    kept: int,
    gradients: bool,
    of: Any,
    *,
    slow: bool = False,
    free: bool = False,
    forces: bool = True,
) -> SwingPeaks:
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    n = len(designs)
    values, places = np.full((n, kept), -np.inf), np.full((n, kept), np.nan)
    slopes = np.zeros((n if gradients else 0, kept, designs.shape[1]))
    values[:, 0] = np.nan
    rows = np.flatnonzero(passes(mechanism, swing, designs))

    def work(begin: int, end: int) -> None:
        own = rows[begin:end]
        many = Many(mechanism, swing, designs[own], slopes=gradients, slow=slow, free=free, forces=forces)
        stuck = many.locked()
        if stuck.any():
            values[own[stuck], 0] = np.inf
            own = own[~stuck]
            many = Many(mechanism, swing, designs[own], slopes=gradients, slow=slow, free=free, forces=forces)
        if len(own):
            values[own], places[own], found = of(many)
            if gradients:
                slopes[own] = many.numbers.chain(found)

    in_chunks(len(rows), work, size=_CHUNK)
    return SwingPeaks(values, places, slopes if gradients else None)


def _peaks(many: Many, state: int, kept: int, gradients: bool) -> tuple[Array, Array, Array]:
    # A force on the slider has the guide's friction by its size: without slopes its kink needs no cut.
    contacts = gradients or many.swing.driver == "crank"
    cut = partial(many.pieces, forces=state != ERROR, contacts=contacts)
    ways = many.ways() if state != ERROR else (False,)
    parts = [_of_way(many, cut(back=back), state, kept, gradients) for back in ways]
    values, places, slopes = (np.concatenate(each, axis=1) for each in zip(*parts, strict=True))
    order = np.argsort(-values, axis=1, kind="stable")[:, :kept]
    first, where = np.take_along_axis(values, order, axis=1), np.take_along_axis(places, order, axis=1)
    return first, where, np.take_along_axis(slopes, order[:, :, None], axis=1)


def _of_way(
    many: Many, own: Pieces, state: int, kept: int, gradients: bool, toward: Array | None = None
) -> tuple[Array, Array, Array]:
    """Return the peaks of one way. toward: the sign (n,) that a state is judged by; None for its size."""
    n, back = many.count, float(own.back)
    tops = _tops(many, own, state, kept, gradients, toward)
    inside = own.inside[tops.design, tops.piece]
    share, cut = _refined(many, tops, inside, back, state, toward)
    found = many.states(tops.design, share, inside, back)[:, state].real
    sides = np.where(found < 0.0, -1.0, 1.0) if toward is None else toward[tops.design]
    values, places = np.full((n, kept), -np.inf), np.full((n, kept), np.nan)
    slopes = np.zeros((n, kept, many.columns if gradients else 0))
    order = np.lexsort((-sides * found, tops.design))
    design, rank = tops.design[order], _ranks(tops.design[order])
    fits = rank < kept
    order, design, rank = order[fits], design[fits], rank[fits]
    values[design, rank], places[design, rank] = (sides * found)[order], share[order] + back
    if gradients:
        sign = sides[order]
        slips = _slips(many, own, tops.design[order], cut[order], inside[order])
        for v in range(many.columns):
            stepped = many.states(tops.design[order], share[order], inside[order], back, STEP * slips[:, v], v)
            slopes[design, rank, v] = sign * stepped[:, state].imag / STEP
    return values, places, slopes


def _slips(many: Many, own: Pieces, design: Whole, cut: Whole, inside: Array) -> Array:
    slips = np.zeros((len(design), many.columns))
    on = np.flatnonzero(cut >= 0)
    if len(on):
        slips[on] = many.moved(own, design[on], cut[on], inside[on])
    return slips


def _tops(many: Many, own: Pieces, state: int, kept: int, gradients: bool, toward: Array | None) -> _Tops:
    """Return the highest samples that no neighbour exceeds, a few of each design."""
    live, pieces = own.live, own.cuts.shape[1] - 1
    count = _ALL if pieces == 1 else max(_LEAST, _ALL // pieces)
    u = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, count))
    share = own.cuts[:, :-1, None] * (1.0 - u) + own.cuts[:, 1:, None] * u
    design, piece = np.nonzero(live)
    inside = np.broadcast_to(own.inside[design, piece][:, None], (len(design), count))
    values = np.full(share.shape, -np.inf)
    rows = np.broadcast_to(design[:, None], inside.shape)
    found = many.states(rows, share[design, piece], inside, float(own.back))[..., state].real
    values[design, piece] = np.abs(found) if toward is None else toward[design][:, None] * found
    values = np.where(np.isnan(values), -np.inf, values)
    padded = np.pad(values, ((0, 0), (0, 0), (1, 1)), constant_values=-np.inf)
    top = (values >= padded[:, :, :-2]) & (values > padded[:, :, 2:])
    highest = values.max(axis=(1, 2), keepdims=True)
    near = 2.0 * _NEAR if gradients else _NEAR
    if toward is None:
        top &= values >= (1.0 - near) * highest
    else:
        size = np.abs(np.where(np.isfinite(values), values, 0.0)).max(axis=(1, 2), keepdims=True)
        top &= values >= highest - near * size
    flat = np.where(top, values, -np.inf).reshape(many.count, -1)
    best = np.argsort(-flat, axis=1, kind="stable")[:, : 2 * kept]
    at, rank = np.nonzero(np.isfinite(np.take_along_axis(flat, best, axis=1)))
    place = best[at, rank]
    piece, i = place // count, place % count
    return _Tops(
        at,
        piece,
        np.where(i == 0, piece, np.where(i == count - 1, piece + 1, -1)),
        share[at, piece, i],
        share[at, piece, np.maximum(i - 1, 0)],
        share[at, piece, np.minimum(i + 1, count - 1)],
    )


def _refined(
    many: Many, tops: _Tops, inside: Array, back: float, state: int, toward: Array | None
) -> tuple[Array, Whole]:
    """Return the shares of tops, roots of the slope by bracketed secants, and the cut of each, -1 for none."""
    share, cut = tops.share.copy(), tops.cut.copy()

    def slope(rows: Whole) -> Array:
        found = many.states(tops.design[rows], share[rows], inside[rows], back, STEP)[:, state]
        side = np.where(found.real < 0.0, -1.0, 1.0) if toward is None else toward[tops.design[rows]]
        return np.asarray(side * found.imag / STEP)

    low, high = tops.low.copy(), tops.high.copy()
    rows = np.arange(len(share))
    now = slope(rows)
    # At an end of a piece the slope tells whether the top is there or further inside.
    first, last = cut == tops.piece, cut == tops.piece + 1
    stays = (first & (now <= 0.0)) | (last & (now >= 0.0))
    cut[~stays] = -1
    rows = rows[~stays & (now != 0.0)]
    now = now[rows]
    before, old = share[rows].copy(), now.copy()
    for i in range(_ITERATIONS):
        if not len(rows):
            break
        low[rows], high[rows] = (
            np.where(now > 0.0, share[rows], low[rows]),
            np.where(now > 0.0, high[rows], share[rows]),
        )
        middle = 0.5 * (low[rows] + high[rows])
        with np.errstate(divide="ignore", invalid="ignore"):
            secant = share[rows] - now * (share[rows] - before) / (now - old)
        good = (secant > low[rows]) & (secant < high[rows]) & (i > 0) & (i % 4 != 3)
        trial = np.where(good, secant, middle)
        done = (np.abs(trial - share[rows]) < 2e-16) | (high[rows] - low[rows] < 4e-16)
        before, old = share[rows].copy(), now
        share[rows] = np.where(done, share[rows], trial)
        rows, before, old = rows[~done], before[~done], old[~done]
        now = slope(rows)
        flat = now == 0.0
        rows, before, old, now = rows[~flat], before[~flat], old[~flat], now[~flat]
    return share, cut


def _at_ends(many: Many, gradients: bool) -> tuple[Array, Array, Array]:
    values, places, slopes = [], [], []
    for back in many.ways():
        for share in (0.0, 1.0):
            rows = np.arange(many.count)
            near = np.full(many.count, 1e-9 if share == 0.0 else 1.0 - 1e-9)
            found = many.states(rows, share, near, float(back))[:, DRIVE].real
            sign = np.where(found < 0.0, -1.0, 1.0)
            own = np.zeros((many.count, many.columns if gradients else 0))
            for v in range(own.shape[1]):
                own[:, v] = sign * many.states(rows, share, near, float(back), 0.0, v)[:, DRIVE].imag / STEP
            values.append(np.abs(found))
            places.append(np.full(many.count, share + float(back)))
            slopes.append(own)
    order = np.argsort(-np.stack(values, axis=1), axis=1, kind="stable")
    first = np.take_along_axis(np.stack(values, axis=1), order, axis=1)
    where = np.take_along_axis(np.stack(places, axis=1), order, axis=1)
    return first, where, np.take_along_axis(np.stack(slopes, axis=1), order[:, :, None], axis=1)


def _ranks(design: Whole) -> Whole:
    """Return the rank of each of sorted rows within its design."""
    start = np.searchsorted(design, design, side="left")
    return np.asarray(np.arange(len(design)) - start, dtype=np.int64)
