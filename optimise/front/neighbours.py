"""Nearest neighbours of points in objective space."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.kernel.batches import in_chunks
from ...model.kernel.kernel import Integers, Table, kernel


def nearest_neighbours(points: Array, count: int) -> tuple[Array, IntArray]:
    """Return distances and rows (n, count) of the nearest of points (n, m), nearest first, starting with itself.

    count: number of neighbours, at most n.
    """
    order = np.argsort(points[:, 0], kind="stable")
    distance = np.full((len(points), count), np.inf)
    nearest = np.zeros(len(points) * count, dtype=np.int64)
    ordered = points[order]
    in_chunks(len(points), lambda begin, end: _search_neighbours(ordered, begin, end, distance, nearest))
    rows = np.empty_like(order)
    rows[order] = np.arange(len(order))
    return distance[rows], order[nearest.reshape(-1, count)[rows]]


@kernel
def _search_neighbours(points: Table, begin: int, end: int, distance: Table, nearest: Integers) -> None:
    """Search points by their first coordinate, until it alone exceeds the distance of the neighbours found."""
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
