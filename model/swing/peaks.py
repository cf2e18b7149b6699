"""Peaks of a curve over a swing for many designs, to machine precision, with exact derivatives.

The pieces of both ways are the segments that `peak_search` looks through; slopes over the time and derivatives by the
design's numbers are by the complex step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arrays import Array, Whole
from ..kernel.arithmetic import STEP
from ..kernel.batches import in_chunks
from ..machine.mechanism import Mechanism
from ..signals.cycle_segments import Segments
from ..signals.peak_search import Maxima, find_maxima
from .closure import passes
from .swing import Swing
from .swing_batch import Pieces, SwingBatch
from .swing_states import DRIVE, ERROR

KEPT = 6
"""Peaks kept of a design, highest first."""
_PANELS = 2.0  # of a way, to begin with
_CHUNK = 128


@dataclass(frozen=True)
class SwingPeaks:
    """Local peaks of n designs, highest first.

    values: (n, k), SI, -inf beyond the last peak; NaN for a design that cannot swing as asked, +inf where friction
    locks it. places: (n, k), share of the time of the way, 1 more on the return stroke. gradients: (n, k, v), by the
    design's numbers; None unless asked for.
    """

    values: Array
    places: Array
    gradients: Array | None


@dataclass(frozen=True)
class _Curve:
    """A state over both ways, or over one: places are shares of the time, 1 more on the return stroke.

    toward: the sign (n,) that it is judged by; None for its size.
    """

    many: SwingBatch
    ways: tuple[Pieces, ...]
    state: int
    numbers: int
    toward: Array | None = None

    def segments(self) -> Segments:
        """Return the pieces of the ways, each way back after one forth."""
        parts = []
        for way, own in enumerate(self.ways):
            design, piece = np.nonzero(own.live)
            low, high = own.cuts[design, piece], own.cuts[design, piece + 1]
            parts.append((design, low + own.back, high + own.back, self._numbered(way, design, piece)))
        row, low, high, cut = (np.concatenate(part) for part in zip(*parts, strict=True))
        order = np.lexsort((low, row))
        row, low, high, cut = row[order], low[order], high[order], cut[order]
        after = np.arange(1, len(row) + 1)
        first, last = np.searchsorted(row, row, side="left"), np.append(row[1:] != row[:-1], True)
        after[last] = first[last] if len(self.ways) > 1 else -1
        return Segments(row, low, high, cut, after)

    def at(
        self, row: Whole, inside: Array, place: Array, *, rate: Array | None = None, wanted: bool = False
    ) -> tuple[Array, Array]:
        """Return value, slope and derivatives; see `peak_search.Curve`."""
        back = np.floor(inside)[:, None]
        points = row[:, None], place - back, inside[:, None] - back, back
        found = self.many.states(*points, STEP)[..., self.state]
        curve = np.stack([found.real, found.imag / STEP], axis=-1)
        if wanted:
            slips = np.zeros((len(row), self.numbers)) if rate is None else rate
            own = [self.many.states(*points, STEP * slips[:, v : v + 1], v) for v in range(self.numbers)]
            curve = np.concatenate([curve, *(each[..., self.state, None].imag / STEP for each in own)], axis=-1)
        if self.toward is not None:
            curve = self.toward[row][:, None, None] * curve
        return curve, np.nan_to_num(np.abs(found.real))

    def rates(self, cuts: Whole, inside: Array) -> Array:
        """Return the derivatives of cuts; see `peak_search.Curve`."""
        found = np.zeros((len(cuts), self.numbers))
        for way, own in enumerate(self.ways):
            rows = np.flatnonzero(cuts % len(self.ways) == way)
            design, cut = np.divmod(cuts[rows] // len(self.ways), own.cuts.shape[1])
            found[rows] = self.many.moved(own, design, cut, inside[rows] - own.back)
        return found

    def _numbered(self, way: int, design: Whole, cut: Whole) -> Whole:
        return np.asarray((design * self.ways[way].cuts.shape[1] + cut) * len(self.ways) + way)


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

    def found(many: SwingBatch) -> Maxima:
        first, last = (many.driver_at(end) for end in (many.ends.start, many.ends.end))
        toward = np.where(last > first, -1.0, 1.0) * (-1.0 if back else 1.0)
        return _maxima(many, (many.pieces(back=back),), DRIVE, kept, gradients, toward)

    return _gathered(mechanism, swing, designs, kept, gradients, found, slow=True)


def holding_peaks(
    mechanism: Mechanism, swing: Swing, designs: Array, *, free: bool = False, gradients: bool = False
) -> SwingPeaks:
    """Return the sizes of the drive at the ends of designs (n, 3 + k), without inertia. free: without friction."""
    one = np.ones((1, 3 + len(mechanism.varying)))
    ways = 2 if SwingBatch(mechanism, swing, one, slopes=False, slow=True, free=free).both else 1
    found = partial(_at_ends, gradients=gradients)
    return _gathered(mechanism, swing, designs, 2 * ways, gradients, found, slow=True, free=free)


def _gathered(
    mechanism: Mechanism,
    swing: Swing,
    designs: Array,
    kept: int,
    gradients: bool,
    of: Callable[[SwingBatch], Maxima],
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
        many = SwingBatch(mechanism, swing, designs[own], slopes=gradients, slow=slow, free=free, forces=forces)
        stuck = many.locked()
        if stuck.any():
            values[own[stuck], 0] = np.inf
            own = own[~stuck]
            many = SwingBatch(mechanism, swing, designs[own], slopes=gradients, slow=slow, free=free, forces=forces)
        if len(own):
            found = of(many)
            values[own], places[own] = found.values, found.places
            if gradients:
                slopes[own] = many.numbers.chain(found.slopes)

    in_chunks(len(rows), work, size=_CHUNK)
    return SwingPeaks(values, places, slopes if gradients else None)


def _peaks(many: SwingBatch, state: int, kept: int, gradients: bool) -> Maxima:
    # A force on the slider has the guide's friction by its size: without slopes its kink needs no cut.
    contacts = gradients or many.swing.driver == "crank"
    forces = state != ERROR
    ways = many.ways() if forces else (False,)
    cut = tuple(many.pieces(back=back, forces=forces, contacts=contacts) for back in ways)
    return _maxima(many, cut, state, kept, gradients)


def _maxima(
    many: SwingBatch, ways: tuple[Pieces, ...], state: int, kept: int, gradients: bool, toward: Array | None = None
) -> Maxima:
    curve = _Curve(many, ways, state, many.columns if gradients else 0, toward)
    return find_maxima(curve, curve.segments(), np.full(many.count, _PANELS), kept=kept, signed=toward is not None)


def _at_ends(many: SwingBatch, gradients: bool) -> Maxima:
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
    found_slopes = np.take_along_axis(np.stack(slopes, axis=1), order[:, :, None], axis=1)
    return Maxima(first, where, found_slopes, first[:, 0])
