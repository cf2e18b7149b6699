"""The convex programme for one minimax step, built once and solved repeatedly with other numbers.

With objective pieces p (relative to the current greatest) of gradient g, constraint rows c <= 0 of gradient a, and
unit-box point u, a step solves

    min  t + w s + |R d|^2 / 2   over d, t, s
    subject to  p + g d <= t (each piece),   c + a d <= s,   0 <= s,   low <= d <= high,

where t is the epigraph of the greatest piece, s the greatest violation with its exact penalty w, and R'R the curvature
of the Lagrangian. Its multipliers for the pieces are a convex combination by construction, because t has slope one.
"""

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....model.arrays import Array
from ....model.optional_packages import import_extra

_ABSENT = -1e3
"""Value of absent rows: no step within the unit box makes them active."""
_HELD = 1e-7  # a multiplier above it makes a row active
_TOLERANCE = 1e-11
_NEAR = 1e-6  # in the unit box: limit on the correction that makes active rows exact


@dataclass(frozen=True)
class Step:
    """A step.

    move: (k,). top: t, the greatest piece after it according to the slopes. slack: s. goals: (p,), limits: (q,),
    lower_multipliers, upper_multipliers: (k,), multipliers of pieces, constraints and bounds, zero or more.
    """

    move: Array
    top: float
    slack: float
    goals: Array
    limits: Array
    lower_multipliers: Array
    upper_multipliers: Array


class Subproblem:
    """The programme for k unknowns, p pieces and q constraint rows.

    Building it costs as much as a hundred solutions.
    """

    def __init__(self, k: int, p: int, q: int) -> None:
        cp = import_extra("cvxpy", "minimax searches need")

        self.move, self.top, self.slack = cp.Variable(k), cp.Variable(), cp.Variable(nonneg=True)
        self.pieces, self.slopes = cp.Parameter(p), cp.Parameter((p, k))
        self.rows, self.normals = cp.Parameter(q), cp.Parameter((q, k))
        self.root, self.weight = cp.Parameter((k, k)), cp.Parameter(nonneg=True)
        self.low, self.high = cp.Parameter(k), cp.Parameter(k)
        self.held = [
            self.pieces + self.slopes @ self.move <= self.top,
            self.move >= self.low,
            self.move <= self.high,
        ]
        if q:
            self.held.append(self.rows + self.normals @ self.move <= self.slack)
        curve: Any = 0.5 * cp.sum(cp.square(self.root @ self.move))
        self.programme = cp.Problem(cp.Minimize(self.top + self.weight * self.slack + curve), self.held)

    def solve(
        self,
        goals: tuple[Array, Array],
        limits: tuple[Array, Array],
        root: Array,
        low: Array,
        high: Array,
        weight: float,
    ) -> Step | None:
        """Return the step for values and gradients of pieces and constraints; None if the solver fails."""
        cp = import_extra("cvxpy", "minimax searches need")

        (pieces, slopes), (rows, normals) = _neutralise_absent(*goals), _neutralise_absent(*limits)
        self.pieces.value, self.slopes.value = pieces, slopes
        if len(rows):
            self.rows.value, self.normals.value = rows, normals
        self.root.value, self.weight.value = root, weight
        self.low.value, self.high.value = low, high
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # "may be inaccurate": the step is judged by its gain
            try:
                self.programme.solve(
                    solver=cp.CLARABEL,
                    warm_start=False,  # a descent must not depend on earlier ones, which a resumed run omits
                    tol_gap_abs=_TOLERANCE,
                    tol_gap_rel=_TOLERANCE,
                    tol_feas=_TOLERANCE,
                )
            except cp.SolverError:
                return None
        if self.programme.status not in (cp.OPTIMAL, cp.OPTIMAL_INACCURATE):
            return None
        duals = [np.maximum(np.atleast_1d(constraint.dual_value), 0.0) for constraint in self.held]
        limiting = duals[3] if len(duals) > 3 else np.zeros(0)
        move, top, slack = (np.asarray(variable.value, np.float64) for variable in (self.move, self.top, self.slack))
        step = Step(
            np.clip(move, low, high),
            float(top),
            max(0.0, float(slack)),
            duals[0],
            limiting,
            duals[1],
            duals[2],
        )
        return _refine_step(step, (pieces, slopes), (rows, normals), low, high)


def _neutralise_absent(values: Array, slopes: Array) -> tuple[Array, Array]:
    """Return rows in which absent ones, and those too low to matter, are neutralised."""
    is_present = values > _ABSENT
    return np.where(is_present, values, _ABSENT), np.where(is_present[:, None], slopes, 0.0)


def _refine_step(step: Step, goals: tuple[Array, Array], limits: tuple[Array, Array], low: Array, high: Array) -> Step:
    """Return the step after the smallest correction that makes its active rows hold exactly.

    An interior-point method stops short of them by its tolerance, which would remain as a permanent violation.
    """
    (pieces, slopes), (rows, normals) = goals, limits
    k = len(step.move)
    tied, edge = step.goals > _HELD, step.limits > _HELD
    slack = step.slack if step.slack > _NEAR else 0.0
    move = np.where(step.lower_multipliers > _HELD, low, np.where(step.upper_multipliers > _HELD, high, step.move))
    free = (step.lower_multipliers <= _HELD) & (step.upper_multipliers <= _HELD)
    matrix = np.zeros((int(tied.sum() + edge.sum()), k + 1))
    matrix[:, :k] = np.concatenate([slopes[tied], normals[edge]])
    matrix[: tied.sum(), k] = -1.0
    left = np.concatenate([pieces[tied] + slopes[tied] @ move - step.top, rows[edge] + normals[edge] @ move - slack])
    columns = np.append(free, True)
    change = np.zeros(k + 1)
    change[columns] = np.linalg.lstsq(matrix[:, columns], -left, rcond=1e-10)[0]
    if np.abs(change).max() > _NEAR or np.abs(move - step.move).max() > _NEAR:
        return step
    return replace(step, move=np.clip(move + change[:k], low, high), top=step.top + float(change[k]), slack=slack)
