"""Designs with their values, row by row: screened ones, polished ones, and candidates for the front; its growth."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array, IntArray, Mask, sorted_unique
from ..front.dominance import nondominated
from ..front.hypervolume import ReportProgress, hypervolume, ideal_and_range, ignore_progress
from ..front.stationarity import STATIONARY
from ..problem.constraint_violation import FEASIBLE
from .evaluation import Evaluator
from .sampling import distant_rows

EQUAL = 1e-9
"""Relative to the objectives' range: a design as good as another to within this in all objectives, and better in one,
displaces it."""
SAME = 1e-7
"""The same for designs that the polish has moved, which end about this far from their optimum."""
COVERED = 1e-3
"""The same for designs that are not stationary, beside a stationary one; a single objective has one optimum, hence
SAME."""
_ROUNDING = 1e-11  # relative to an objective's magnitude: rounding error of its computation


@dataclass
class Table:
    """Arrays of equal length as fields of a dataclass. Keyword-only fields are not split into rows."""

    @classmethod
    def _row_fields(cls) -> list[str]:
        return [item.name for item in fields(cls) if not item.kw_only]

    def __len__(self) -> int:
        return len(getattr(self, self._row_fields()[0]))

    def __getitem__(self, rows: NDArray[Any] | slice) -> Self:
        return replace(self, **{name: getattr(self, name)[rows] for name in self._row_fields()})

    def join(self, *tables: Table) -> Self:
        """Return these rows with those of other tables below; see `stack_rows`."""
        parts = (self, *tables)
        return replace(
            self, **{name: stack_rows(*(getattr(part, name) for part in parts)) for name in self._row_fields()}
        )

    def replace_content(self, other: Self) -> None:
        """Replace this table's content by that of another table of the same kind."""
        vars(self).update(vars(other))


def stack_rows(*parts: NDArray[Any]) -> NDArray[Any]:
    """Return arrays stacked by rows; points with fewer columns are padded with zeros."""
    if parts[0].ndim == 2:
        width = max(part.shape[1] for part in parts)
        parts = tuple(part if part.shape[1] == width else _pad_columns(part, width) for part in parts)
    return np.concatenate(parts)


def _pad_columns(part: NDArray[Any], width: int) -> NDArray[Any]:
    padded = np.zeros((len(part), width), part.dtype)
    padded[:, : part.shape[1]] = part
    return padded


def object_array(parts: Iterable[object]) -> NDArray[np.object_]:
    """Return an array (n,) with one entry of any shape per design."""
    return np.fromiter(parts, dtype=np.object_)


@dataclass
class Candidates(Table):
    """Designs with their objectives.

    branch: (n,), index. u: (n, k), unit-box points, padded to the greatest number of columns on any branch. values: (n,
    m), SI, as minimised. is_feasible: (n,), whether each meets every constraint; the others are close enough to move
    there.
    """

    branch: IntArray
    u: Array
    values: Array
    is_feasible: Mask

    @classmethod
    def empty(cls, objectives: int) -> Self:
        """Return no designs."""
        return cls(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, objectives)), np.zeros(0, np.bool_))

    def feasible_and_infeasible(self) -> list[Self]:
        """Return the feasible designs and those to move onto the constraints, as separate groups."""
        return [group for group in (self[self.is_feasible], self[~self.is_feasible]) if len(group)]

    def leading_rows(self, column: int, count: int) -> IntArray:
        """Return at most `count` rows that meet every constraint, and at most `count` others.

        The best in an objective come first, each at a distance from the better ones.
        """
        groups = [np.flatnonzero(self.is_feasible), np.flatnonzero(~self.is_feasible)]
        return np.concatenate(
            [rows[distant_rows(self.values[rows, column], self.u[rows], self.branch[rows], count)] for rows in groups]
        )

    def points_by_branch(self, evaluators: list[Evaluator]) -> list[tuple[int, Array]]:
        """Return index and points of each branch that has points."""
        return [
            (index, self.u[self.branch == index][:, : evaluator.dimension])
            for index, evaluator in enumerate(evaluators)
            if (self.branch == index).any()
        ]

    def dimensions(self, evaluators: list[Evaluator]) -> Array:
        """Return the designs (n, 3 + v), SI."""
        designs = np.zeros((len(self), max(len(evaluator.branch.names) for evaluator in evaluators)))
        for index in sorted_unique(self.branch).tolist():
            on_branch, branch = self.branch == index, evaluators[index].branch
            designs[on_branch, : len(branch.names)] = branch.designs_at_points(self.u[on_branch][:, : len(branch.free)])
        return designs


