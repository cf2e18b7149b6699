"""The quadratic programme of one polishing step, solved as a least-distance problem.

With scaled objective pieces p of gradient g, and constraint rows c <= 0 of gradient a, a step solves

    min  sum_i (t_i + t_i^2 / 2) + sum_i (K v_i + K^2 v_i^2 / 2) + (C w + C^2 w^2 / 2) + d' B d / 2   over d, t, v, w
    subject to  p + g d <= F_i + t_i  (each piece p of objective i),   t_i <= v_i,   0 <= v_i,
                c + a d <= w,   0 <= w,   0 <= u + d <= 1,   |d| <= radius,

where F_i is the objective's current value (the greatest of its pieces) and B is positive definite. A loss t_i <= v_i
has a margin for rounding, so that an imperceptible gain does not count as a loss. v and w are exact penalties: where an
objective and a constraint oppose each other exactly, rounding would leave a programme with hard bounds without a
solution. Without objectives, the step is the shortest one that meets the constraints. If only the sum counts, v is
omitted.
"""

from dataclasses import dataclass
from functools import cache
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from ...model.arrays import Array, row_norms
from ..front.nonnegative_least_squares import nonnegative_least_squares
from .piece_rows import Rows

LOSS = 1e3
"""K: weight of an objective's loss against another's gain, with ranges scaled to one."""
FIRM = 1e6
"""K for the objective in which a design is best: where its slope vanishes, no weight holds it to more than 1 / K^2."""
VIOLATION = 1e2
"""C: initial weight of a constraint's relative violation; it must exceed the multipliers of the limits."""
ROUNDING = 1e-12
"""Smaller losses and violations are rounding."""
_STEP_RANGE = 1.0  # pieces farther below the greatest cannot become the greatest within a step


@dataclass(frozen=True)
class Step:
    """A step d (k,), the multipliers of goal rows (p,) and limit rows (q,), and the active gradients (r, k).

    normals: gradients of the limits, bounds, held objectives and ties (differences) with positive multipliers.
    """

    move: Array
    goals: Array
    limits: Array
    normals: Array


class Aim(NamedTuple):
    """Objectives that a step improves, and those that it holds.

    chosen: objectives to improve. tops: (m,), F of every objective. loss: (m,), K of every objective. hold: whether the
    loss of each objective is penalised, besides the sum.
    """

    chosen: tuple[int, ...]
    tops: Array
    loss: Array
    hold: bool


def solve_step(u: Array, goals: Rows, limits: Rows, root: Array, *, radius: float, violation: float, aim: Aim) -> Step:
    """Return the step from u (k,) with one design's rows; a zero step if the programme cannot be solved.

    root: transposed inverse of L with B = L L', see `transposed_inverse_roots`. violation: C.

    With B = L L' and x = (L' d, t + 1, K v + 1, C w + 1), the programme becomes min |x|^2 / 2 subject to G x >= h, and
    its dual is a non-negative least-squares problem (Lawson and Hanson, "Solving Least Squares Problems", 1974, ch.
    23.4).
    """
    chosen, tops, loss, hold = aim
    k, count = len(u), len(chosen)
    low, high = np.maximum(-u, -radius), np.minimum(1.0 - u, radius)
    close = goals.values > (tops - _STEP_RANGE)[goals.owner]
    pieces = [((goals.owner == owner) & close).nonzero()[0] for owner in chosen]
    near = np.isfinite(limits.values).nonzero()[0]
    holding = count if hold else 0
    counts = [*map(len, pieces), holding, holding, len(near), 1, k, k]
    ends = [0, *accumulate(counts)]
    *goal_rows, losing, gaining, limiting, violating, upper_bounds, lower_bounds = map(slice, ends[:-1], ends[1:])
    size = k + count + holding + 1
    rows, bounds = np.zeros((ends[-1], size)), np.zeros(ends[-1])  # a z <= b for z = (d, t, v, w)
    loss_identity, edge = _identity(holding), _identity(k)
    for place, (owner, columns, part) in enumerate(zip(chosen, pieces, goal_rows, strict=True)):
        bounds[part] = tops[owner] - goals.values[columns]
        rows[part, :k] = goals.gradients[columns]
        rows[part, k + place] = -1.0
    bounds[losing] = ROUNDING
    rows[losing, k : k + holding] = loss_identity
    rows[losing, k + count : -1] = rows[gaining, k + count : -1] = -loss_identity
    bounds[limiting] = -limits.values[near]
    rows[limiting, :k] = limits.gradients[near]
    rows[limiting, -1] = rows[violating, -1] = -1.0
    bounds[upper_bounds], bounds[lower_bounds] = high, -low
    rows[upper_bounds, :k], rows[lower_bounds, :k] = edge, -edge
    weights = np.empty(count + holding + 1)
    weights[:count], weights[count:-1], weights[-1] = 1.0, loss[list(chosen)] if hold else (), violation
    move, dual = _solve_least_distance(rows, bounds, root, weights)
    is_binding = dual > 0.0
    goal_weight, limit_weight = np.zeros(len(goals.owner)), np.zeros(len(limits.owner))
    limit_weight[near] = dual[limiting]
    normals = [
        limits.gradients[near[is_binding[limiting]]],
        edge[is_binding[upper_bounds] & (high < radius)],
        edge[is_binding[lower_bounds] & (low > -radius)],
    ]
    losers = is_binding[losing].tolist() if hold else [False] * count
    for loses, columns, part in zip(losers, pieces, goal_rows, strict=True):
        goal_weight[columns] = dual[part]
        tied = goals.gradients[columns[is_binding[part]]]
        normals.append(tied[1:] - tied[:1])
        if loses:
            normals.append(tied[:1])
    return Step(move.clip(low, high), goal_weight, limit_weight, np.concatenate(normals))


@cache
def _identity(size: int) -> Array:
    return np.eye(size)


def transposed_inverse_roots(hessians: Array) -> Array:
    """Return the transposed inverses (n, k, k) of L for positive definite matrices L L'."""
    return np.linalg.inv(np.linalg.cholesky(hessians)).transpose(0, 2, 1)


def _solve_least_distance(rows: Array, bounds: Array, root: Array, weights: Array) -> tuple[Array, Array]:
    """Return d and the multipliers of all rows; zeros if rounding leaves no solution."""
    k, size = len(root), rows.shape[1]
    scale = np.zeros((size, size))  # z = scale x + shift
    scale[:k, :k] = root
    scale.flat[k * (size + 1) :: size + 1] = 1.0 / weights
    shift = np.zeros(size)
    shift[k:] = -1.0 / weights
    g, h = -rows @ scale, rows @ shift - bounds
    lengths = row_norms(g)
    lengths[lengths == 0.0] = 1.0
    columns = np.empty((len(rows), size + 1))
    columns[:, :-1], columns[:, -1] = g / lengths[:, None], h / lengths
    matrix = columns.T
    target = np.zeros(size + 1)
    target[-1] = 1.0
    dual = nonnegative_least_squares(matrix, target)
    if dual is None:
        return np.zeros(k), np.zeros(len(rows))
    rest = matrix @ dual - target
    if rest[-1] == 0.0:
        return np.zeros(k), np.zeros(len(rows))
    x, is_binding = -rest[:-1] / rest[-1], dual > 0.0
    # Between opposing pieces, large multipliers cancel, so the active rows determine the step more exactly.
    holding = g[is_binding]
    x = x + np.linalg.lstsq(holding, h[is_binding] - holding @ x, rcond=1e-12)[0]
    return (scale @ x)[:k], dual / lengths / -rest[-1]
