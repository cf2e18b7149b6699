"""Objectives and constraints of a problem as functions of the free unknowns: fast for many designs, exact for few."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ...model.arrays import IntArray, Mask
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.quantity import Array, Pieces, Quantity
from ...objectives.tables.evaluate_quantities import can_run_despite_friction
from ..engine.engine import Chunked, Engine, Serial, Shared
from ..problem.constraint_violation import (
    FEASIBLE,
    Side,
    closed_sides,
    constraints_with_floors,
    minimised_values,
    needs_computed_cycle,
    relative_violation,
    scaled_excess,
)
from ..problem.problem import Problem
from ..problem.requirements import Constraint, Objective, Range
from ..problem.restatement import restate_constraint
from .batch_quantities import evaluate_pieces, join_batches, screen_quantities
from .checkpoints import Arrays, Checkpoints, Numbers
from .elimination import EliminationBranch
from .piece_rows import Rows

_HUGE = 1e100
_CLEARANCE = 1e-9
"""Distance, SI, of a bound from an excluded end of the domain."""


class Evaluator:
    """Evaluates one branch of a problem.

    engine: engine for expensive batches; it does not affect the results.
    """

    def __init__(
        self,
        problem: Problem,
        branch: EliminationBranch,
        checkpoints: Checkpoints | None = None,
        engine: Engine | None = None,
    ) -> None:
        """Prepare the constraints that remain on the branch, cheapest first.

        checkpoints: checkpoints of the calling search. Every evaluation raises `Cancelled` when the search must end.
        """
        self.checkpoints = checkpoints or Checkpoints()
        self.engine = engine or Serial()
        problem = problem.part(branch.variant)
        self.problem = problem
        self._quantities: dict[str, Quantity] = {}
        self.branch = branch
        self.mechanism = problem.mechanism
        self.dimension = len(branch.free)
        remaining = [
            self._move_off_excluded_end(restate_constraint(problem, c))
            for c in constraints_with_floors(problem)
            if c.quantity not in branch.eliminated
        ]
        self.eliminated = tuple(
            restate_constraint(problem, c) for c in problem.constraints if c.quantity in branch.eliminated
        )
        self.constraints = tuple(sorted(remaining, key=lambda c: needs_computed_cycle(problem.quantity(c.quantity))))
        self.computed = tuple(name for name in DIMENSIONS if any(step.target == name for step in branch.steps))
        constant = [problem.quantity(objective.quantity).is_constant for objective in problem.objectives]
        self.constant = () if all(constant) else tuple(np.flatnonzero(constant).tolist())
        self.loose = any(c.equality for c in self.constraints)
        self.evaluations = 0
        self.chunked = Chunked(Shared(self), self.engine, self.checkpoints.poll)

    def __reduce__(self) -> tuple[type[Evaluator], tuple[Problem, EliminationBranch]]:
        return Evaluator, (self.problem, self.branch)

    def quantity(self, name: str) -> Quantity:
        """Return the quantity of a given name, looked up in the problem once."""
        quantity = self._quantities.get(name)
        if quantity is None:
            quantity = self._quantities[name] = self.problem.quantity(name)
        return quantity

    def _move_off_excluded_end(self, constraint: Constraint) -> Constraint:
        """Return a constraint with its lower bound moved off an excluded end of the domain, where the linkage locks."""
        domain = self.quantity(constraint.quantity).domain
        if domain is None or domain.idle or not domain.open or constraint.lower != domain.lower:
            return constraint
        return replace(constraint, lower=domain.lower + _CLEARANCE)

    def recorded_step(self, kind: str, inputs: Sequence[Numbers], compute: Callable[[], Arrays]) -> Arrays:
        """Return the result of a recorded step; see `Checkpoints.recorded_step`."""
        return self.checkpoints.recorded_step(kind, inputs, compute, self)

    # ---- quick: for sorting thousands of designs ------------------------------------------------------------------

    def screen_designs_objectives_violation(self, u: Array, *, band: float = 0.0) -> tuple[Array, Array, Array]:
        """Return designs (n, 3 + v), minimised objectives (n, m) and violation (n,) for points in the unit box.

        The violation is the greatest relative one, infinite where no linkage rotates fully; designs that violate a
        constraint by more than `band` have NaN objectives. Peaks are screened (see
        `model.signals.fast_torque_and_error`).
        """
        dimensions = self.branch.designs_at_points(u)
        rows, values, violation = self.recorded_step(
            "screening", (u, np.array([band])), lambda: self._screen_designs(dimensions, band)
        )
        objectives = np.full((len(u), len(self.problem.objectives)), np.nan)
        objectives[rows] = values
        return dimensions, objectives, violation

    def _screen_designs(self, dimensions: Array, band: float) -> tuple[IntArray, Array, Array]:
        """Return the rows (r,) of designs with objectives, their objectives (r, m), and the violation (n,) of all."""
        self.checkpoints.poll()
        violation = self._geometry_violation(dimensions)
        self.evaluations += len(dimensions)
        # Designs already out of reach need no cycle.
        for slow in (False, True):
            constraints = [c for c in self.constraints if needs_computed_cycle(self.quantity(c.quantity)) == slow]
            rows = np.flatnonzero(violation <= band + FEASIBLE if slow else np.isfinite(violation))
            if constraints and len(rows):
                values_by_quantity = self._screened_values(
                    [constraint.quantity for constraint in constraints], dimensions[rows]
                )
                for constraint, values in zip(constraints, values_by_quantity, strict=True):
                    violation[rows] = np.maximum(violation[rows], relative_violation(constraint, values))
        rows = np.flatnonzero(violation <= band + FEASIBLE)
        objectives = np.zeros((len(rows), len(self.problem.objectives)))
        if len(rows):
            values_by_quantity = self._screened_values(
                [objective.quantity for objective in self.problem.objectives], dimensions[rows]
            )
            for column, (objective, values) in enumerate(zip(self.problem.objectives, values_by_quantity, strict=True)):
                objectives[:, column] = minimised_values(objective, values)
        has_objectives = np.isfinite(objectives).all(axis=1)
        violation[rows[~has_objectives]] = np.inf
        return rows[has_objectives], objectives[has_objectives], violation

    def _screened_values(self, names: list[str], dimensions: Array) -> list[Array]:
        parts: list[list[Array]] = self.chunked(screen_quantities, tuple(names), dimensions)
        return (
            [np.concatenate(chunk_values) for chunk_values in zip(*parts, strict=True)] if len(parts) > 1 else parts[0]
        )

    def _geometry_violation(self, dimensions: Array) -> Array:
        """Greatest relative violation of the computed dimensions' ranges.

        Infinite if the required motion is impossible.

        Required motion: the linkage rotates fully, or makes the problem's swing, and friction does not lock it.
        """
        violation = np.zeros(len(dimensions))
        turns = can_run_despite_friction(self.mechanism, self.problem.motion, dimensions)
        violation[~turns] = np.inf
        for name in self.computed:
            # A linear rule may give an offset of the other sign, which belongs to the other branch.
            value = dimensions[:, DIMENSIONS.index(name)] * (self.branch.sign if name == "offset" else 1.0)
            for side in _range_sides(self.branch.bounds[name]):
                violation = np.fmax(violation, scaled_excess(value, *side))
        rows = np.flatnonzero(turns)
        for constraint in self.eliminated if len(rows) else ():
            values = self.quantity(constraint.quantity).evaluate(self.mechanism, dimensions[rows]).values
            spurious = relative_violation(constraint, values) > FEASIBLE
            violation[rows[spurious]] = np.inf
        return violation

    # ---- exact: for the polish and the proof ---------------------------------------------------------------------

    def can_evaluate(self, u: Array) -> Mask:
        """Return which points give a linkage that rotates fully, or makes the problem's swing."""
        return np.isfinite(self._geometry_violation(self.branch.designs_at_points(u)))

    def violation_without_cycle(self, u: Array) -> Array:
        """Return the greatest violation (n,) of requirements that need no cycle, where `can_evaluate` holds."""
        dimensions = self.branch.designs_at_points(u)
        violation = self._geometry_violation(dimensions)
        for constraint in self.constraints:
            quantity = self.quantity(constraint.quantity)
            if not needs_computed_cycle(quantity):
                values = quantity.evaluate(self.mechanism, dimensions).values
                violation = np.maximum(violation, relative_violation(constraint, values))
        return violation

    def objective_and_constraint_rows(self, u: Array, *, goals: bool = True) -> tuple[Rows, Rows]:
        """Return objective rows, empty unless requested, and constraint rows for points where `can_evaluate` holds.

        Gradients are with respect to the coordinates of the unit box.
        """
        self.checkpoints.poll()
        dimensions = self.branch.designs_at_points(u)
        jacobian = self.branch.jacobian(u)
        self.evaluations += len(u)
        objectives = self.problem.objectives if goals else ()
        objective_names = [objective.quantity for objective in objectives]
        names = tuple(dict.fromkeys([*objective_names, *(constraint.quantity for constraint in self.constraints)]))
        evaluated = join_batches(self.chunked(evaluate_pieces, names, dimensions))
        pieces = {
            name: _to_unit_box(quantity_pieces, jacobian)
            for name, quantity_pieces in zip(names, evaluated, strict=True)
        }
        parts: list[tuple[int, Pieces]] = []
        for index, objective in enumerate(objectives):
            parts += [(index, part) for part in _objective_rows(objective, pieces[objective.quantity])]
        aims = replace(_stack_rows(parts, len(u), self.dimension), constant=self.constant)
        parts = []
        for index, constraint in enumerate(self.constraints):
            quantity_pieces = pieces[constraint.quantity]
            parts += [
                (index, _excess_pieces(_deciding_pieces(quantity_pieces, side[0]), *side))
                for side in closed_sides(constraint)
            ]
        for index, name in enumerate(self.computed, len(self.constraints)):
            column = DIMENSIONS.index(name)
            sign = self.branch.sign if name == "offset" else 1.0
            value = sign * dimensions[:, column : column + 1]
            quantity_pieces = Pieces(value, sign * jacobian[:, column : column + 1, :], np.zeros_like(value))
            parts += [
                (index, _excess_pieces(quantity_pieces, *side)) for side in _range_sides(self.branch.bounds[name])
            ]
        return aims, _stack_rows(parts, len(u), self.dimension)


