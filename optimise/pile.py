"""Designs that the polish has finished, and which of them are worth delivering."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .elimination import ZERO
from .evaluation import FEASIBLE, Evaluator
from .hypervolume import Stand, nondominated, unheard
from .polish import Polished
from .sampling import stacked
from .stationarity import Array

STATIONARY = 1e-6
"""Residual, objectives scaled by their range, below which a design counts as stationary."""
SAME = 1e-7
"""Of the objectives' range: designs that another one matches to this are not delivered beside it."""
COVERED = 1e-3
"""The same for designs that are not stationary, beside one that is; a single objective has one answer, hence SAME."""


class Pile:
    """Polished designs, all feasible.

    span: (m,), what objectives are scaled by. sheet: (n,), index. u: (n, k), unit-box points, padded. dimensions:
    (n, 3 + v), designs, SI. values: (n, m), SI, minimised. residual: (n,). goals, active: see `polish.Polished`.
    """

    def __init__(self, span: Array) -> None:
        """Start without designs."""
        self.span = span
        self.sheet: NDArray[np.int64] = np.zeros(0, np.int64)
        self.u: Array = np.zeros((0, 3))
        self.dimensions: Array = np.zeros((0, 3))
        self.values: Array = np.zeros((0, len(span)))
        self.residual: Array = np.zeros(0)
        self.goals: list[tuple[Array, Array]] = []
        self.active: list[Array] = []

    def __len__(self) -> int:
        return len(self.dimensions)

    def add(self, index: int, evaluator: Evaluator, part: Polished) -> None:
        """Take in those polished designs of a sheet that are feasible."""
        rows = np.flatnonzero(part.violation <= FEASIBLE)
        self.sheet = np.concatenate([self.sheet, np.full(len(rows), index)])
        self.u = stacked(self.u, part.u[rows])
        dimensions = evaluator.sheet.dimensions(part.u[rows])
        self.dimensions = stacked(self.dimensions, np.where(np.abs(dimensions) <= ZERO, 0.0, dimensions))
        self.values = np.concatenate([self.values, part.values[rows] * self.span])
        self.residual = np.concatenate([self.residual, part.residual[rows]])
        self.goals += [part.goals[row] for row in rows]
        self.active += [part.active[row] for row in rows]

    def part(self, rows: NDArray[np.int64]) -> Pile:
        """Return a pile of these rows only."""
        part = Pile(self.span)
        for name in ("sheet", "u", "dimensions", "values", "residual"):
            setattr(part, name, getattr(self, name)[rows])
        part.goals, part.active = [self.goals[row] for row in rows], [self.active[row] for row in rows]
        return part

    def best(self, stand: Stand = unheard) -> NDArray[np.int64]:
        """Return the rows that none dominates, fewer where they hardly differ; ascending. stand: called for each."""
        scaled = self.values / self.span
        doubtful = self.residual > STATIONARY
        covered = COVERED if len(self.span) > 1 else SAME
        sure = scaled[~doubtful]
        if len(sure):
            apart = np.zeros(len(scaled))
            for row in np.flatnonzero(doubtful).tolist():
                stand(0, len(scaled))
                apart[row] = np.min(np.max(sure - scaled[row], axis=1))
            rows = np.flatnonzero(~doubtful | (apart > covered))
        else:
            rows = np.arange(len(scaled))
        rows = rows[nondominated(scaled[rows])]
        kept: list[int] = []
        # What is proven first, then what is best in an objective.
        order = np.lexsort([scaled[rows].sum(axis=1), np.where(_leads(scaled[rows]), 0, 1), doubtful[rows]])
        for done, row in enumerate(rows[order].tolist()):
            stand(done, len(rows))
            if not kept or np.min(np.max(scaled[kept] - scaled[row], axis=1)) > SAME:
                kept.append(row)
        return np.array(sorted(kept), dtype=np.int64)


def _leads(values: Array) -> NDArray[np.bool_]:
    leads = np.zeros(len(values), dtype=bool)
    if len(values):
        leads[np.argmin(values, axis=0)] = True
    return leads
