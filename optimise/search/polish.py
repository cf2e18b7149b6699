"""Sequential quadratic programming that moves designs onto the Pareto front.

Each design solves Benson's problem from its current position: min sum_i f_i with no objective made worse and all
constraints held. The solutions are Pareto-optimal (H. P. Benson, "Existence of efficient solutions for vector
maximization problems", JOTA 26(4), 1978). Mutual non-dominance, or a vanishing convex combination of some gradients, is
not enough: if two objectives do not change with the size of the linkage, a smaller copy may be better in all others.

`polish_programme` states the steps. Their Hessian is that of the Lagrangian, from differences of exact gradients, with
the multipliers from the programme itself. It is first made convex across the active rows. A full step that curves away
from rows that it must hold is corrected to second order before it is shortened (Nocedal and Wright, "Numerical
Optimization", 2006, ch. 18.3): otherwise designs creep along curved constraints. A design that starts outside the
constraints first moves onto them by the shortest step. Tied peaks enter as separate pieces: a kink is a minimax
problem, not noise. Designs advance together, so that every evaluation is a batch.
"""

from dataclasses import replace
from typing import Protocol

import numpy as np

from ...model.arrays import Array, IntArray, Mask, row_norms
from ..front.stationarity import multipliers_with_positive_weights, optimality_multipliers
from .candidates import Polished, object_array
from .piece_rows import (
    ACTIVE,
    Rows,
    active_bound_normals,
    active_pieces,
    greatest_pieces,
    rows_of_designs,
    values_corrected_for_curvature,
    weighted_gradient_change,
)
from .polish_programme import FIRM, LOSS, ROUNDING, VIOLATION, Aim, Step, solve_step, transposed_inverse_roots

ITERATIONS = 100
CONVERGED = 1e-9
"""Residual of Benson's problem at which a design has converged."""
_TIGHT = 1e-11  # replaces ACTIVE while a design may still move
_NOISE = 1e-15  # relative to the objectives: rounding error of the merit
_STALLED = (
    1e-13  # gain (relative to the objectives' ranges) of two consecutive steps below which a design's polish ends
)
_DIFFERENCE = 1e-6  # in the unit box, for differences of gradients
_CURVATURE = 1e-6  # least eigenvalue of the step's Hessian, with objectives and box scaled to one
_INDEPENDENT = 1e-6  # relative to unit vectors: a smaller part is not an independent, or a common, direction
_HEAVIEST = 1e8  # largest penalty for a violation
_PASSES = 5  # passes at a step where only the sum counts: a small gain along a kink does not justify leaving it
_SHORTEST = 1e-13  # radius at which a design's polish ends
_RESTORING = 12  # steps onto the constraints; Newton's method needs 3 to 6


class Evaluates(Protocol):
    """The part of an evaluator that the polish needs."""

    def can_evaluate(self, u: Array) -> Mask:
        """Return which points can be evaluated."""
        ...

    def objective_and_constraint_rows(self, u: Array) -> tuple[Rows, Rows]:
        """Return objective rows and constraint rows."""
        ...


def polish_designs(
    evaluator: Evaluates,
    start: Array,
    scale: Array,
    *,
    chosen: tuple[int, ...] | None = None,
    iterations: int | None = ITERATIONS,
    hold: bool = True,
    best_in: IntArray | None = None,
) -> Polished:
    """Return designs improved to stationarity from `start` (n, k) in the unit box.

    scale: range of each objective over the front. chosen: objectives to improve (all by default). iterations: maximum
    number of steps; None only moves designs that violate constraints onto them by the shortest step. hold: False lets
    an objective become worse if the sum improves. best_in: (n,), the objective in which each design is best, and
    remains best. A design that has been feasible once is feasible in the end.
    """
    batch = _Batch(evaluator, start, scale, chosen, hold)
    if best_in is not None:
        batch.loss[np.arange(len(start)), best_in] = FIRM
    if iterations != 0:
        batch.move_onto_constraints()
    for _ in range(iterations or 0):
        if not batch.take_step():
            break
    return batch.result()


