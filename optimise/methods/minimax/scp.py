"""Sequential convex programming for the greatest of smooth pieces, from one start; see `minimax`."""

from dataclasses import dataclass, replace

import numpy as np

from ....model.arrays import Array
from ...search.piece_rows import Rows, rows_of_designs, values_corrected_for_curvature, weighted_gradient_change
from ...search.polish import Evaluates
from .subproblem import Step, Subproblem

CONVERGED = 1e-8
"""Residual at which a descent has converged: the limit of what the solver's multipliers can show."""
_ITERATIONS = 80
_RADIUS, _LARGEST, _SHORTEST = 0.1, 0.5, 1e-12  # trust region radii in the unit box
_POOR, _GOOD = 0.1, 0.75  # ratios of actual to predicted decrease below which it shrinks and above which it widens
_MET = 1e-11  # relative violation that further steps need not remove
_NOISE = 1e-14  # relative to the objective: smaller decreases may be rounding
_WEIGHT, _HEAVIEST = 10.0, 1e7  # penalty for a relative violation, with the objective scaled to one
_DIFFERENCE = 1e-6  # in the unit box, for differences of gradients
_CURVATURE = 1e-8  # least eigenvalue of the programme's curvature


@dataclass
class Point:
    """A design during a descent: its position, its rows, and the last programme there.

    u: (k,). goals: pieces of the objective, scaled. limits: constraint rows. step: last step, with its multipliers.
    residual: see `lagrangian_residual`.
    """

    u: Array
    goals: Rows
    limits: Rows
    step: Step | None = None
    residual: float = np.inf

    @property
    def greatest_piece(self) -> float:
        """The greatest piece."""
        return float(self.goals.values.max())

    @property
    def violation(self) -> float:
        """The greatest relative violation."""
        return float(np.max(self.limits.values, initial=0.0))

    def penalty_merit(self, weight: float) -> float:
        """Return the exact penalty function."""
        return self.greatest_piece + weight * self.violation


class Descent:
    """Descents of one evaluator; each programme is built once for all of them."""

    def __init__(self, evaluator: Evaluates, scale: float) -> None:
        self.evaluator, self.scale = evaluator, scale
        self._programmes: dict[tuple[int, int, int], Subproblem] = {}

    def descend_from(self, start: Array) -> Point:
        """Return the end of the descent from a valid point (k,) in the unit box."""
        point = self._point_at(np.clip(start, 0.0, 1.0))
        radius, weight = _RADIUS, _WEIGHT
        root = np.zeros((len(start), len(start)))
        for iteration in range(_ITERATIONS):
            step, weight = self._step_and_penalty(point, root, radius, weight)
            if step is None:
                break
            point.step, point.residual = step, lagrangian_residual(point, step)
            still = float(np.abs(step.move).max()) < _SHORTEST
            converged = point.residual <= CONVERGED and point.violation <= _MET
            if converged or radius < _SHORTEST or still or iteration == _ITERATIONS - 1:
                break
            root = self._hessian_root(point, step)
            step, weight = self._step_and_penalty(point, root, radius, weight)
            if step is None:
                break
            gain, trial = self._try_step(point, step, root, weight)
            if gain < _POOR:
                again = self._try_second_order_correction(point, trial, step, root, radius, weight)
                if again is not None and again[0] > gain:
                    gain, trial = again
            size = float(np.abs(step.move).max())
            if gain >= _POOR and trial is not None:
                point = trial
                if gain > _GOOD and size > 0.9 * radius:
                    radius = min(_LARGEST, 2.0 * radius)
            else:
                radius = 0.25 * min(radius, size)
        return point

    def _point_at(self, u: Array) -> Point:
        goals, limits = self.evaluator.objective_and_constraint_rows(u[None])
        scaled = replace(goals, values=goals.values / self.scale, gradients=goals.gradients / self.scale)
        return Point(u, rows_of_designs(scaled, 0), rows_of_designs(limits, 0))

    def _solve_step(
        self, point: Point, goals: Array, limits: Array, root: Array, radius: float, weight: float
    ) -> Step | None:
        """Return the step for these values of the rows, relative to the point's greatest piece."""
        shape = (len(point.u), len(goals), len(limits))
        if shape not in self._programmes:
            self._programmes[shape] = Subproblem(*shape)
        return self._programmes[shape].solve(
            (goals - point.greatest_piece, point.goals.gradients),
            (limits, point.limits.gradients),
            root,
            np.maximum(-point.u, -radius),
            np.minimum(1.0 - point.u, radius),
            weight,
        )

    def _step_and_penalty(self, point: Point, root: Array, radius: float, weight: float) -> tuple[Step | None, float]:
        """Return the step, and the penalty that its multipliers require: an exact penalty exceeds their sum."""
        while True:
            step = self._solve_step(point, point.goals.values, point.limits.values, root, radius, weight)
            if step is None or step.limits.sum() < 0.9 * weight or weight >= _HEAVIEST:
                return step, weight
            heavier = self._solve_step(point, point.goals.values, point.limits.values, root, radius, 10.0 * weight)
            if heavier is None or heavier.slack > 0.9 * step.slack:
                return step, weight  # no step within the radius removes the violation
            weight *= 10.0

    def _try_step(self, point: Point, step: Step, root: Array, weight: float) -> tuple[float, Point | None]:
        """Return actual over predicted decrease, and the design after a step; None if it cannot rotate fully."""
        predicted = weight * (point.violation - step.slack) - step.top - 0.5 * float(np.sum((root @ step.move) ** 2))
        u = np.clip(point.u + step.move, 0.0, 1.0)
        if not self.evaluator.can_evaluate(u[None])[0]:
            return -1.0, None
        trial = self._point_at(u)
        actual = point.penalty_merit(weight) - trial.penalty_merit(weight)
        noise = _NOISE * (1.0 + abs(point.greatest_piece) + weight)
        if predicted <= noise:
            return (1.0 if abs(actual) <= noise else -1.0), trial
        return (actual + noise) / predicted, trial

    def _try_second_order_correction(
        self, point: Point, trial: Point | None, step: Step, root: Array, radius: float, weight: float
    ) -> tuple[float, Point | None] | None:
        """Return the same for the step corrected for the curvature of the rows along it."""
        if trial is None:
            return None
        goals, limits = (
            values_corrected_for_curvature(present, after, step.move)
            for present, after in ((point.goals, trial.goals), (point.limits, trial.limits))
        )
        corrected = self._solve_step(point, goals, limits, root, radius, weight)
        if corrected is None:
            return None
        # Judged by the decrease that the first step predicted, because the corrected rows predict what they were
        # constructed to predict.
        return self._try_step(point, replace(step, move=corrected.move), root, weight)

    def _hessian_root(self, point: Point, step: Step) -> Array:
        """Return R with R'R the Lagrangian's Hessian, convexified along the active rows."""
        k = len(point.u)
        moves = np.where(point.u < 0.5, _DIFFERENCE, -_DIFFERENCE)
        moved = point.u + np.diag(moves)
        valid = self.evaluator.can_evaluate(moved)
        if not valid.all():
            return np.zeros((k, k))
        goals, limits = self.evaluator.objective_and_constraint_rows(moved)
        goals = replace(goals, gradients=goals.gradients / self.scale)
        hessian = weighted_gradient_change(point.goals, goals, step.goals) + weighted_gradient_change(
            point.limits, limits, step.limits
        )
        return _convex_root(
            0.5 * (hessian / moves[:, None] + (hessian / moves[:, None]).T), _active_normals(point, step)
        )


