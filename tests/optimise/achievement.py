"""The achievement function of a wish, minimised without the optimiser: SLSQP on its epigraph form, from many starts.

All numbers come from `Problem.evaluate`. Unknowns are the k numbers of a design - crank, rod, offset and what else
varies -, each by its range, the levels s of the objectives and t:

    min t + rho sum_i s_i   subject to   f_i <= s_i,   w_i (s_i - z_i) <= t where w_i > 0,   s_i <= c_i,   constraints,

equalities among them. A target makes two rows, of the distance to either side.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from slidercrank.optimise.problem.constraint_violation import constraints_with_floors
from slidercrank.optimise.problem.problem import Problem
from tests.optimise.independent import excess

Array = NDArray[np.float64]
_OUT = 10.0  # what a row counts where no linkage turns fully
_AGAIN = 3  # runs from where the one before has ended
_FEASIBLE = 1e-8


@dataclass(frozen=True)
class StoredObjective:
    """Weights, reference and ceilings (m,) of objectives as they are minimised, by ideal and span; rho."""

    weights: Array
    reference: Array
    ceilings: Array
    rho: float
    ideal: Array
    span: Array


class Independent:
    """A problem with nothing left to be chosen and the wish for its objectives."""

    def __init__(self, problem: Problem, wanted: StoredObjective) -> None:
        self.problem, self.wanted, self.m = problem, wanted, len(problem.objectives)
        self.constraints = constraints_with_floors(problem)
        self.goals = [objective.quantity for objective in problem.objectives]
        self.names = list(dict.fromkeys([*self.goals, *(c.quantity for c in self.constraints)]))
        ends = [(of.lower, of.upper) for of in problem.ranges.values()]
        self.k = len(ends)
        self.lower, upper = np.array(ends).T
        if (side := problem.slow_side()) is not None:
            self.lower[2], upper[2] = (max(self.lower[2], 1e-9), upper[2]) if side > 0.0 else (self.lower[2], -1e-9)
        self.size = np.where(upper > self.lower, upper - self.lower, 1.0)
        self.cost = np.concatenate([np.zeros(self.k), np.full(self.m, wanted.rho), [1.0]])
        self._at: tuple[bytes, Array, Array] | None = None
        self._rows: tuple[bytes, Array, Array] | None = None

    def minimum(self, starts: Array) -> float:
        """Return the least value of the achievement function over designs (n, k) to start from."""
        return min((self._descend((start - self.lower) / self.size) for start in starts), default=np.inf)

    def value(self, design: Array) -> float:
        """Return the achievement function of a design, infinite where it is not feasible."""
        return self._value((design - self.lower) / self.size)

    def _quantities(self, x: Array) -> tuple[Array, Array]:
        """Return quantities (q,) and derivatives (q, k) by the unknowns."""
        x = np.clip(x, 0.0, 1.0)
        if self._at is None or self._at[0] != x.tobytes():
            values, slopes = self.problem.evaluate((self.lower + x * self.size)[None], self.names, gradients=True)
            self._at = (x.tobytes(), values[0], slopes[0] * self.size)
        return self._at[1], self._at[2]

    def _scaled(self, x: Array) -> Array:
        values, found = self._quantities(x)[0], []
        for objective in self.problem.objectives:
            value = values[self.names.index(objective.quantity)]
            distance = value if objective.target is None else abs(value - objective.target)
            found.append(-distance if objective.sense == "maximise" else distance)
        return np.asarray((np.array(found) - self.wanted.ideal) / self.wanted.span)

    def _value(self, x: Array) -> float:
        scaled, values = self._scaled(x), self._quantities(x)[0]
        over = [excess(c, values[[self.names.index(c.quantity)]])[0] for c in self.constraints]
        if not np.isfinite(scaled).all() or max(*over, 0.0, *(scaled - self.wanted.ceilings)) > _FEASIBLE:
            return np.inf
        used = self.wanted.weights > 0.0
        return float(
            (self.wanted.weights * (scaled - self.wanted.reference))[used].max() + self.wanted.rho * scaled.sum()
        )

    def _descend(self, x: Array) -> float:
        for _ in range(_AGAIN):
            scaled = self._scaled(x)
            if not np.isfinite(scaled).all():
                return np.inf
            used = self.wanted.weights > 0.0
            top = (self.wanted.weights * (scaled - self.wanted.reference))[used].max()
            rules: list[Any] = [{"type": "ineq", "fun": lambda z: self._held(z)[0], "jac": lambda z: self._held(z)[1]}]
            if any(c.equality for c in self.constraints):
                rules += [{"type": "eq", "fun": lambda z: self._equal(z)[0], "jac": lambda z: self._equal(z)[1]}]
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)
                solve: Any = minimize
                found = solve(
                    lambda z: self.cost @ z,
                    np.concatenate([x, scaled, [top]]),
                    jac=lambda z: self.cost,
                    bounds=[(0.0, 1.0)] * self.k + [(None, None)] * (self.m + 1),
                    constraints=rules,
                    method="SLSQP",
                    options={"maxiter": 60, "ftol": 1e-14},
                ).x
            if not np.isfinite(found).all():
                break
            x, before = np.clip(found[: self.k], 0.0, 1.0), x
            if np.abs(x - before).max() < 1e-9:
                break
        return self._value(x)

    def _held(self, z: Array) -> tuple[Array, Array]:
        """Return the rows that must be zero or more, and their derivatives; asked for either at each point."""
        if self._rows is None or self._rows[0] != z.tobytes():
            self._rows = (z.tobytes(), *self._held_at(z))
        return self._rows[1], self._rows[2]

    def _held_at(self, z: Array) -> tuple[Array, Array]:
        values, slopes = self._quantities(z[: self.k])
        edges = np.eye(len(z))

        def wide(slope: Array) -> Array:
            return np.concatenate([slope, np.zeros(len(z) - self.k)])

        rows: list[tuple[float, Array]] = []
        for i, objective in enumerate(self.problem.objectives):
            at, level = self.names.index(objective.quantity), edges[self.k + i]
            sides = (1.0, -1.0) if objective.target is not None else (-1.0 if objective.sense == "maximise" else 1.0,)
            for side in sides:
                own = (side * (values[at] - (objective.target or 0.0)) - self.wanted.ideal[i]) / self.wanted.span[i]
                slope = wide(side * slopes[at] / self.wanted.span[i])
                rows.append((z[self.k + i] - own, level - slope))
            if (weight := self.wanted.weights[i]) > 0.0:
                rows.append((z[-1] - weight * (z[self.k + i] - self.wanted.reference[i]), edges[-1] - weight * level))
            if np.isfinite(self.wanted.ceilings[i]):
                rows.append((self.wanted.ceilings[i] - z[self.k + i], -level))
        for constraint in self.constraints:
            at = self.names.index(constraint.quantity)
            for side, bound in ((1.0, constraint.upper), (-1.0, constraint.lower)):
                if bound is not None and not constraint.equality:
                    scale = abs(bound) or 1.0
                    rows.append((side * (bound - values[at]) / scale, wide(-side * slopes[at] / scale)))
        found, slope = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
        return np.nan_to_num(found, nan=-_OUT), np.nan_to_num(slope)

    def _equal(self, z: Array) -> tuple[Array, Array]:
        """Return the rows that must vanish, and their derivatives."""
        values, slopes = self._quantities(z[: self.k])
        held = [(self.names.index(c.quantity), c.upper or 0.0) for c in self.constraints if c.equality]
        rows = np.array([(values[at] - bound) / (abs(bound) or 1.0) for at, bound in held])
        slope = np.array([np.pad(slopes[at] / (abs(bound) or 1.0), (0, len(z) - self.k)) for at, bound in held])
        return np.nan_to_num(rows, nan=_OUT), np.nan_to_num(slope)