@dataclass
class Polished(Table):
    """Designs after the polish.

    u: (n, k) points. values: (n, m) scaled objectives. violation: (n,) greatest relative violation. residual: (n,), see
    `stationarity.multipliers`. goals: for each design, owner and gradient of the active objective pieces. active: the
    gradients of its active constraints and bounds.
    """

    u: Array
    values: Array
    violation: Array
    residual: Array
    goals: NDArray[np.object_]
    active: NDArray[np.object_]


@dataclass
class FrontCandidates(Candidates):
    """Candidates for the front: feasible polished designs, and those on branches without free unknowns.

    residual: (n,). goals, active: (n,), see `Polished`. span: (m,), scale of the objectives.
    """

    residual: Array
    goals: NDArray[np.object_]
    active: NDArray[np.object_]
    span: Array = field(kw_only=True)

    @classmethod
    def without_designs(cls, span: Array) -> Self:
        """Return no designs."""
        bare, nothing = Candidates.empty(len(span)), np.zeros(0, np.object_)
        return cls(bare.branch, bare.u, bare.values, bare.is_feasible, np.zeros(0), nothing, nothing, span=span)

    def add_feasible(self, index: int, part: Polished) -> None:
        """Add the polished designs on a branch that are feasible and have all objectives."""
        part = part[(part.violation <= FEASIBLE) & np.isfinite(part.values).all(axis=1)]
        branch, is_feasible = np.full(len(part), index), np.ones(len(part), np.bool_)
        columns = (branch, part.u, part.values * self.span, is_feasible, part.residual, part.goals, part.active)
        self.replace_content(self.join(FrontCandidates(*columns, span=self.span)))

    @property
    def has_free_unknowns(self) -> Mask:
        """Whether the branch has free unknowns."""
        return np.array([slopes.shape[1] > 0 for _, slopes in self.goals], dtype=np.bool_)

    def only_enumerated(self, span: Array) -> Self:
        """Return the designs on enumerated branches, whose gradients need no scaling, with another span."""
        return replace(self[~self.has_free_unknowns], span=span)

    def nondominated_rows(self, report: ReportProgress = ignore_progress) -> IntArray:
        """Return the non-dominated rows, ascending, thinned out where they hardly differ. report: called for each row.

        None of them is as good as another to within `EQUAL` in all objectives and better in one.
        """
        values, several, free = self.values, len(self.span) > 1, self.has_free_unknowns
        range_ = np.ptp(values[nondominated(values)], axis=0) if several and len(values) else self.span
        size = _ROUNDING * np.abs(values).max(axis=0, initial=0.0)
        equal, same, covered = (
            np.maximum(share * range_, size) for share in (EQUAL, SAME, COVERED if several else SAME)
        )
        doubtful = self.residual > STATIONARY
        deserves = ~doubtful
        proven = np.ascontiguousarray(values[~doubtful].T)
        least = proven.min(axis=1, initial=np.inf) - same  # the best in an objective is an end, proven or not
        for row in np.flatnonzero(doubtful).tolist():
            report(0, len(values))
            deserves[row] = (values[row] < least).any() or not _is_nearly_as_good(proven, values[row], covered).any()
        rows = np.flatnonzero(deserves)
        rows = rows[nondominated(values[rows])]
        chosen: list[int] = []
        theirs = np.empty((len(self.span), len(rows)))
        # Proven designs first, then the best in an objective.
        scaled = values[rows] / self.span
        leads = np.isin(np.arange(len(rows)), np.argmin(scaled, axis=0) if len(rows) else [])
        order = np.lexsort([scaled.sum(axis=1), ~leads, doubtful[rows]])
        for position, row in enumerate(rows[order].tolist()):
            report(position, len(rows))
            if not _is_nearly_as_good(theirs[:, : len(chosen)], values[row], same if free[row] else equal).any():
                theirs[:, len(chosen)] = values[row]
                chosen.append(row)
        # No kept design is as good as an earlier one; a later one may be, if the earlier one is best only by rounding.
        theirs, alone = theirs[:, : len(chosen)], []
        for row in chosen:
            report(len(rows), len(rows))
            if _is_nearly_as_good(theirs, values[row], equal).sum() == 1:
                alone.append(row)
        return np.array(sorted(alone), dtype=np.int64)


