"""Stationarity of a design: the least-norm combination of objective gradients and active constraint gradients.

A design is Pareto-stationary if no direction improves every objective while the active constraints hold, i.e. if

    min | sum_i lambda_i g_i + sum_j mu_j a_j |   with lambda >= 0, sum lambda = 1, mu >= 0

is zero (Karush-Kuhn-Tucker conditions of the multi-objective problem; Miettinen, "Nonlinear Multiobjective
Optimization", 1999, Thm 3.1.5). At a kink, all its pieces count. It is solved as a non-negative least-squares problem
with sum lambda = 1 as one more weighted row. The minimiser is the same up to its length, because the rest is
homogeneous.
"""

import numpy as np

from ...model.arrays import Array, IntArray, row_norms
from ..problem.constraint_violation import closed_sides
from ..problem.requirements import Constraint
from .nonnegative_least_squares import nonnegative_least_squares
from .saved_front import is_constant


def slack_of(constraint: Constraint, values: Array) -> Array:
    """Return the distances (n,) of values from the nearer bound, SI: 0 on the bound, negative beyond it.

    Infinite for infinite values, NaN for missing ones.
    """
    slack = np.full(len(values), np.inf)
    if constraint.equality:
        slack = -_distances_from_bound(values, constraint.lower, np.abs(values - float(constraint.lower or 0.0)))
    else:
        for side, bound, _ in closed_sides(constraint):
            slack = np.minimum(slack, _distances_from_bound(values, bound, side * (bound - values)))
    return slack


def _distances_from_bound(values: Array, bound: float | None, slack: Array) -> Array:
    """Return distances from a bound, with 0 for values that differ from it only by rounding."""
    on_it = is_constant(np.stack([values, np.full(len(values), bound or 0.0)]), size=0.0 if bound else 1.0)
    return np.where(on_it & np.isfinite(values), 0.0, slack)


STATIONARY = 1e-6
"""Residual below which a design counts as stationary, with objectives scaled by their range."""
_STIFF = 1e3  # weight of the rows that fix the sums of weights, relative to gradient rows of size one


def optimality_multipliers(goals: Array, active: Array) -> tuple[float, Array, Array]:
    """Return residual, lambda (p,), mu (q,) for objective gradients (p, k) and active constraint gradients (q, k)."""
    p, q = len(goals), len(active)
    size, lengths = _row_sizes(goals, active)
    matrix = np.zeros((goals.shape[1] + 1, p + q))
    matrix[:-1, :p] = goals.T / size
    matrix[:-1, p:] = (active / lengths[:, None]).T
    matrix[-1, :p] = 1.0
    target = np.zeros(goals.shape[1] + 1)
    target[-1] = 1.0
    solution = nonnegative_least_squares(matrix, target)
    total = 0.0 if solution is None else solution[:p].sum()
    if solution is None or total <= 0.0:
        return float("inf"), np.full(p, 1.0 / p), np.zeros(q)
    convex, pushing = solution[:p] / total, solution[p:] / total
    residual = float(np.linalg.norm(matrix[:-1] @ np.concatenate([convex, pushing]))) * size
    return residual, convex, pushing * size / lengths


def multipliers_with_positive_weights(
    goals: Array, owner: IntArray, active: Array, *, exactly: bool = False
) -> tuple[float, Array, Array]:
    """Return residual, lambda (p,) and mu (q,) with weight on every objective.

    These are the optimality conditions of Benson's problem, the least sum of objectives with none made worse:

        min | sum_p lambda_p g_p + sum_j mu_j a_j | with each objective's weights lambda adding up to at least 1.

    This rejects a design that only a zero weight makes stationary: two objectives oppose each other while a third could
    still improve for free. The residual is not divided by the sum of weights, which may grow without bound. exactly:
    whether each objective's weights add up to exactly 1, as for the least sum without held objectives.
    """
    names = sorted(set(owner.tolist()))
    p, q, m = len(goals), len(active), len(names)
    size, lengths = _row_sizes(goals, active)
    k = goals.shape[1]
    matrix = np.zeros((k + m, p + q + (0 if exactly else m)))
    matrix[:k, :p] = goals.T / size
    matrix[:k, p : p + q] = (active / lengths[:, None]).T
    for row, name in enumerate(names):
        matrix[k + row, :p] = _STIFF * (owner == name)
        if not exactly:
            matrix[k + row, p + q + row] = -_STIFF
    target = np.zeros(k + m)
    target[k:] = _STIFF
    solution = nonnegative_least_squares(matrix, target)
    if solution is None:
        return float("inf"), np.full(p, 1.0 / p), np.zeros(q)
    residual = float(np.linalg.norm(matrix[:k, : p + q] @ solution[: p + q])) * size
    return residual, solution[:p], solution[p : p + q] * size / lengths


def _row_sizes(goals: Array, active: Array) -> tuple[float, Array]:
    """Return a common size of the objective rows and the length of each active row, for scale-free weights."""
    lengths = row_norms(active)
    lengths[lengths == 0.0] = 1.0
    return float(row_norms(goals).max(initial=0.0)) or 1.0, lengths