class _Batch:
    """Designs under polish: their positions, their rows, and which still move."""

    def __init__(
        self, evaluator: Evaluates, start: Array, scale: Array, chosen: tuple[int, ...] | None, hold: bool
    ) -> None:
        self.evaluator = evaluator
        self.scale, self.hold = scale, hold
        self.chosen = tuple(range(len(scale))) if chosen is None else chosen
        self.u = np.clip(start, 0.0, 1.0)
        self.goals, self.limits = self._evaluate(self.u)
        n, k = start.shape
        self.weight = np.full(n, VIOLATION)
        self.loss = np.full((n, len(scale)), LOSS)
        self.roots = np.tile(np.eye(k), (n, 1, 1))
        """Roots of the Hessians; see `polish_programme.transposed_inverse_roots`."""
        self._evaluate_start()
        self.safe = np.where(self._feasible()[:, None], self.u, np.nan)

    def _evaluate_start(self) -> None:
        n, k = self.u.shape
        self.open = np.full(n, k > 0)
        self.stalls = np.zeros(n, dtype=np.int64)
        self.radius = np.full(n, 0.25)
        self.moved = np.ones(n, dtype=bool)
        self.held = greatest_pieces(self.goals, len(self.scale))

    def move_onto_constraints(self) -> None:
        """Move designs that violate constraints onto them by the shortest step."""
        for _ in range(_RESTORING):
            outside = np.flatnonzero(self.open & ~self._feasible())
            if not len(outside):
                break
            steps = [self._solve_programme(row, ()).move for row in outside.tolist()]
            self._try_steps(outside, np.array(steps), (), second_order=False)
        self._evaluate_start()

    def take_step(self) -> bool:
        """Take one step with every open design; return whether any was open."""
        for row in np.flatnonzero(self.open & self.moved & self._feasible()).tolist():
            if self._benson_residual(row) < CONVERGED:
                self.open[row] = False
        rows = np.flatnonzero(self.open)
        if not len(rows):
            return False
        fresh = rows[self.moved[rows]]
        if len(fresh):
            # The multipliers that the Hessian needs hardly depend on it, so those from the previous programme suffice.
            drafts = [self._solve_programme(row, self.chosen) for row in fresh.tolist()]
            self.roots[fresh] = transposed_inverse_roots(self._hessians(fresh, drafts))
        steps = [self._solve_programme(row, self.chosen).move for row in rows.tolist()]
        self._try_steps(rows, np.array(steps), self.chosen, second_order=True)
        self.open &= self.stalls < 2
        feasible = rows[self._feasible()[rows]]
        self.safe[feasible] = self.u[feasible]
        self.held[feasible] = greatest_pieces(self.goals, len(self.scale))[feasible]
        return True

    def result(self) -> Polished:
        """Return the designs at their current positions."""
        n, m = len(self.u), len(self.scale)
        lost = np.flatnonzero(~self._feasible() & np.isfinite(self.safe).all(axis=1))
        if len(lost):
            goals, limits = self._evaluate(self.safe[lost])
            for source, row in enumerate(lost.tolist()):
                self._overwrite(row, self.safe[row], goals, limits, source)
        residual = np.zeros(n)
        pieces, active = [], []
        moved = tuple(owner for owner in range(m) if owner not in self.goals.constant)
        chosen = tuple(owner for owner in self.chosen if owner in moved) or self.chosen
        for row in range(n):
            design_goals, edge = rows_of_designs(self.goals, row), rows_of_designs(self.limits, row)
            columns = active_pieces(design_goals, moved)
            pieces.append((design_goals.owner[columns].astype(np.float64), design_goals.gradients[columns]))
            active.append(np.concatenate([edge.gradients[edge.values > -ACTIVE], active_bound_normals(self.u[row])]))
            chosen_pieces = active_pieces(design_goals, chosen)
            residual[row], _, _ = optimality_multipliers(design_goals.gradients[chosen_pieces], active[-1])
        violation = self.limits.values.max(axis=1, initial=0.0)
        return Polished(
            self.u, greatest_pieces(self.goals, m), violation, residual, object_array(pieces), object_array(active)
        )

    def _feasible(self) -> Mask:
        return np.asarray(self.limits.values.max(axis=1, initial=0.0) <= ROUNDING)

    def _evaluate(self, u: Array) -> tuple[Rows, Rows]:
        goals, limits = self.evaluator.objective_and_constraint_rows(u)
        factor = 1.0 / self.scale[goals.owner]
        return replace(goals, values=goals.values * factor, gradients=goals.gradients * factor[:, None]), limits

    def _overwrite(self, row: int, u: Array, goals: Rows, limits: Rows, source: int) -> None:
        self.u[row] = u
        self.goals.overwrite(row, goals, source)
        self.limits.overwrite(row, limits, source)

    def _benson_residual(self, row: int) -> float:
        """Return the residual of Benson's problem; only fully active rows count, so that the polish reaches them."""
        goals, limits = rows_of_designs(self.goals, row), rows_of_designs(self.limits, row)
        pieces = active_pieces(goals, self.chosen, tolerance=_TIGHT)
        edges = np.concatenate(
            [limits.gradients[limits.values > -_TIGHT], active_bound_normals(self.u[row], tolerance=_TIGHT)]
        )
        return multipliers_with_positive_weights(
            goals.gradients[pieces], goals.owner[pieces], edges, exactly=not self.hold
        )[0]

    def _solve_programme(self, row: int, chosen: tuple[int, ...]) -> Step:
        """Return a design's step towards its objectives, or the shortest one onto its constraints without them."""
        goals, limits = rows_of_designs(self.goals, row), rows_of_designs(self.limits, row)
        first = step = self._solve_row_step(row, goals, limits, chosen)
        light = self.weight[row]
        while chosen and step.limits.sum() >= 0.5 * self.weight[row] and self.weight[row] < _HEAVIEST:
            self.weight[row] *= 10.0
            step = self._solve_row_step(row, goals, limits, chosen)
        if self.weight[row] > light and _violation_after_step(limits, step.move) > max(
            0.5 * _violation_after_step(limits, first.move), ROUNDING
        ):
            # No step within the radius removes the violation, so more weight would only stiffen the next steps.
            self.weight[row] = light
            return first
        return step

    def _solve_row_step(self, row: int, goals: Rows, limits: Rows, chosen: tuple[int, ...]) -> Step:
        return solve_step(
            self.u[row],
            goals,
            limits,
            self.roots[row] if chosen else np.eye(self.u.shape[1]),
            radius=self.radius[row],
            violation=self.weight[row],
            aim=Aim(chosen, self.held[row], self.loss[row], self.hold),
        )

    def _hessians(self, rows: IntArray, drafts: list[Step]) -> Array:
        """Return the Hessians (n, k, k) of the Lagrangians with fixed multipliers, made positive definite."""
        u = self.u[rows]
        n, k = u.shape
        hessians = np.zeros((n, k, k))
        steps = np.where(u < 0.5, _DIFFERENCE, -_DIFFERENCE)
        # All coordinates form one batch, because overhead dominates when there are few designs.
        still = np.tile(u, (k, 1))
        moved = still + (np.eye(k)[:, None, :] * steps).reshape(k * n, k)
        goals, limits = self._evaluate(np.where(self.evaluator.can_evaluate(moved)[:, None], moved, still))
        for i, (row, draft) in enumerate(zip(rows.tolist(), drafts, strict=True)):
            design_goals, edge, at = (
                rows_of_designs(self.goals, row),
                rows_of_designs(self.limits, row),
                slice(i, None, n),
            )
            change = weighted_gradient_change(
                design_goals, rows_of_designs(goals, at), np.minimum(draft.goals, self.loss[row, design_goals.owner])
            )
            change = change + weighted_gradient_change(
                edge, rows_of_designs(limits, at), np.minimum(draft.limits, _HEAVIEST)
            )
            hessians[i] = change / steps[i, :, None]
        hessians = 0.5 * (hessians + hessians.transpose(0, 2, 1))
        return np.stack([make_convex(hessian, draft.normals) for hessian, draft in zip(hessians, drafts, strict=True)])

    def _try_steps(self, rows: IntArray, steps: Array, objectives: tuple[int, ...], *, second_order: bool) -> None:
        """Take the steps that lower the merit, corrected if necessary; shrink the radius for the others.

        The merit is the sum of the objectives, plus penalised losses and greatest violation.
        """
        m, columns = len(self.scale), list(objectives)
        before, limits_to_hold = greatest_pieces(self.goals, m)[:, columns], self.held[:, columns]
        violation = _zero_below_rounding(self.limits.values.max(axis=1, initial=0.0))
        self.moved[rows] = False
        pending = np.arange(len(rows))
        steps = steps.copy()
        passes = (2 if self.hold else _PASSES) if second_order else 1
        for left in range(passes, 0, -1):
            at = rows[pending]
            trial = np.clip(self.u[at] + steps[pending], 0.0, 1.0)
            valid = self.evaluator.can_evaluate(trial)
            trial = np.where(valid[:, None], trial, self.u[at])
            goals, limits = self._evaluate(trial)
            after = greatest_pieces(goals, m)[:, columns]
            # Infinite before and after (rod / offset at 0), the merit is undefined and the step is not accepted.
            with np.errstate(invalid="ignore"):
                loss = _zero_below_rounding(after - limits_to_hold[at]) - _zero_below_rounding(
                    before[at] - limits_to_hold[at]
                )
                worse = _zero_below_rounding(limits.values.max(axis=1, initial=0.0)) - violation[at]
                penalty = self.loss[at][:, columns] * loss if self.hold else 0.0
                merit = (after - before[at] + penalty).sum(axis=1) + self.weight[at] * worse
            distance = np.abs(trial - self.u[at]).max(axis=1)
            # Where the objectives are flat to rounding, the programme still finds the point of zero slope.
            accepted = valid & (merit < _NOISE * (1.0 + np.abs(before[at]).sum(axis=1)))
            for i in np.flatnonzero(accepted).tolist():
                row = int(at[i])
                self._overwrite(row, trial[i], goals, limits, i)
                self.moved[row] = True
                if distance[i] > 0.5 * self.radius[row]:
                    self.radius[row] = min(0.5, 2.0 * self.radius[row])
                self.stalls[row] = self.stalls[row] + 1 if merit[i] > -_STALLED else 0
            if left > 1:
                for i in np.flatnonzero(~accepted & valid).tolist():
                    steps[pending[i]] = self._second_order_step(
                        int(at[i]), steps[pending[i]], rows_of_designs(goals, i), rows_of_designs(limits, i), objectives
                    )
            pending = pending[~accepted]
            if not len(pending):
                break
        lost = rows[pending]
        # Short steps no longer help, because of rounding or an unseen kink; the residual shows which.
        size = np.abs(steps[pending]).max(axis=1, initial=0.0)
        self.radius[lost] = 0.25 * np.minimum(self.radius[lost], size)
        self.open[lost] &= self.radius[lost] > _SHORTEST

    def _second_order_step(self, row: int, step: Array, goals: Rows, limits: Rows, chosen: tuple[int, ...]) -> Array:
        """Return the step that also holds rows from which the first one curves away.

        rows: the rows at the first step's end.
        """
        goals, limits = [
            replace(present, values=values_corrected_for_curvature(present, trial_rows, step))
            for present, trial_rows in (
                (rows_of_designs(self.goals, row), goals),
                (rows_of_designs(self.limits, row), limits),
            )
        ]
        return self._solve_row_step(row, goals, limits, chosen).move


