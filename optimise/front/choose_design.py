"""Selection of one design from a front: nearest to the ideal, by weights (TOPSIS), or by ranked objectives.

All functions take objective values (n, m) as minimised, in any units: only proportions matter.
size: (m,), scale for rounding an objective's values besides their own magnitude: the target if it is a distance from
one.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ...model.arrays import Array, IntArray
from ...model.checks import is_number
from ...model.errors import InputError
from ...model.kernel.batches import run_in_chunks
from ...model.kernel.kernel import Integers, Table, kernel
from ...model.machine.loads.load import require_word
from .saved_front import column_ranges


def nearest_neighbours(points: Array, count: int) -> tuple[Array, IntArray]:
    """Return distances and rows (n, count) of the nearest of points (n, m), nearest first, starting with itself.

    count: number of neighbours, at most n.
    """
    order = np.argsort(points[:, 0], kind="stable")
    distance = np.full((len(points), count), np.inf)
    nearest = np.zeros(len(points) * count, dtype=np.int64)
    ordered = points[order]
    run_in_chunks(len(points), lambda begin, end: _search_neighbours(ordered, begin, end, distance, nearest))
    rows = np.empty_like(order)
    rows[order] = np.arange(len(order))
    return distance[rows], order[nearest.reshape(-1, count)[rows]]


@kernel
def _search_neighbours(points: Table, begin: int, end: int, distance: Table, nearest: Integers) -> None:
    """Search points by their first coordinate, until that distance alone exceeds those of the neighbours found."""
    n, m = points.shape
    count = distance.shape[1]
    for i in range(begin, end):
        distance[i, 0], nearest[i * count] = 0.0, i
        worst, before, after = distance[i, count - 1], i - 1, i + 1
        while before >= 0 or after < n:  # alternate sides, so that near points on either side end both directions early
            for k in (before, after):
                if not 0 <= k < n:
                    continue
                if (points[k, 0] - points[i, 0]) ** 2 >= worst:
                    if k < i:
                        before = -1
                    else:
                        after = n
                    continue
                square = 0.0
                for column in range(m):
                    square += (points[k, column] - points[i, column]) ** 2
                if square < worst:
                    place = count - 1
                    while place > 1 and distance[i, place - 1] > square:
                        distance[i, place] = distance[i, place - 1]
                        nearest[i * count + place] = nearest[i * count + place - 1]
                        place -= 1
                    distance[i, place], nearest[i * count + place] = square, k
                    worst = distance[i, count - 1]
            before, after = before - 1, after + 1
        for place in range(count):
            distance[i, place] = np.sqrt(distance[i, place])


Normalisation = Literal["range", "vector"]
_TIE = 1e-9  # relative to a range or a closeness: smaller differences are rounding


@dataclass(frozen=True, kw_only=True)
class Priority:
    """An objective in a ranking, and its allowed loss from the best value in favour of the next one.

    absolute: loss in the quantity's SI unit. share: fraction of the objective's range over the designs. The two add up.
    """

    quantity: str
    absolute: float = 0.0
    share: float = 0.0

    def __post_init__(self) -> None:
        for value in (self.absolute, self.share):
            if not (is_number(value) and math.isfinite(value) and value >= 0.0):
                raise InputError(
                    f"the tolerance of {self.quantity} must be a number, zero or more; got {value!r}; leave it out"
                )


def scale_by_range(values: Array, *, size: ArrayLike = 0.0) -> Array:
    """Return objectives scaled by their range over the designs: 0 is best, 1 worst; 0 where all are the same."""
    _require_designs(values)
    span = column_ranges(values, size=size)
    scaled = np.where(span > 0.0, values - values.min(axis=0), 0.0) / np.where(span > 0.0, span, 1.0)
    return np.where(np.isfinite(values), scaled, values)


def knee_row(values: Array, *, size: ArrayLike = 0.0) -> int:
    """Return the row nearest to the ideal point, with every objective scaled by its range over the designs."""
    distances = np.linalg.norm(scale_by_range(values, size=size), axis=1)
    return int(np.flatnonzero(distances <= distances.min() + _TIE)[0])


def topsis_closeness(
    values: Array, weights: Sequence[float], *, normalisation: Normalisation = "range", size: ArrayLike = 0.0
) -> Array:
    """Return the relative closeness (n,) of designs to the ideal, 0 to 1, greatest best (TOPSIS).

    C = d_worst / (d_best + d_worst), where d are Euclidean distances of the weighted, normalised objectives from the
    best and the worst value of each. C. L. Hwang and K. Yoon, "Multiple Attribute Decision Making", Springer 1981, the
    section on TOPSIS. They divide each objective by its Euclidean norm over the designs ("vector"). An objective that
    varies little around a large value then hardly counts, whatever its weight, and adding a constant changes the
    choice. By default objectives are divided by their range over the designs, so that weights rate whole ranges.

    weights: (m,), zero or more, with any sum. If all designs are equal in the weighted objectives, all closenesses
    are 1.
    """
    require_word("normalisation", normalisation, Normalisation)
    _require_designs(values)
    share = np.asarray(weights, dtype=np.float64)
    if share.shape != values.shape[1:] or not np.isfinite(share).all() or (share < 0.0).any() or not share.any():
        raise InputError(
            f"each of the {values.shape[1]} objectives must have a weight, all zero or more and at least one above "
            f"zero; got {', '.join(f'{item:g}' for item in share.ravel())}"
        )
    if normalisation == "range":
        scaled = scale_by_range(values, size=size)
    else:
        norms = np.linalg.norm(values, axis=0)
        scaled = values / np.where(norms > 0.0, norms, 1.0)
    scaled = scaled * share / share.sum()
    best = np.linalg.norm(scaled - scaled.min(axis=0), axis=1)
    worst = np.linalg.norm(scaled - scaled.max(axis=0), axis=1)
    total = best + worst
    return np.where(total > 0.0, worst / np.where(total > 0.0, total, 1.0), 1.0)


def topsis(
    values: Array, weights: Sequence[float], *, normalisation: Normalisation = "range", size: ArrayLike = 0.0
) -> int:
    """Return the row with the greatest `topsis_closeness`; ties go to the better in the other objectives."""
    scores = topsis_closeness(values, weights, normalisation=normalisation, size=size)
    return _row_of_least_total(values, np.flatnonzero(scores >= scores.max() - _TIE), size)


def lexicographic(values: Array, order: Sequence[tuple[int, float, float]], *, size: ArrayLike = 0.0) -> int:
    """Return the row that remains when objectives decide in turn.

    order: objectives as (column, absolute, share). Each in turn keeps the remaining designs whose loss against their
    best is at most `absolute + share * range`, with the range over all designs. The last one keeps only its best,
    whatever its tolerance. Ties go to the better in the other objectives. (Fishburn, "Lexicographic orders, utilities
    and decision rules", Management Science 20(11), 1974; with tolerances: Waltz, "An engineering approach: hierarchical
    optimization criteria", IEEE Trans. Automatic Control 12(2), 1967.)
    """
    _require_designs(values)
    columns = [column for column, _, _ in order]
    if not columns or len(set(columns)) < len(columns):
        raise InputError("a ranking must name at least one objective, each once; put the most important first")
    span, scaled = column_ranges(values, size=size), scale_by_range(values, size=size)
    rows = np.arange(len(values))
    for place, (column, absolute, share) in enumerate(order):
        last = place == len(order) - 1
        if span[column] > 0.0:
            values_left = scaled[rows, column]
            rows = rows[values_left <= values_left.min() + _TIE + (0.0 if last else absolute / span[column] + share)]
    return _row_of_least_total(values, rows, size)


def _row_of_least_total(values: Array, rows: np.ndarray, size: ArrayLike) -> int:
    totals = scale_by_range(values, size=size)[rows].sum(axis=1)
    return int(rows[np.flatnonzero(totals <= totals.min() + _TIE)[0]])


def _require_designs(values: Array) -> None:
    if not len(values):
        raise InputError("the front is empty; see its message")
