"""What an optimisation gives: the Pareto front, how good it is, and how it was found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ..model.errors import InputError
from ..objectives.registry import quantity
from .problem import Objective, Problem

Array = NDArray[np.float64]
Status = Literal["done", "cancelled", "infeasible"]


@dataclass(frozen=True)
class Progress:
    """Where a search stands after one of its rounds.

    round, rounds: this one and how many are planned. feasible: designs found so far that meet every constraint.
    hypervolume: of the front so far, in the unit box of the final scaling; not comparable between runs.
    """

    stage: str
    round: int
    rounds: int
    evaluations: int
    feasible: int
    hypervolume: float
    seconds: float


@dataclass(frozen=True)
class ParetoFront:
    """The Pareto front of a problem and the evidence for it.

    designs: one row a design, all quantities under their JSON names with units, then `slack_<quantity>` for every
    constraint (distance to the nearer bound in the quantity's shown unit; zero where active), `residual` (stationarity)
    and `status` ("stationary" or "best found"). Sorted by the first objective, best first.
    dimensions: (n, 3) crank, rod, offset, m, exactly. values: (n, m) objectives as they are minimised (maximised ones
    negated, targets as distances), SI. goals: for each design, objective index and gradient of every active piece;
    active: gradients of its active constraints; both by the free unknowns scaled to the unit box.
    hypervolume: dominated share of the box between the front's ideal and 1.1 times nadir, see `hypervolume.py`.
    history: rounds. versions: of this software and what computed the numbers.
    """

    problem: Problem
    status: Status
    message: str
    designs: pd.DataFrame
    dimensions: Array
    values: Array
    goals: tuple[tuple[Array, Array], ...]
    active: tuple[Array, ...]
    hypervolume: float
    history: tuple[Progress, ...]
    evaluations: int
    seconds: float
    seed: int
    versions: dict[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.designs)

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """The problem's objectives."""
        return self.problem.objectives

    def extremes(self) -> dict[str, int]:
        """Return for each objective the row of its best design; ties go to the better in the other objectives."""
        scaled = self._scaled()
        best = {}
        for index, objective in enumerate(self.objectives):
            least = np.flatnonzero(scaled[:, index] <= scaled[:, index].min() + 1e-9)
            best[objective.quantity] = int(least[np.argmin(scaled[least].sum(axis=1))])
        return best

    def knee(self) -> int:
        """Return the row nearest to the ideal point, every objective scaled by its range over the front."""
        return int(np.argmin(np.linalg.norm(self._scaled(), axis=1)))

    def pick(self, best: str, **bounds: tuple[float | None, float | None]) -> int:
        """Return the row that is best in an objective among those within bounds.

        best: an objective's quantity name. bounds: column = (least, greatest) in the table's units, None for open:
        `front.pick("peak_torque", least_transmission_angle_deg=(40, None))`. Raises `InputError` when none qualifies.
        """
        names = [objective.quantity for objective in self.objectives]
        if best not in names:
            raise InputError(f"pick by one of the objectives {', '.join(names)}; got {best!r}")
        keep = np.ones(len(self), dtype=bool)
        for column, (least, greatest) in bounds.items():
            if column not in self.designs.columns:
                raise InputError(f"the table has no column {column!r}; see front.designs.columns")
            values = self.designs[column].to_numpy()
            if least is not None:
                keep &= values >= least
            if greatest is not None:
                keep &= values <= greatest
        if not keep.any():
            raise InputError(f"no design of the front lies within {bounds}; widen a bound")
        rows = np.flatnonzero(keep)
        return int(rows[np.argmin(self.values[rows, names.index(best)])])

    def rates(self, row: int) -> Array:
        """Return the trade-off rates at a design, (m, m): `[a, b]` is what objective a loses per unit that b gains.

        Both in shown units, all other objectives at least kept and the active constraints held, to first order: the
        least max(g_a d) over directions d with g_b d <= -1, g_c d <= 0. NaN where others must pay too, or nobody need.
        """
        from scipy.optimize import linprog

        owner, slopes = self.goals[row]
        m, k = len(self.objectives), slopes.shape[1]
        units = np.array([quantity(objective.quantity).unit.factor for objective in self.objectives])
        slopes = slopes * units[owner.astype(int)][:, None]
        spans = units * (np.ptp(self.values, axis=0) + 1e-300)
        rates = np.full((m, m), np.nan)
        for a in range(m):
            for b in range(m):
                if a == b or k == 0:
                    continue
                pays = (owner == a).astype(float)
                rows = np.concatenate([np.column_stack([slopes, -pays]), np.pad(self.active[row], ((0, 0), (0, 1)))])
                limits = np.concatenate([np.where(owner == b, -1.0, 0.0), np.zeros(len(self.active[row]))])
                size = np.maximum(np.abs(rows[:, :k]).max(axis=1, initial=0.0), 1e-300)
                found = linprog(
                    np.eye(k + 1)[k],
                    rows / size[:, None],
                    limits / size,
                    bounds=[(None, None)] * (k + 1),
                    method="highs",
                )
                # A rate below rounding of the ranges says that nobody need pay.
                if found.x is not None and found.status == 0 and found.x[k] > 1e-6 * spans[a] / spans[b]:
                    rates[a, b] = found.x[k]
        return rates

    def trade_offs(self, row: int) -> list[str]:
        """Return the trade-off rates at a design in words: "1 deg more transmission angle costs 0.8 N m ..."."""
        rates = self.rates(row)
        sentences = []
        for b, gain in enumerate(self.objectives):
            for a, cost in enumerate(self.objectives):
                if not np.isfinite(rates[a, b]):
                    continue
                one, other = quantity(gain.quantity), quantity(cost.quantity)
                step = 1.0 if one.unit.symbol else 0.01
                more = {"maximise": "more", "minimise": "less", "target": "nearer to its target in"}[gain.sense]
                lost = {"maximise": "less", "minimise": "more", "target": "farther from its target in"}[cost.sense]
                sentences.append(
                    " ".join(
                        f"{step:g} {one.unit.symbol} {more} {one.title} costs "
                        f"{step * rates[a, b]:.3g} {other.unit.symbol} {lost} {other.title}".split()
                    )
                )
        return sentences

    def _scaled(self) -> Array:
        if not len(self):
            raise InputError("the front is empty; see its message for what contradicts what")
        low, high = self.values.min(axis=0), self.values.max(axis=0)
        return np.asarray((self.values - low) / np.where(high > low, high - low, 1.0))
