"""Excess of points in objective space over designs, and small sets of designs that cover many points.

A design p covers a point z to within e if p_j <= z_j + e in every objective j (all minimised and scaled). The *excess*
of z over a set of designs is the least e to within which one of them covers it: additive epsilon dominance (E. Zitzler
et al., "Performance assessment of multiobjective optimizers", IEEE Trans. Evol. Comput. 7(2), 2003, sec. III).
"""

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.kernel.batches import run_in_chunks
from ...model.kernel.kernel import Flags, Integers, Row, Table, kernel
from ..front.dominance import nondominated
from ..front.hypervolume import hypervolume

_EXACT = 4000  # points in three or more dimensions whose hypervolume takes about a second


@kernel
def _excess_of_points(points: Table, designs: Table, first: Integers, enough: float, out: Row) -> None:
    for i in range(points.shape[0]):
        best = out[i]
        for q in range(first[i], designs.shape[0]):
            if best <= enough:
                break
            worst = -np.inf
            for j in range(points.shape[1]):
                worst = max(worst, designs[q, j] - points[i, j])
                if worst >= best:
                    break
            best = min(best, worst)
        out[i] = best


def excess_over_designs(
    points: Array,
    designs: Array,
    *,
    earlier_excess: Array | None = None,
    first: IntArray | None = None,
    enough: float = -np.inf,
) -> Array:
    """Return the excess (n,) of points (n, m) over designs (p, m), infinite if there are no designs.

    earlier_excess: excess over other designs; the smaller excess is used. first: (n,), index of the first design to
    compare. enough: a value that need not be improved.
    """
    n = len(points)
    out = np.full(n, np.inf) if earlier_excess is None else earlier_excess.copy()
    start = np.zeros(n, dtype=np.int64) if first is None else first
    points, designs = np.ascontiguousarray(points), np.ascontiguousarray(designs)

    def work(begin: int, end: int) -> None:
        _excess_of_points(points[begin:end], designs, start[begin:end], enough, out[begin:end])

    run_in_chunks(n, work, size=4096)
    return out


@kernel
def _choose_cover(points: Table, values: Table, epsilon: float, chosen: Flags) -> None:
    count = 0
    order = np.empty(points.shape[0], np.int64)
    for i in range(points.shape[0]):
        covered = False
        for c in range(count):
            q = order[count - 1 - c]  # neighbouring boxes are adjacent in the table
            covers = True
            for j in range(points.shape[1]):
                covers = covers and values[q, j] <= points[i, j] + epsilon
            if covers:
                covered = True
                break
        if not covered:
            covers = True
            for j in range(points.shape[1]):
                covers = covers and values[i, j] <= points[i, j] + epsilon
            if covers:
                order[count] = i
                count += 1
                chosen[i] = True


def choose_covering_designs(points: Array, values: Array, epsilon: float) -> IntArray:
    """Return rows of values (n, m): each covers its point (n, m) to within epsilon, and no earlier one does."""
    chosen = np.zeros(len(points), dtype=bool)
    _choose_cover(np.ascontiguousarray(points), np.ascontiguousarray(values), epsilon, chosen)
    return np.flatnonzero(chosen)


def greedy_cover(points: Array, values: Array, epsilon: float) -> IntArray:
    """Return few rows of values (p, m), chosen greedily, that together cover all points (n, m) to within epsilon."""
    covers = np.stack([(row <= points + epsilon).all(axis=1) for row in values]) if len(values) else np.zeros((0, 0))
    if not len(points) or not covers.any(axis=0).all():
        return np.arange(len(values)) if len(points) else np.zeros(0, dtype=np.int64)
    left = np.ones(len(points), dtype=bool)
    gains = covers.sum(axis=1)
    picked: list[int] = []
    while left.any():
        best = int(np.argmax(gains))
        picked.append(best)
        fresh = left & covers[best]
        gains -= covers[:, fresh].sum(axis=1)
        left &= ~fresh
    return np.array(sorted(picked), dtype=np.int64)


def scaled_hypervolume(values: Array) -> float:
    """Return the hypervolume of scaled values in the units of fronts, including volume beyond the ideal point."""
    ideal, span = np.zeros(values.shape[1]), np.ones(values.shape[1])
    return hypervolume(values[nondominated(values)], ideal, span, clip_at_ideal=False)


def hypervolume_gap_bound(front: Array, designs: Array, epsilon: float, points: Array) -> float:
    """Return an upper bound on the excess of the true front's hypervolume over that of `front`; all scaled.

    `designs` cover every feasible design to within epsilon; each also lies beyond one of `points` unless the front
    itself covers it to within epsilon. Both sets confine the true front; the smaller one is used.
    """
    if not np.isfinite(epsilon):
        return float("inf")
    largest = scaled_hypervolume(designs - epsilon)
    bounds = np.concatenate([front - epsilon, points])
    bounds = bounds[np.isfinite(bounds).all(axis=1)] if np.isfinite(points).all() else bounds[:0]
    if len(bounds):
        bounds = bounds[nondominated(bounds)]
        if len(bounds) <= _EXACT:
            largest = min(largest, scaled_hypervolume(bounds))
    return max(0.0, largest - scaled_hypervolume(front))
