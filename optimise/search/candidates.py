"""Designs with their values, row by row: screened ones, polished ones, and those that are worth delivering."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array, Mask, Whole, distinct
from ..front.dominance import nondominated
from ..front.hypervolume import Stand, unheard
from ..front.stationarity import STATIONARY
from ..problem.violation import FEASIBLE
from .evaluation import Evaluator
from .sampling import apart

EQUAL = 1e-9
"""Of the objectives' range: a design as good as another one to this everywhere, and better somewhere, displaces it."""
SAME = 1e-7
"""The same for designs that the polish has moved: it ends some of this away from where it would go."""
COVERED = 1e-3
"""The same for designs that are not stationary, beside one that is; a single objective has one answer, hence SAME."""
_ROUNDING = 1e-11  # of an objective's size: differences that its computation may have


@dataclass
class Table:
    """Arrays of one length: fields of a dataclass. Keyword-only fields are no rows, and stay as they are."""

    @classmethod
    def _columns(cls) -> list[str]:
        return [item.name for item in fields(cls) if not item.kw_only]

    def __len__(self) -> int:
        return len(getattr(self, self._columns()[0]))

    def __getitem__(self, rows: NDArray[Any] | slice) -> Self:
        return replace(self, **{name: getattr(self, name)[rows] for name in self._columns()})

    def join(self, *others: Table) -> Self:
        """Return these rows and those of others below them, see `stacked`."""
        parts = (self, *others)
        return replace(self, **{name: stacked(*(getattr(part, name) for part in parts)) for name in self._columns()})

    def become(self, other: Self) -> None:
        """Take the place of another table of the same kind."""
        vars(self).update(vars(other))


def stacked(*parts: NDArray[Any]) -> NDArray[Any]:
    """Return arrays under each other; those of points with fewer columns are padded with zeros."""
    if parts[0].ndim == 2:
        width = max(part.shape[1] for part in parts)
        parts = tuple(part if part.shape[1] == width else _widened(part, width) for part in parts)
    return np.concatenate(parts)


def _widened(part: NDArray[Any], width: int) -> NDArray[Any]:
    found = np.zeros((len(part), width), part.dtype)
    found[:, : part.shape[1]] = part
    return found


def ragged(parts: Iterable[object]) -> NDArray[np.object_]:
    """Return one entry a design, (n,), of any shape."""
    return np.fromiter(parts, dtype=np.object_)


@dataclass
class Candidates(Table):
    """Designs with their objectives.

    sheet: (n,), index. u: (n, k), unit-box points, padded to as many columns as any sheet has. values: (n, m), SI, as
    minimised. met: (n,), which of them meet every constraint; the others are near enough to be moved there.
    """

    sheet: Whole
    u: Array
    values: Array
    met: Mask

    @classmethod
    def empty(cls, objectives: int) -> Self:
        """Return no designs."""
        return cls(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, objectives)), np.zeros(0, np.bool_))

    def groups(self) -> list[Self]:
        """Return those that meet every constraint and those that are to be moved there: choose from each alone."""
        return [group for group in (self[self.met], self[~self.met]) if len(group)]

    def leading(self, column: int, count: int) -> Whole:
        """Return at most `count` rows that meet every constraint, and as many others.

        The best in an objective come first, each `apart` from the better ones.
        """
        groups = [np.flatnonzero(self.met), np.flatnonzero(~self.met)]
        return np.concatenate(
            [rows[apart(self.values[rows, column], self.u[rows], self.sheet[rows], count)] for rows in groups]
        )

    def by_sheet(self, evaluators: list[Evaluator]) -> list[tuple[int, Array]]:
        """Return the points of each sheet that has some, with its index."""
        return [
            (index, self.u[self.sheet == index][:, : evaluator.dimension])
            for index, evaluator in enumerate(evaluators)
            if (self.sheet == index).any()
        ]

    def dimensions(self, evaluators: list[Evaluator]) -> Array:
        """Return the designs (n, 3 + v), SI."""
        found = np.zeros((len(self), max(len(evaluator.sheet.names) for evaluator in evaluators)))
        for index in distinct(self.sheet).tolist():
            own, sheet = self.sheet == index, evaluators[index].sheet
            found[own, : len(sheet.names)] = sheet.dimensions(self.u[own][:, : len(sheet.free)])
        return found


