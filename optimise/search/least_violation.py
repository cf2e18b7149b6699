"""Designs closest to meeting all requirements: minimisation of the greatest violation."""

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ..problem.constraint_violation import FEASIBLE
from .candidates import Polished
from .evaluation import Evaluator
from .piece_rows import Rows
from .recorded_polish import polish_recorded
from .sampling import distant_rows

_BATCH = 256  # points to examine between two checks whether the best are among them


class _Violations:
    """View of all constraint rows as the pieces of one objective, to be minimised."""

    def __init__(self, evaluator: Evaluator) -> None:
        self.inner = evaluator

    def can_evaluate(self, u: Array) -> Mask:
        return self.inner.can_evaluate(u)

    def objective_and_constraint_rows(self, u: Array) -> tuple[Rows, Rows]:
        _, limits = self.inner.objective_and_constraint_rows(u, goals=False)
        goals = Rows(limits.values, limits.gradients, limits.labels, np.zeros(len(limits.owner), np.int64))
        return goals, Rows.without_rows(*u.shape)


def least_violation(evaluator: Evaluator, u: Array, *, ranked: int, starts: int) -> Polished:
    """Return designs with locally least violation, their only value, from points (n, k); none if none rotates fully.

    ranked: number of points of the branch to examine, evenly spread. starts: number of descents, from the best points.
    """
    u = u[evaluator.can_evaluate(u)]
    u = u[:: max(1, len(u) // ranked)]
    best = (
        u[distant_rows(greatest_violations(evaluator, u, starts), u, _zero_branch_indices(u), starts)] if len(u) else u
    )
    return polish_recorded(evaluator, best, np.ones(1), viewed_evaluator=_Violations(evaluator))


def greatest_violations(evaluator: Evaluator, u: Array, count: int) -> Array:
    """Return the greatest relative violation (n,) of points; infinite for some that are not among the best `count`.

    Points are examined in order of their violation of requirements that need no cycle, until the best are certain.
    """

    def greatest() -> tuple[Array]:
        violations, bound = np.full(len(u), np.inf), evaluator.violation_without_cycle(u)
        order = np.argsort(bound, kind="stable")
        for rows in np.split(order, range(_BATCH, len(u), _BATCH)):
            best = distant_rows(violations, u, _zero_branch_indices(u), count)
            if len(best) == count and violations[best].max() < bound[rows[0]] - FEASIBLE:
                break
            violations[rows] = evaluator.objective_and_constraint_rows(u[rows], goals=False)[1].values.max(
                axis=1, initial=0.0
            )
        return (violations,)

    return evaluator.recorded_step("violation", (u, np.array([count])), greatest)[0]


def _zero_branch_indices(u: Array) -> IntArray:
    return np.zeros(len(u), np.int64)
