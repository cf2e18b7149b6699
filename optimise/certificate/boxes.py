"""Bounds on all designs of a box at once: proof that none is feasible, and lower bounds on the objectives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ...model.errors import InputError
from ...model.kernel.arithmetic import magnitude
from ...model.kinematics.closed_forms import closed_form
from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.mechanism import Mechanism
from ...model.machine.members import is_shaft
from ...model.machine.raw import Raw, raw_vector
from ...model.machine.two_turns import cycle_turns, halves
from ...model.signals.shaft_statistics import equivalent_single_cranks
from ...model.signals.signals import Signal
from ...objectives.closed_form import ClosedFormQuantity
from ...objectives.cycle_peak import CyclePeak
from ...objectives.transmission_angle import TRANSMISSION_ANGLE
from ..problem.problem import Problem
from ..problem.requirements import Constraint, Objective, Range
from ..problem.violation import restated_constraints
from ..search.candidates import Table
from ..search.evaluation import Evaluator
from .cycle import Curve, best_angles
from .enclosure import Enclosure, coordinate, side_by_side
from .limits import Limits

_ROUNDED = 1e-9  # relative: more than a closed form may be off where a linkage is close to locking
_SLACK = 1e-6  # relative, by how much computed dimensions may miss their range here: more than requirements may


def unbounded_reason(problem: Problem, objective: Objective) -> str:
    """Return why an objective cannot be bounded over a box; empty if it can.

    Bounded are quantities with `formulas`, and from below the peaks over the cycle of machines without friction; of
    several cylinders those of one alone, and with a speed profile those that do not depend on the speed. A time ratio
    along a speed profile has no formula.
    """
    quantity = problem.quantity(objective.quantity)
    if quantity.formulas(problem.mechanism):
        return ""
    if not isinstance(quantity, CyclePeak):
        profile = " along a speed profile" if isinstance(quantity, ClosedFormQuantity) else ""
        return f"{quantity.title}{profile} has no bound over a range of designs"
    if quantity.signal.needs_forces and problem.mechanism.friction.acts:
        return f"{quantity.title} has no bound over a range of designs with friction"
    if not cranks_of(problem.mechanism, quantity.signal):
        shaft = "with a speed profile" if problem.mechanism.speed_profile is not None else "with several cylinders"
        return f"{quantity.title} {shaft} has no bound over a range of designs"
    if objective.sense != "minimise":
        return f"{quantity.title} only has a lower bound, so it can only be certified if it is minimised"
    return ""


def cranks_of(mechanism: Mechanism, signal: Signal) -> tuple[Mechanism, ...]:
    """Return single-crank machines at constant speed whose highest peak of a signal is that of the machine.

    None if there are no such machines. Each turn of a two-turn cycle is a machine of its own.
    """
    single = equivalent_single_cranks(mechanism, signal) if is_shaft(mechanism) else (mechanism,)
    if not signal.needs_forces:
        return single
    return tuple(half for machine in single for half in (halves(machine) if cycle_turns(machine) > 1 else (machine,)))


def is_usable(problem: Problem, constraint: Constraint) -> bool:
    """Whether a constraint helps to rule out boxes; one that does not still holds for every design that is counted."""
    quantity = problem.quantity(constraint.quantity)
    if quantity.formulas(problem.mechanism):
        return True
    objective = Objective(quantity=constraint.quantity, sense="minimise")
    return constraint.upper is not None and not unbounded_reason(problem, objective)


@dataclass
class Bounded(Table):
    """Bounds that hold for the designs of n boxes.

    alive: whether one may be feasible; what follows means nothing where not. lower, upper: (n, k), the part of the box
    that holds all feasible ones. corner: (n, m), what no feasible one's minimised objectives are below, -inf where
    nothing is known. smear: (n, k), what the width along each axis matters. trial: (n, k), a point that is feasible if
    the box's linear part does not deceive.
    """

    alive: Mask
    lower: Array
    upper: Array
    corner: Array
    smear: Array
    trial: Array


class Boxes:
    """Bounds boxes of the unit box of one branch. span: (m,), by which objectives are compared."""

    def __init__(self, evaluator: Evaluator, span: Array, *, objectives: bool = True) -> None:
        """Prepare the curves; raise `InputError` for an objective that cannot be bounded."""
        problem, self.evaluator = evaluator.problem, evaluator
        self.branch, self.problem, self.span = evaluator.branch, problem, span
        self.objectives = problem.objectives if objectives else ()
        for objective in self.objectives:
            reason = unbounded_reason(problem, objective)
            if reason:
                raise InputError(
                    f"this job cannot be certified: {reason}; leave this objective out; the residuals of the front "
                    "show how close its designs are to optimal"
                )
        constraints = restated_constraints(problem)
        least = max(c.lower or 0.0 for c in constraints if c.quantity == TRANSMISSION_ANGLE.name)
        self.raw = raw_vector(problem.mechanism)
        self.lean = math.cos((1.0 - _SLACK) * least)
        usable = [c for c in constraints if is_usable(problem, c)]
        self.cheap = [c for c in usable if problem.quantity(c.quantity).formulas(problem.mechanism)]
        self.costly = [c for c in usable if c not in self.cheap]
        names = [item.quantity for item in self.costly] + [item.quantity for item in self.objectives]
        peaks = [problem.quantity(name) for name in names]
        self.curves = {
            peak.name: [Curve(machine, peak) for machine in cranks_of(problem.mechanism, peak.signal)]
            for peak in peaks
            if isinstance(peak, CyclePeak)
        }

    def bound(self, lower: Array, upper: Array) -> Bounded:
        """Return the bounds that hold for boxes lower to upper (n, k)."""
        with np.errstate(all="ignore"):
            n, k = lower.shape
            limits = Limits(n, k)
            r, l, e = self._dimensions(lower, upper, limits)
            limits.add((r + e * self.branch.sign - l) / l)
            for constraint in self.cheap:
                limits.hold(constraint, *self._closed(constraint.quantity, r, l, e))
            rows = np.flatnonzero(limits.alive)
            middle, angles = self._angles(rows, lower, upper)
            part = [_select_boxes(x, rows) for x in (r, l, e)]
            curves = {
                name: _scatter_boxes(_enclose_curves(curves_of_peak, part, angles[name], middle), rows, n)
                for name, curves_of_peak in self.curves.items()
            }
            for constraint in self.costly:
                curve = curves[constraint.quantity]
                limits.hold(Constraint(quantity=constraint.quantity, upper=constraint.upper), curve, None, None)
            low, high = limits.contracted()
            corner, smear = np.zeros((n, len(self.objectives))), 0.0 * lower
            for column, objective in enumerate(self.objectives):
                if objective.quantity in curves:
                    enclosed: tuple[Enclosure, Array | None, Array | None] = (
                        curves[objective.quantity],
                        np.zeros(n),
                        None,
                    )
                else:
                    enclosed = self._closed(objective.quantity, r, l, e)
                value, least, greatest = enclosed
                lowest, highest = (end.max(axis=1) for end in value.ends(low, high))
                lowest = lowest if least is None else np.maximum(lowest, least)
                highest = highest if greatest is None else np.minimum(highest, greatest)
                corner[:, column] = _minimised_bound(objective, lowest, highest)
                wide = np.abs(value.slopes).max(axis=2) * (high - low) / self.span[column]
                smear = np.fmax(smear, wide.T)
            centre, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
            trial = limits.feasible_points(low, high)
            smear = np.fmax(smear, limits.smear(low, high))
            return Bounded(
                limits.alive,
                np.clip(centre + half * low.T, lower, upper),
                np.clip(centre + half * high.T, lower, upper),
                corner,
                smear,
                np.clip(centre + half * trial.T, lower, upper),
            )

    def _dimensions(self, lower: Array, upper: Array, limits: Limits) -> tuple[Enclosure, Enclosure, Enclosure]:
        """Return crank, rod and offset, (n, 1); those that are computed are held to their ranges."""
        n, k = lower.shape
        branch = self.branch

        def everywhere(value: float) -> Enclosure:
            return Enclosure(np.full((n, 1), value), np.zeros((k, n, 1)), np.zeros((n, 1)))

        unknowns = {name: everywhere(bounds.lower) for name, bounds in branch.bounds.items() if bounds.fixed}
        for column, name in enumerate(branch.free):
            first, last = [
                branch.lower[column] * (1.0 - u[:, column]) + branch.upper[column] * u[:, column]
                for u in (lower, upper)
            ]
            unknowns[name] = coordinate(first, last, column, k)
        for step in branch.steps:
            sources = [unknowns[name] for name in step.sources]
            computed = step.formula(*sources) if sources else everywhere(float(step.formula()))
            bounds = branch.bounds[step.target]
            scale = max(bounds.upper, 1e-300)
            limits.add((computed - bounds.upper) * (1.0 / scale))
            limits.add((bounds.lower - computed) * (1.0 / scale))
            unknowns[step.target] = computed.confined(*_computed_ends(step.target, unknowns, bounds, self.lean, n))
        return unknowns["crank"], unknowns["rod"], unknowns["offset"] * branch.sign

    def _closed(
        self, name: str, r: Enclosure, l: Enclosure, e: Enclosure
    ) -> tuple[Enclosure, Array | None, Array | None]:
        """Return the forms of a quantity (n, forms), and what is known of it beside them: from below and above."""
        quantity = self.problem.quantity(name)
        slots: dict[int, Enclosure] = {Raw.CRANK: r, Raw.ROD: l, Raw.OFFSET: e}

        def number(slot: int) -> Any:
            return slots[slot] if slot in slots else float(self.raw[slot])

        forms = [formula(number) for formula in quantity.formulas(self.problem.mechanism)]
        value = reduce(side_by_side, [form if isinstance(form, Enclosure) else 0.0 * r + form for form in forms])
        greatest = value.ends()[1].max(axis=1)
        if not isinstance(quantity, ClosedFormQuantity) or quantity.rises is None:
            return value, None, greatest
        ends = [x.ends() for x in (r, l, magnitude(e))]
        least_at, most_at = [
            [np.maximum(pair[rises != upper], 0.0)[:, 0] for pair, rises in zip(ends, quantity.rises, strict=True)]
            for upper in (True, False)
        ]
        least, highest = [
            np.where(
                l > r + a, closed_form(int(quantity.forms[0]), r, l, a), np.nan
            )  # of those that rotate fully fully
            for r, l, a in (least_at, most_at)
        ]
        least, highest = least - _ROUNDED * np.abs(least), highest + _ROUNDED * np.abs(highest)
        return value, np.where(np.isnan(least), -np.inf, least), np.fmin(greatest, highest)

    def _angles(self, rows: IntArray, lower: Array, upper: Array) -> tuple[Array, dict[str, list[Array]]]:
        """Return the middle designs of some boxes and the angles of their peaks; any where the middle does not turn.

        The angles are those of each curve of a quantity.
        """
        middle = self.branch.dimensions(0.5 * (lower[rows] + upper[rows]))
        turns = (middle[:, 0] > 0.0) & (middle[:, 1] > middle[:, 0] + np.abs(middle[:, 2]))
        angles_by_name = {}
        for name, curves in self.curves.items():
            angles_by_name[name] = [np.full(len(rows), 0.5 * np.pi) for _ in curves]
            for angles, curve in zip(angles_by_name[name], curves, strict=True):
                if turns.any():
                    angles[turns] = best_angles(curve.peak, curve.mechanism, middle[turns])
        return middle, angles_by_name


def _enclose_curves(curves: list[Curve], part: list[Enclosure], angles: list[Array], middle: Array) -> Enclosure:
    """Return the curves of a quantity side by side, of which the greatest bounds its peak."""
    enclosures = [curve.enclose(part, at, middle) for curve, at in zip(curves, angles, strict=True)]
    return reduce(side_by_side, enclosures)


def _computed_ends(
    name: str, unknowns: dict[str, Enclosure], bounds: Range, lean: float, n: int
) -> tuple[Array, Array]:
    """Return the ends (n, 1) of a computed dimension from its range and r + |e| <= lean l."""
    ends = [unknowns[dimension].ends() for dimension in DIMENSIONS if dimension != name and dimension in unknowns]
    slack = _SLACK * bounds.upper
    low, high = np.full((n, 1), bounds.lower - slack), np.full((n, 1), bounds.upper + slack)
    if len(ends) < 2:
        return low, high
    (first_low, two), (three, four) = ends  # in the order crank, rod, offset
    if name == "rod":
        return np.maximum(low, (first_low + three) / lean), high
    return low, np.minimum(high, lean * four - first_low if name == "offset" else lean * two - three)


def _minimised_bound(objective: Objective, lowest: Array, highest: Array) -> Array:
    """Return a lower bound on an objective as it is minimised, from the ends of its value."""
    if objective.sense == "maximise":
        return -highest
    if objective.target is not None:
        return np.maximum(np.maximum(lowest - objective.target, objective.target - highest), 0.0)
    return lowest


def _select_boxes(value: Enclosure, rows: IntArray) -> Enclosure:
    empty = None if value.empty is None else value.empty[rows]
    return Enclosure(value.centre[rows], value.slopes[:, rows], value.rest[rows], empty)


def _scatter_boxes(value: Enclosure, rows: IntArray, n: int) -> Enclosure:
    """Return an enclosure of n boxes that says nothing of those not in `rows`."""
    parts = value.centre.shape[1]
    centre, slopes = np.zeros((n, parts)), np.zeros((len(value.slopes), n, parts))
    rest = np.full((n, parts), np.nan)
    centre[rows], slopes[:, rows], rest[rows] = value.centre, value.slopes, value.rest
    return Enclosure(centre, slopes, rest)