def lagrangian_residual(point: Point, step: Step) -> float:
    """Return the norm of the Lagrangian's gradient, plus complementarity gap, plus violation."""
    left = (
        step.goals @ np.where(step.goals[:, None] > 0.0, point.goals.gradients, 0.0)
        + step.limits @ np.where(step.limits[:, None] > 0.0, point.limits.gradients, 0.0)
        - step.lower_multipliers
        + step.upper_multipliers
    )
    is_piece, edge = np.isfinite(point.goals.values), np.isfinite(point.limits.values)
    gap = (
        step.goals[is_piece] @ (point.greatest_piece - point.goals.values[is_piece])
        + step.limits[edge] @ np.abs(point.limits.values[edge])
        + step.lower_multipliers @ point.u
        + step.upper_multipliers @ (1.0 - point.u)
    )
    return float(np.linalg.norm(left)) + float(gap) + point.violation


def _active_normals(point: Point, step: Step, least: float = 1e-6) -> Array:
    """Return the gradients of the rows active in a step: limits, bounds, and ties between pieces as differences."""
    tied = point.goals.gradients[step.goals > least]
    edge = np.eye(len(point.u))
    return np.concatenate(
        [
            tied[1:] - tied[:1],
            point.limits.gradients[step.limits > least],
            edge[(step.lower_multipliers + step.upper_multipliers) > least],
        ]
    )


def _convex_root(hessian: Array, normals: Array) -> Array:
    """Return R; curvature across the active rows is added first, which is harmless: the step does not cross them."""
    if not np.isfinite(hessian).all():
        return np.zeros_like(hessian)
    size = float(np.abs(hessian).max())
    lengths = np.linalg.norm(normals, axis=1)
    unit_normals = normals[lengths > 0.0] / lengths[lengths > 0.0, None]
    for weight in (0.0, 1.0, 10.0, 100.0):
        values, vectors = np.linalg.eigh(hessian + weight * size * unit_normals.T @ unit_normals)
        if values[0] >= 0.0:
            break
    return np.asarray(np.sqrt(np.clip(values, _CURVATURE, None))[:, None] * vectors.T)
