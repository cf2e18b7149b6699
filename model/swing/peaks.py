"""Peaks of a curve over a swing for many designs, to machine precision, with exact derivatives.

`peak_search` treats the pieces of both strokes as segments. The complex step gives slopes over time and derivatives
with respect to the design's numbers.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arrays import Array, IntArray
from ..kernel.arithmetic import STEP
from ..kernel.batches import run_in_chunks
from ..machine.mechanism import Mechanism
from ..signals.peak_search import Maxima, Segments, find_maxima
from .closure import swings_without_dead_point
from .swing import Swing
from .swing_batch import Pieces, SwingBatch
from .swing_states import DRIVE, ERROR

STORED_PEAKS = 6
"""Peaks stored per design, highest first."""
_PANELS = 2.0  # initial panels per stroke
_CHUNK = 128


@dataclass(frozen=True)
class SwingPeaks:
    """Local peaks for n designs, highest first.

    values: (n, k), SI, -inf beyond the last peak; NaN for a design that cannot make the swing, +inf where friction
    locks it. places: (n, k), fraction of the stroke's time, plus 1 on the return stroke. gradients: (n, k, v), by the
    design's numbers; None unless requested.
    """

    values: Array
    places: Array
    gradients: Array | None


@dataclass(frozen=True)
class _Curve:
    """A state over one or both strokes: places are fractions of the time, plus 1 on the return stroke.

    toward: the sign (n,) by which it is judged; None for its magnitude.
    """

    many: SwingBatch
    ways: tuple[Pieces, ...]
    state: int
    numbers: int
    toward: Array | None = None

    def segments(self) -> Segments:
        """Return the pieces of the strokes, each return stroke after its forward stroke."""
        parts = []
        for way, pieces in enumerate(self.ways):
            design, piece = np.nonzero(pieces.have_length)
            low, high = pieces.cuts[design, piece], pieces.cuts[design, piece + 1]
            number = (design * pieces.cuts.shape[1] + piece) * len(self.ways) + way
            parts.append((design, low + pieces.back, high + pieces.back, number))
        row, low, high, cut = (np.concatenate(part) for part in zip(*parts, strict=True))
        order = np.lexsort((low, row))
        row, low, high, cut = row[order], low[order], high[order], cut[order]
        after = np.arange(1, len(row) + 1)
        first, last = np.searchsorted(row, row, side="left"), np.append(row[1:] != row[:-1], True)
        after[last] = first[last] if len(self.ways) > 1 else -1
        return Segments(row, low, high, cut, after)

    def evaluate(
        self, row: IntArray, probe: Array, place: Array, *, rate: Array | None = None, gradients: bool = False
    ) -> tuple[Array, Array]:
        """Return value, slope and derivatives; see `peak_search.Curve`."""
        back = np.floor(probe)[:, None]
        points = row[:, None], place - back, probe[:, None] - back, back
        state = self.many.states(*points, STEP)[..., self.state]
        curve = np.stack([state.real, state.imag / STEP], axis=-1)
        if gradients:
            slips = np.zeros((len(row), self.numbers)) if rate is None else rate
            stepped = [self.many.states(*points, STEP * slips[:, v : v + 1], v) for v in range(self.numbers)]
            curve = np.concatenate([curve, *(step[..., self.state, None].imag / STEP for step in stepped)], axis=-1)
        if self.toward is not None:
            curve = self.toward[row][:, None, None] * curve
        return curve, np.nan_to_num(np.abs(state.real))

    def breakpoint_gradients(self, cuts: IntArray, probe: Array) -> Array:
        """Return the derivatives of cuts; see `peak_search.Curve`."""
        cut_rates = np.zeros((len(cuts), self.numbers))
        for way, pieces in enumerate(self.ways):
            rows = np.flatnonzero(cuts % len(self.ways) == way)
            design, cut = np.divmod(cuts[rows] // len(self.ways), pieces.cuts.shape[1])
            cut_rates[rows] = self.many.cut_slopes(pieces, design, cut, probe[rows] - pieces.back)
        return cut_rates


def swing_peaks(
    mechanism: Mechanism,
    swing: Swing,
    state: int,
    designs: Array,
    *,
    gradients: bool = False,
    limit: int = STORED_PEAKS,
) -> SwingPeaks:
    """Return the maxima of a state (`swing_states.DRIVE`, `POWER` or `ERROR`), in magnitude, for designs (n, 3 + k).

    limit: peaks returned per design.
    """
    find = partial(_peaks_of_state, state=state, limit=limit, gradients=gradients)
    batch_of = partial(SwingBatch, mechanism, swing, slopes=gradients, forces=state != ERROR)
    return _peaks_of_swinging_designs(mechanism, swing, designs, limit, gradients, find, batch_of)


def peaks_of_negated_least_drive(
    mechanism: Mechanism,
    swing: Swing,
    designs: Array,
    *,
    back: bool,
    gradients: bool = False,
    limit: int = STORED_PEAKS,
) -> SwingPeaks:
    """Return the minima of the drive effort in one stroke, negated: local peaks, highest first.

    The effort is that along the motion, without inertia.

    If the minimum drive effort is negative, loads push the linkage along, and the drive holds it back.
    """

    def find(many: SwingBatch) -> Maxima:
        first, last = (many.driver_position_at(end) for end in (many.ends.start, many.ends.end))
        toward = np.where(last > first, -1.0, 1.0) * (-1.0 if back else 1.0)
        return _maxima_of_state(many, (many.pieces_of_stroke(back=back),), DRIVE, limit, gradients, toward)

    batch_of = partial(SwingBatch, mechanism, swing, slopes=gradients, slow=True)
    return _peaks_of_swinging_designs(mechanism, swing, designs, limit, gradients, find, batch_of)


def holding_drive_peaks(
    mechanism: Mechanism, swing: Swing, designs: Array, *, free: bool = False, gradients: bool = False
) -> SwingPeaks:
    """Return the magnitudes of the drive effort at the ends, for designs (n, 3 + k), without inertia.

    free: without friction.
    """
    unit_design = np.ones((1, 3 + len(mechanism.varying)))
    ways = 2 if SwingBatch(mechanism, swing, unit_design, slopes=False, slow=True, free=free).ways_differ else 1
    find = partial(_holding_drive_at_ends, gradients=gradients)
    batch_of = partial(SwingBatch, mechanism, swing, slopes=gradients, slow=True, free=free)
    return _peaks_of_swinging_designs(mechanism, swing, designs, 2 * ways, gradients, find, batch_of)


def _peaks_of_swinging_designs(
    mechanism: Mechanism,
    swing: Swing,
    designs: Array,
    limit: int,
    gradients: bool,
    find: Callable[[SwingBatch], Maxima],
    batch_of: Callable[[Array], SwingBatch],
) -> SwingPeaks:
    """Return the peaks that `find` gives for designs that can swing."""
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    n = len(designs)
    values, places = np.full((n, limit), -np.inf), np.full((n, limit), np.nan)
    slopes = np.zeros((n if gradients else 0, limit, designs.shape[1]))
    values[:, 0] = np.nan
    rows = np.flatnonzero(swings_without_dead_point(mechanism, swing, designs))

    def work(begin: int, end: int) -> None:
        designs_here = rows[begin:end]
        batch = batch_of(designs[designs_here])
        stuck = batch.may_lock()
        if stuck.any():
            values[designs_here[stuck], 0] = np.inf
            designs_here = designs_here[~stuck]
            batch = batch_of(designs[designs_here])
        if len(designs_here):
            maxima = find(batch)
            values[designs_here], places[designs_here] = maxima.values, maxima.places
            if gradients:
                slopes[designs_here] = batch.numbers.gradients_by_design_numbers(maxima.slopes)

    run_in_chunks(len(rows), work, size=_CHUNK)
    return SwingPeaks(values, places, slopes if gradients else None)


def _peaks_of_state(batch: SwingBatch, state: int, limit: int, gradients: bool) -> Maxima:
    # The magnitude of the guide's friction contributes to a force on the slider: without slopes, its kink needs no cut.
    contacts = gradients or batch.swing.driver == "crank"
    forces = state != ERROR
    ways = batch.distinct_strokes() if forces else (False,)
    cut = tuple(batch.pieces_of_stroke(back=back, forces=forces, contacts=contacts) for back in ways)
    return _maxima_of_state(batch, cut, state, limit, gradients)


def _maxima_of_state(
    batch: SwingBatch, ways: tuple[Pieces, ...], state: int, limit: int, gradients: bool, toward: Array | None = None
) -> Maxima:
    curve = _Curve(batch, ways, state, batch.columns if gradients else 0, toward)
    return find_maxima(curve, curve.segments(), np.full(batch.count, _PANELS), limit=limit, signed=toward is not None)


def _holding_drive_at_ends(batch: SwingBatch, gradients: bool) -> Maxima:
    values, places, slopes = [], [], []
    for back in batch.distinct_strokes():
        for share in (0.0, 1.0):
            rows = np.arange(batch.count)
            near = np.full(batch.count, 1e-9 if share == 0.0 else 1.0 - 1e-9)
            drive = batch.states(rows, share, near, float(back))[:, DRIVE].real
            sign = np.where(drive < 0.0, -1.0, 1.0)
            by_number = np.zeros((batch.count, batch.columns if gradients else 0))
            for v in range(by_number.shape[1]):
                by_number[:, v] = sign * batch.states(rows, share, near, float(back), 0.0, v)[:, DRIVE].imag / STEP
            values.append(np.abs(drive))
            places.append(np.full(batch.count, share + float(back)))
            slopes.append(by_number)
    order = np.argsort(-np.stack(values, axis=1), axis=1, kind="stable")
    sorted_values = np.take_along_axis(np.stack(values, axis=1), order, axis=1)
    sorted_places = np.take_along_axis(np.stack(places, axis=1), order, axis=1)
    sorted_slopes = np.take_along_axis(np.stack(slopes, axis=1), order[:, :, None], axis=1)
    return Maxima(sorted_values, sorted_places, sorted_slopes, sorted_values[:, 0])
