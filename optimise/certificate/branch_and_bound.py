"""Branch and bound over the free unknowns: boxes that may still contain an uncovered design, largest excess first."""

from __future__ import annotations

import itertools
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from os import cpu_count

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ..search.candidates import Table
from .box_bounds import Bounded, Boxes

_FIRST = {0: 1, 1: 64, 2: 24, 3: 12, 4: 5, 5: 3}  # initial boxes along each axis; 2 if there are more axes
_CHUNK = 2048  # boxes bounded together: the working arrays stay in the cache
_FINEST = 2.0**-40
"""Width of a box, as a fraction of the unit box, below which it is not split further."""


@dataclass
class Tree(Table):
    """Open boxes of all branches.

    branch: (n,). lower, upper: (n, k), padded with zeros. corner: (n, m), scaled. excess: (n,).
    counted_designs: (n,), number of designs already compared for the excess. axis: (n,), the next axis to split; -1 if
    none is left. bounded: number of boxes bounded so far.
    """

    branch: IntArray
    lower: Array
    upper: Array
    corner: Array
    excess: Array
    counted_designs: IntArray
    axis: IntArray
    branches: list[Boxes] = field(kw_only=True)
    bounded: int = field(default=0, kw_only=True)

    @classmethod
    def of_branches(cls, branches: list[Boxes]) -> Tree:
        """Return a tree without boxes."""
        width = max([3, *(len(boxes.branch.free) for boxes in branches)])
        empty_rows, wide = np.zeros(0, np.int64), np.zeros((0, width))
        return cls(
            empty_rows,
            wide,
            wide,
            np.zeros((0, len(branches[0].objectives))),
            np.zeros(0),
            empty_rows,
            empty_rows,
            branches=branches,
        )

    def open_fraction(self) -> float:
        """Return the open fraction of the design box; all branches have equal weight."""
        total = 0.0
        for index, boxes in enumerate(self.branches):
            on_branch, k = self.branch == index, len(boxes.branch.free)
            total += float(np.prod((self.upper - self.lower)[on_branch][:, :k], axis=1).sum())
        return total / len(self.branches)

    def initial_boxes(self, index: int) -> tuple[Array, Array]:
        """Return the initial boxes (n, k) of a branch."""
        k = len(self.branches[index].branch.free)
        count = _FIRST.get(k, 2)
        places = np.array(list(itertools.product(range(count), repeat=k)), dtype=np.float64).reshape(count**k, k)
        return places / count, (places + 1.0) / count

    def bound_boxes(self, index: int, lower: Array, upper: Array, pool: ThreadPoolExecutor) -> Bounded:
        """Return the bounds for boxes of a branch, without boxes that cannot contain a feasible design."""
        self.bounded += len(lower)
        parts = [slice(begin, begin + _CHUNK) for begin in range(0, len(lower), _CHUNK)]
        first, *rest = pool.map(lambda part: self.branches[index].bound_boxes(lower[part], upper[part]), parts)
        bounded = first.join(*rest)
        return bounded[bounded.alive]

    def add_boxes(self, index: int, boxes: Bounded, corner: Array, excess: Array, counted: int) -> None:
        """Add boxes."""
        n, k = boxes.lower.shape
        wide = boxes.upper - boxes.lower
        # Without known effects, split the widest axis; a small weight on the width ensures that no axis stays wide
        # forever.
        smear = np.where(np.isfinite(boxes.smear), boxes.smear, 0.0) + 0.05 * wide
        smear = np.where(wide > _FINEST, smear, -1.0)
        axis = np.where(smear.max(axis=1) < 0.0, -1, smear.argmax(axis=1)) if k else np.full(n, -1)
        columns = (np.full(n, index), boxes.lower, boxes.upper, corner, excess, np.full(n, counted), axis)
        self.replace_content(self.join(Tree(*columns, branches=self.branches)))

    def keep_boxes(self, rows: IntArray | Mask) -> None:
        """Keep only these boxes."""
        self.replace_content(self[rows])

    def rows_of_largest_excess(self, count: int) -> IntArray:
        """Return the splittable boxes with the largest excess."""
        rows = np.flatnonzero(self.axis >= 0)
        if len(rows) <= count:
            return rows
        return rows[np.argpartition(-self.excess[rows], count)[:count]]

    def split_boxes(self, rows: IntArray) -> list[tuple[int, Array, Array]]:
        """Remove boxes and return their halves by branch: index, lower, upper (n, k)."""
        halves = []
        for index, boxes in enumerate(self.branches):
            on_branch, k = rows[self.branch[rows] == index], len(boxes.branch.free)
            if not len(on_branch):
                continue
            low, high, axis = self.lower[on_branch][:, :k], self.upper[on_branch][:, :k], self.axis[on_branch]
            at = np.arange(len(on_branch))
            middle = 0.5 * (low[at, axis] + high[at, axis])
            left, right = high.copy(), low.copy()
            left[at, axis] = right[at, axis] = middle
            # Halves are adjacent because neighbours are likely to be covered by the same design.
            lower = np.stack([low, right], axis=1).reshape(-1, k)
            upper = np.stack([left, high], axis=1).reshape(-1, k)
            halves.append((index, lower, upper))
        self.keep_boxes(np.setdiff1d(np.arange(len(self)), rows, assume_unique=True))
        return halves


def bounding_threads() -> ThreadPoolExecutor:
    """Return a separate thread pool, because bounding calls kernels that wait for the shared pool."""
    return ThreadPoolExecutor(max_workers=cpu_count() or 1, thread_name_prefix="slidercrank-boxes")