def _to_unit_box(pieces: Pieces, jacobian: Array) -> Pieces:
    """Return the pieces for designs with gradients by the unit-box coordinates.

    Jacobian: (n, 3 + v, k), that of the designs.
    """
    opposite = None if pieces.opposite is None else _to_unit_box(pieces.opposite, jacobian)
    heights, sizes = np.abs(pieces.values), np.abs(pieces.gradients)
    # Most are bounded. Products with a copy in another memory order would round differently.
    if heights.max(initial=0.0) < _HUGE and sizes.max(initial=0.0) < _HUGE and pieces.gradients.flags.c_contiguous:
        slopes = np.einsum("npd,ndk->npk", pieces.gradients, jacobian)
        return Pieces(pieces.values, slopes, pieces.labels, pieces.least, opposite)
    # Rod to offset grows without bound: avoid numbers that overflow in a product, and slopes where it is infinite.
    bounded = (heights < _HUGE) & (sizes < _HUGE).all(axis=2)
    # NaN stays NaN, whatever its sign: `_stack_rows` treats it as a violation, not an optimum.
    values = np.where(bounded | np.isnan(pieces.values), pieces.values, np.copysign(np.inf, pieces.values))
    slopes = np.einsum("npd,ndk->npk", np.where(bounded[:, :, None], pieces.gradients, 0.0), jacobian)
    return Pieces(values, slopes, pieces.labels, pieces.least, opposite)


