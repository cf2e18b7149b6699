"""Price of robustness: the robust front compared with the nominal one for the same problem."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array
from ..front.front import ParetoFront
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..problem.robust_problem import nominal_problem
from ..solve import solve


@dataclass(frozen=True)
class RobustCost:
    """A robust front and the nominal one; objectives (n, m) in display units.

    nominal: objectives of the nominal designs, as drawn. toleranced: objectives of the same designs within tolerances.
    robust: objectives of the robust designs within tolerances. keeps: number of nominal designs that meet all
    requirements within tolerances.
    """

    nominal: Array
    toleranced: Array
    robust: Array
    keeps: int

    def cost(self, column: int, *, maximised: bool) -> float:
        """Return by how much the robust front's best value falls short of the nominal best, in display units."""
        best = np.max if maximised else np.min
        away = float(best(self.nominal[:, column]) - best(self.robust[:, column]))
        return away if maximised else -away


def robust_cost(front: ParetoFront) -> RobustCost | None:
    """Return the price of a front's robustness; None if the nominal problem has no front. Solves that problem."""
    problem = front.problem
    plain = solve(nominal_problem(problem))
    if not len(plain) or not len(front):
        return None
    keeps = 0
    toleranced = np.zeros(plain.values.shape)
    for row in range(len(plain)):
        part = problem.part(plain.variants[row] if plain.variants else 0)
        toleranced[row] = _objective_values(part, plain.dimensions[row : row + 1])
        keeps += _meets_constraints(part, plain.dimensions[row : row + 1])
    names = [plain.problem.quantity(objective.quantity).field for objective in plain.objectives]
    fields = [problem.quantity(objective.quantity).field for objective in front.objectives]
    return RobustCost(plain.designs[names].to_numpy(float), toleranced, front.designs[fields].to_numpy(float), keeps)


def _objective_values(problem: Problem, design: Array) -> list[float]:
    quantities = [problem.quantity(objective.quantity) for objective in problem.objectives]
    return [float(q.evaluate(problem.mechanism, design).values[0]) * q.unit.factor for q in quantities]


def _meets_constraints(problem: Problem, design: Array) -> bool:
    for constraint in problem.constraints:
        value = float(problem.quantity(constraint.quantity).evaluate(problem.mechanism, design).values[0])
        for bound, sign in ((constraint.lower, 1.0), (constraint.upper, -1.0)):
            if bound is not None and not sign * (value - bound) >= -FEASIBLE * (abs(bound) or 1.0):
                return False
    return True