@dataclass
class Polished(Table):
    """Designs after the polish.

    u: (n, k) points. values: (n, m) scaled objectives. violation: (n,) greatest relative. residual: (n,), see
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
class Finished(Candidates):
    """Candidates for the front: polished designs, all feasible, and those of sheets that leave nothing free.

    residual: (n,). goals, active: (n,), see `Polished`. span: (m,), what objectives are scaled by.
    """

    residual: Array
    goals: NDArray[np.object_]
    active: NDArray[np.object_]
    span: Array = field(kw_only=True)

    @classmethod
    def none(cls, span: Array) -> Self:
        """Return no designs."""
        bare, nothing = Candidates.empty(len(span)), np.zeros(0, np.object_)
        return cls(bare.sheet, bare.u, bare.values, bare.met, np.zeros(0), nothing, nothing, span=span)

    def add(self, index: int, part: Polished) -> None:
        """Take in those polished designs of a sheet that are feasible and have all objectives."""
        part = part[(part.violation <= FEASIBLE) & np.isfinite(part.values).all(axis=1)]
        sheet, met = np.full(len(part), index), np.ones(len(part), np.bool_)
        found = (sheet, part.u, part.values * self.span, met, part.residual, part.goals, part.active)
        self.become(self.join(Finished(*found, span=self.span)))

    @property
    def free(self) -> Mask:
        """Whether the sheet leaves something free."""
        return np.array([slopes.shape[1] > 0 for _, slopes in self.goals], dtype=np.bool_)

    def only_settled(self, span: Array) -> Self:
        """Return the designs of sheets that leave nothing free, which no gradient is scaled for, with another span."""
        return replace(self[~self.free], span=span)

    def best(self, stand: Stand = unheard) -> Whole:
        """Return the rows that none dominates, fewer where they hardly differ; ascending. stand: called for each.

        None of them is as good as another one to `EQUAL` everywhere and better somewhere.
        """
        values, several, free = self.values, len(self.span) > 1, self.free
        range_ = np.ptp(values[nondominated(values)], axis=0) if several and len(values) else self.span
        size = _ROUNDING * np.abs(values).max(axis=0, initial=0.0)
        equal, same, covered = (
            np.maximum(share * range_, size) for share in (EQUAL, SAME, COVERED if several else SAME)
        )
        doubtful = self.residual > STATIONARY
        worth = ~doubtful
        proven = np.ascontiguousarray(values[~doubtful].T)
        least = proven.min(axis=1, initial=np.inf) - same  # what is best in an objective is an end, proven or not
        for row in np.flatnonzero(doubtful).tolist():
            stand(0, len(values))
            worth[row] = (values[row] < least).any() or not _as_good(proven, values[row], covered).any()
        rows = np.flatnonzero(worth)
        rows = rows[nondominated(values[rows])]
        kept: list[int] = []
        theirs = np.empty((len(self.span), len(rows)))
        # What is proven first, then what is best in an objective.
        scaled = values[rows] / self.span
        leads = np.isin(np.arange(len(rows)), np.argmin(scaled, axis=0) if len(rows) else [])
        order = np.lexsort([scaled.sum(axis=1), ~leads, doubtful[rows]])
        for done, row in enumerate(rows[order].tolist()):
            stand(done, len(rows))
            if not _as_good(theirs[:, : len(kept)], values[row], same if free[row] else equal).any():
                theirs[:, len(kept)] = values[row]
                kept.append(row)
        # Nobody kept is as good as one before it; one after it may be, where that one is best by rounding alone.
        theirs, alone = theirs[:, : len(kept)], []
        for row in kept:
            stand(len(rows), len(rows))
            if _as_good(theirs, values[row], equal).sum() == 1:
                alone.append(row)
        return np.array(sorted(alone), dtype=np.int64)


def _as_good(values: Array, row: Array, within: Array) -> Mask:
    """Return which designs are nowhere worse than one (m,) by more than these differences; values: (m, n), of them."""
    return np.asarray((values - row[:, None] <= within[:, None]).all(axis=0))
