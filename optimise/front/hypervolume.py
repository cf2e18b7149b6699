"""Hypervolume, and the selection of a few designs that preserve most of it."""

from collections.abc import Callable

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.kernel.kernel import Row, Table, kernel
from .saved_front import column_ranges

REFERENCE = 1.1
"""Reference point in scaled space, where the ideal is 0 and the nadir 1."""
_BOUNDED = 4096  # number of designs above which bounding all gains takes longer than recomputing some
_ROUNDING = 1e-12  # scaled volume, far above its rounding error

ReportProgress = Callable[[int, int], None]
"""Called many times a second by long work with the amount done and the total amount."""


def ignore_progress(done: int, total: int) -> None:
    """Ignore progress reports."""


def ideal_and_range(values: Array) -> tuple[Array, Array]:
    """Return ideal and range of objective values (n, m); the range of a constant objective is its magnitude."""
    ideal, span = np.ascontiguousarray(values.T).min(axis=1), column_ranges(values)
    return ideal, np.where(span > 0.0, span, np.maximum(np.abs(ideal), 1e-12))


def hypervolume(values: Array, ideal: Array, span: Array, *, clip_at_ideal: bool = True) -> float:
    """Return the dominated fraction of the box from the ideal to 1.1 ranges beyond it.

    clip_at_ideal: whether to ignore volume beyond the ideal; otherwise the fraction may exceed 1.
    """
    if not len(values):
        return 0.0
    scaled = np.clip((values - ideal) / span, 0.0 if clip_at_ideal else None, None)
    scaled = scaled[(scaled < REFERENCE).all(axis=1)]
    if not len(scaled):
        return 0.0
    if scaled.shape[1] == 1:
        return float((REFERENCE - scaled.min()) / REFERENCE)
    import moocore

    volume = moocore.hypervolume(np.ascontiguousarray(scaled), ref=REFERENCE)
    return float(volume / REFERENCE ** scaled.shape[1])


@kernel
def _shared_corners(chosen: Table, count: int, point: Row, corners: Table) -> int:
    """Store the undominated corners of the region that a point shares with the selected ones; return their number."""
    corner_count = 0
    for i in range(count):
        covered = False
        for k in range(corner_count):
            covered = True
            for j in range(point.shape[0]):
                if corners[k, j] > max(chosen[i, j], point[j]):
                    covered = False
                    break
            if covered:
                break
        if covered:
            continue
        left = 0
        for k in range(corner_count):
            stays = False
            for j in range(point.shape[0]):
                stays = stays or corners[k, j] < max(chosen[i, j], point[j])
            if stays:
                for j in range(point.shape[0]):
                    corners[left, j] = corners[k, j]
                left += 1
        for j in range(point.shape[0]):
            corners[left, j] = max(chosen[i, j], point[j])
        corner_count = left + 1
    return corner_count


class GainBounds:
    """Upper bounds on the hypervolume that scaled designs (n, m) add to the selected ones.

    The gain is the design's box minus the part that it shares with the selected designs. Inclusion and exclusion over
    three shared boxes bounds this part from below: the two largest so far, and the one shared with the last selected
    design.
    """

    def __init__(self, scaled: Array) -> None:
        """Start without selected designs."""
        self.margins = np.ascontiguousarray(REFERENCE - scaled.T)
        self.boxes = self.margins.prod(axis=0)
        self.largest, self.second = np.zeros(self.margins.shape), np.zeros(self.margins.shape)
        n = len(scaled)
        self.most, self.more, self.both = np.zeros(n), np.zeros(n), np.zeros(n)

    def add_selected_design(self, index: int) -> Array:
        """Return the bounds (n,) after another design is selected."""
        shared = np.minimum(self.margins, self.margins[:, index : index + 1])
        size = shared.prod(axis=0)
        with_largest = np.minimum(self.largest, shared)
        common = with_largest.prod(axis=0)
        all_three = np.minimum(self.second, with_largest).prod(axis=0)
        union = self.most + self.more + size - self.both - common
        union += all_three - np.minimum(self.second, shared).prod(axis=0)
        rows = np.flatnonzero(size > self.more)
        is_largest = size[rows] > self.most[rows]
        first, next_ = rows[is_largest], rows[~is_largest]
        self.second[:, first], self.more[first] = self.largest[:, first], self.most[first]
        self.largest[:, first], self.most[first] = shared[:, first], size[first]
        self.second[:, next_], self.more[next_] = shared[:, next_], size[next_]
        self.both[rows] = common[rows]
        return np.asarray(self.boxes - union + _ROUNDING)


def choose_designs_by_hypervolume(
    values: Array, count: int, *, always: tuple[int, ...] = (), report: ReportProgress = ignore_progress
) -> IntArray:
    """Return `count` ascending indices of non-dominated designs, `always` included, selected by hypervolume.

    The hypervolume is submodular: a design's gain only shrinks as others are selected. So a gain need not be recomputed
    if its old value is already below the best new one (lazy greedy; Minoux, 1978), or if its upper bound is. The gain
    is the design's box minus the part shared with the selected designs, which has few corners (L. While et al., "A fast
    way of calculating exact hypervolumes", IEEE Trans. Evol. Comput. 16(1), 2012). report: called for every design and
    gain, with the number of designs chosen.
    """
    n = len(values)
    if n <= count:
        return np.arange(n)
    if values.shape[1] == 1:
        return np.array(sorted(set(always) | set(np.argsort(values[:, 0], kind="stable")[:count].tolist()))[:count])
    import moocore

    ideal, span = ideal_and_range(values)
    scaled = np.ascontiguousarray((values - ideal) / span)
    bounds = GainBounds(scaled)
    gains, fresh = bounds.boxes.copy(), np.full(n, -1)
    chosen, corners = np.empty((count, scaled.shape[1])), np.empty((count, scaled.shape[1]))
    picked: list[int] = []

    def pick(index: int) -> None:
        chosen[len(picked)] = scaled[index]
        picked.append(index)
        if n <= _BOUNDED:
            np.minimum(gains, bounds.add_selected_design(index), out=gains)
        gains[index] = -np.inf

    for index in list(dict.fromkeys(always))[:count]:
        report(len(picked), count)
        pick(index)
    volume = moocore.Hypervolume(ref=np.full(scaled.shape[1], REFERENCE))
    while len(picked) < count:
        report(len(picked), count)
        index = int(np.argmax(gains))
        if fresh[index] == len(picked):
            pick(index)
        else:
            shared = corners[: _shared_corners(chosen, len(picked), scaled[index], corners)]
            gains[index] = bounds.boxes[index] - (float(volume(shared)) if len(shared) else 0.0)
            fresh[index] = len(picked)
    return np.array(sorted(picked))