def _range_sides(bounds: Range) -> list[Side]:
    scale = max(bounds.upper, 1e-300)
    return [(1.0, bounds.upper, scale), (-1.0, bounds.lower, scale)]


def _objective_rows(objective: Objective, pieces: Pieces) -> list[Pieces]:
    low = _deciding_pieces(pieces, 1.0)
    if objective.sense == "minimise":
        return [low]
    top = _deciding_pieces(pieces, -1.0)
    if objective.target is None:
        # An infinite value is out of reach, not an optimum; in the least of pieces, infinite ones are absent.
        is_finite = np.isfinite(top.values)
        absent = top.least & (top.values == np.inf) & is_finite.any(axis=1, keepdims=True)
        return [Pieces(np.where(is_finite | absent, -top.values, np.inf), -top.gradients, top.labels)]
    return [_excess_pieces(low, 1.0, objective.target), _excess_pieces(top, -1.0, objective.target)]


def _excess_pieces(pieces: Pieces, side: float, bound: float, scale: float = 1.0) -> Pieces:
    """Return the relative excess of pieces over one side of a requirement."""
    return Pieces(scaled_excess(pieces.values, side, bound, scale), side * pieces.gradients / scale, pieces.labels)


def _deciding_pieces(pieces: Pieces, side: float) -> Pieces:
    """Return the pieces that must stay low (side 1) or high (-1) for the quantity to do so.

    A minimum of pieces stays low by its lowest piece alone, a maximum stays high by its highest: the other pieces are
    inactive there. A quantity with kinks of both kinds has pieces for either side. Peaks come highest first, closed
    forms in any order.
    """
    if pieces.opposite is not None and pieces.least == (side > 0.0):
        return pieces.opposite
    if pieces.least == (side < 0.0) or pieces.values.shape[1] == 1:
        return pieces
    first = (np.argmin if pieces.least else np.argmax)(pieces.values, axis=1)
    rows, column = np.arange(len(first))[:, None], first[:, None]
    return Pieces(pieces.values[rows, column], pieces.gradients[rows, column], pieces.labels[rows, column])


def _stack_rows(parts: list[tuple[int, Pieces]], n: int, k: int) -> Rows:
    if not parts:
        return Rows.without_rows(n, k)
    values = np.concatenate([part.values for _, part in parts], axis=1)
    return Rows(
        np.where(np.isnan(values), np.inf, values),
        np.concatenate([part.gradients for _, part in parts], axis=1),
        np.concatenate([part.labels for _, part in parts], axis=1),
        np.concatenate([np.full(part.values.shape[1], index) for index, part in parts]),
    )