def _is_nearly_as_good(values: Array, row: Array, tolerance: Array) -> Mask:
    """Return which designs with values (m, n) are worse than one (m,) by at most the tolerances in all objectives."""
    return np.asarray((values - row[:, None] <= tolerance[:, None]).all(axis=0))


_MOST = {1: 1, 2: 5000, 3: 5000, 4: 1000, 5: 600}
"""Designs whose volume is computed, by number of objectives: it takes 2 ms for these, and ten times as long for a few
more."""
_OF_MANY = 200  # the same for six objectives, which takes 0.02 s
_LEAST_SIDE = 0.1  # relative to the best value: minimum side of the box if the first front is nearly a point
_OF_TARGET = 0.01  # the same for a target, because designs that meet it differ by rounding


class FrontVolume:
    """Volume that the designs found so far dominate.

    It is measured from a fixed corner in boxes of fixed size, so it only grows as more designs are found. If there are
    very many designs, an evenly spread subset counts, a different one each time. No design is ever lost, so the
    greatest volume of any subset is still dominated.

    box: ideal and span (m,); the corner is 1.1 spans beyond the ideal. Without a box, that of the first designs counts,
    and the volume may exceed one box, because later designs may be better than their ideal. With a box, volume beyond
    its ideal does not count. targets: (m,), targets of the objectives, zero for none. front: (n, m), the subset counted
    last, objectives as minimised.
    """

    def __init__(
        self, targets: Array, *, box: tuple[Array, Array] | None = None, max_designs: int | None = None
    ) -> None:
        """Start without designs. max_designs: number of designs that count; by default, as many as are fast."""
        self.front: Array = np.zeros((0, len(targets)))
        self._targets = targets
        self._box = box
        self._within = box is not None
        self._most = max_designs or _MOST.get(len(targets), _OF_MANY)
        self._volume = 0.0

    def add(self, values: Array) -> float:
        """Add feasible designs, objectives (n, m), and return the volume that all designs dominate, in boxes."""
        values = np.concatenate([self.front, self._spread_sample(values[np.isfinite(values).all(axis=1)])])
        if not len(values):
            return 0.0
        values = values[nondominated(values)]
        if self._box is None:
            ideal, span = ideal_and_range(values)
            self._box = (
                ideal,
                np.maximum(span, np.maximum(_LEAST_SIDE * np.abs(ideal), _OF_TARGET * np.abs(self._targets))),
            )
        self.front = self._spread_sample(values)
        self._volume = max(self._volume, hypervolume(self.front, *self._box, clip_at_ideal=self._within))
        return self._volume

    def _spread_sample(self, values: Array) -> Array:
        return values[sorted_unique(np.linspace(0, len(values) - 1, self._most).astype(int))] if len(values) else values