def make_convex(hessian: Array, normals: Array) -> Array:
    """Return a positive definite matrix that agrees with the Hessian along the active rows, if possible."""
    if not np.isfinite(hessian).all():
        return np.eye(len(hessian))
    values, vectors = np.linalg.eigh(hessian)
    lengths = row_norms(normals)
    if values[0] < _CURVATURE and lengths.any():
        _, sizes, directions = np.linalg.svd(normals[lengths > 0.0] / lengths[lengths > 0.0, None])
        held_directions = directions[: len(sizes)][sizes > _INDEPENDENT]
        flat = values < _CURVATURE
        # Directions on which no held row depends stay flat, because weight would only stiffen the others.
        dull = int((np.abs(held_directions @ vectors[:, flat]).max(axis=0, initial=0.0) <= _INDEPENDENT).sum())
        if dull < flat.sum():
            for weight in (1.0, 10.0, 100.0):
                curved = hessian + weight * np.abs(values).max() * held_directions.T @ held_directions
                if np.linalg.eigvalsh(curved)[dull] >= _CURVATURE:
                    break
            values, vectors = np.linalg.eigh(curved)
    return np.asarray((vectors * np.clip(np.abs(values), _CURVATURE, 1e8)) @ vectors.T)


def _violation_after_step(limits: Rows, move: Array) -> float:
    """Return the greatest violation after a step, to first order."""
    near = np.isfinite(limits.values)
    return float(np.max(limits.values[near] + limits.gradients[near] @ move, initial=0.0))


def _zero_below_rounding(excess: Array) -> Array:
    return np.maximum(excess - ROUNDING, 0.0)
