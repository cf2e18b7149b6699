"""Designs that the polish has finished, and which of them are worth delivering."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...model.kinematics.in_line import without_rounding
from ..front.hypervolume import Stand, nondominated, unheard
from ..front.stationarity import STATIONARY, Array
from .evaluation import FEASIBLE, Evaluator
from .polish import Polished
from .sampling import stacked

EQUAL = 1e-9
"""Of the objectives' range: a design as good as another one to this everywhere, and better somewhere, displaces it."""
SAME = 1e-7
"""The same for designs that the polish has moved: it ends some of this away from where it would go."""
COVERED = 1e-3
"""The same for designs that are not stationary, beside one that is; a single objective has one answer, hence SAME."""
_ROUNDING = 1e-11  # of an objective's size: differences that its computation may have


class Pile:
    """Polished designs, all feasible, and those of sheets that leave nothing free.

    span: (m,), what objectives are scaled by. sheet: (n,), index. free: (n,), whether the sheet leaves something free.
    u: (n, k), unit-box points, padded. dimensions: (n, 3 + v), designs, SI. values: (n, m), SI, minimised. residual:
    (n,). goals, active: see `polish.Polished`.
    """

    def __init__(self, span: Array) -> None:
        """Start without designs."""
        self.span = span
        self.sheet: NDArray[np.int64] = np.zeros(0, np.int64)
        self.free: NDArray[np.bool_] = np.zeros(0, np.bool_)
        self.u: Array = np.zeros((0, 3))
        self.dimensions: Array = np.zeros((0, 3))
        self.values: Array = np.zeros((0, len(span)))
        self.residual: Array = np.zeros(0)
        self.goals: list[tuple[Array, Array]] = []
        self.active: list[Array] = []

    def __len__(self) -> int:
        return len(self.dimensions)

    def add(self, index: int, evaluator: Evaluator, part: Polished) -> None:
        """Take in those polished designs of a sheet that are feasible and have all objectives."""
        rows = np.flatnonzero((part.violation <= FEASIBLE) & np.isfinite(part.values).all(axis=1))
        self.sheet = np.concatenate([self.sheet, np.full(len(rows), index)])
        self.free = np.concatenate([self.free, np.full(len(rows), evaluator.dimension > 0)])
        self.u = stacked(self.u, part.u[rows])
        dimensions = evaluator.sheet.dimensions(part.u[rows])
        dimensions[:, 2] = without_rounding(dimensions[:, 1], dimensions[:, 2])
        self.dimensions = stacked(self.dimensions, dimensions)
        self.values = np.concatenate([self.values, part.values[rows] * self.span])
        self.residual = np.concatenate([self.residual, part.residual[rows]])
        self.goals += [part.goals[row] for row in rows]
        self.active += [part.active[row] for row in rows]

    def part(self, rows: NDArray[np.int64]) -> Pile:
        """Return a pile of these rows only."""
        part = Pile(self.span)
        for name in ("sheet", "free", "u", "dimensions", "values", "residual"):
            setattr(part, name, getattr(self, name)[rows])
        part.goals, part.active = [self.goals[row] for row in rows], [self.active[row] for row in rows]
        return part

    @property
    def settled(self) -> int:
        """The number of designs of sheets that leave nothing free."""
        return int((~self.free).sum())

    def only_settled(self, span: Array) -> Pile:
        """Return the designs of sheets that leave nothing free, which no gradient is scaled for, with another span."""
        part = self.part(np.flatnonzero(~self.free))
        part.span = span
        return part

    def best(self, stand: Stand = unheard) -> NDArray[np.int64]:
        """Return the rows that none dominates, fewer where they hardly differ; ascending. stand: called for each.

        None of them is as good as another one to `EQUAL` everywhere and better somewhere.
        """
        values, several = self.values, len(self.span) > 1
        range_ = np.ptp(values[nondominated(values)], axis=0) if several and len(values) else self.span
        size = _ROUNDING * np.abs(values).max(axis=0, initial=0.0)
        equal, same, covered = (
            np.maximum(share * range_, size) for share in (EQUAL, SAME, COVERED if several else SAME)
        )
        doubtful = self.residual > STATIONARY
        worth = ~doubtful
        for row in np.flatnonzero(doubtful).tolist():
            stand(0, len(values))
            worth[row] = not _as_good(values[~doubtful], values[row], covered).any()
        rows = np.flatnonzero(worth)
        rows = rows[nondominated(values[rows])]
        kept: list[int] = []
        # What is proven first, then what is best in an objective.
        scaled = values[rows] / self.span
        order = np.lexsort([scaled.sum(axis=1), np.where(_leads(scaled), 0, 1), doubtful[rows]])
        for done, row in enumerate(rows[order].tolist()):
            stand(done, len(rows))
            if not _as_good(values[kept], values[row], same if self.free[row] else equal).any():
                kept.append(row)
        # Nobody kept is as good as one before it; one after it may be, where that one is best by rounding alone.
        alone = [row for row in kept if _as_good(values[kept], values[row], equal).sum() == 1]
        return np.array(sorted(alone), dtype=np.int64)


def _as_good(values: Array, row: Array, within: Array) -> NDArray[np.bool_]:
    """Return which designs (n, m) are nowhere worse than one (m,) by more than these differences."""
    return np.asarray((values - row <= within).all(axis=1))


def _leads(values: Array) -> NDArray[np.bool_]:
    leads = np.zeros(len(values), dtype=bool)
    if len(values):
        leads[np.argmin(values, axis=0)] = True
    return leads
