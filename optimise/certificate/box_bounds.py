"""Bounds for all designs in a box: whether none is feasible, and lower bounds on the objectives."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ...model.errors import InputError
from ...model.kernel.arithmetic import magnitude
from ...model.kinematics.closed_forms import closed_form_value
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.bar_pieces import BarPeak
from ...objectives.closed_form import ClosedFormQuantity
from ...objectives.cycle_peak import CyclePeak
from ...objectives.force_transmission import TRANSMISSION_ANGLE
from ...objectives.swing_quantity import ClosedFormSwingQuantity, SwingLeast, SwingPeak
from ...objectives.tables.evaluate_quantities import designs_that_can_move
from ..problem.constraint_violation import restated_constraints
from ..problem.requirements import Constraint, Objective, Range
from ..search.candidates import Table
from ..search.evaluation import Evaluator
from .box_conditions import Limits, can_rule_out_boxes, is_swing_form, unbounded_reason
from .enclosed_bar_demands import DemandCurve, demand_curves
from .enclosed_cycle_curve import CycleCurve, machines_with_separate_peaks
from .enclosed_machine import Numbers, parameter_lookup, parameters_over_boxes
from .enclosed_swing import SwingBoxes, SwingCurve, bounds_of_closed_form
from .enclosure import Enclosure, free_unknown, join_parts

Curve = CycleCurve | SwingCurve | DemandCurve
_ROUNDED = 1e-9  # relative error of a closed form near locking is less than this
_SLACK = 1e-6  # relative margin of computed dimensions beyond their bounds; wider than the margin of requirements


@dataclass
class Bounded(Table):
    """Bounds that hold for all designs in each of n boxes.

    alive: whether a design may be feasible; the other fields are meaningless otherwise. lower, upper: (n, k), the part
    of the box that contains all its feasible designs. corner: (n, m), lower bounds on the minimised objectives, -inf
    where unknown. smear: (n, k), effect of the box's width along each axis. trial: (n, k), a point that is feasible if
    the linear part of the enclosure is accurate.
    """

    alive: Mask
    lower: Array
    upper: Array
    corner: Array
    smear: Array
    trial: Array


class Boxes:
    """Computes bounds over boxes in the unit box of one branch. span: (m,), scale of the objectives."""

    def __init__(self, evaluator: Evaluator, span: Array, *, objectives: bool = True) -> None:
        """Prepare the curves; raise `InputError` for an objective that cannot be bounded."""
        problem, self.evaluator = evaluator.problem, evaluator
        self.branch, self.problem, self.span = evaluator.branch, problem, span
        self.objectives = problem.objectives if objectives else ()
        for objective in self.objectives:
            reason = unbounded_reason(problem, objective)
            if reason:
                remedy = "leave this objective out; " if problem.mechanism.lever is None else ""
                raise InputError(
                    f"this job cannot be certified: {reason}; {remedy}the residuals of the front show how close its "
                    "designs are to optimal"
                )
        constraints = restated_constraints(problem)
        least = max((c.lower or 0.0 for c in constraints if c.quantity == TRANSMISSION_ANGLE.name), default=0.0)
        self.mechanism = problem.mechanism
        self.lean = math.cos((1.0 - _SLACK) * least)
        usable = [c for c in constraints if can_rule_out_boxes(problem, c)]
        objective_names = [objective.quantity for objective in self.objectives]
        curves = {name: self._curves_of(name) for name in (*(c.quantity for c in usable), *objective_names)}
        self.costly = sorted((c for c in usable if curves[c.quantity]), key=lambda c: len(curves[c.quantity]))
        self.cheap = [c for c in usable if not curves[c.quantity]]
        names = (*(c.quantity for c in self.costly), *objective_names)
        self.curves = {name: curves[name] for name in names if curves[name]}
        self.swing = None if problem.motion is None else SwingBoxes(self.mechanism, problem.motion, slow=True)

    def _curves_of(self, name: str) -> Sequence[Curve]:
        """Return the curves whose greatest or least value is the quantity; empty for a closed form."""
        quantity = self.problem.quantity(name)
        if isinstance(quantity, CyclePeak):
            machines = machines_with_separate_peaks(self.mechanism, quantity.signal)
            return [CycleCurve(machine, quantity.signal, during=quantity.during) for machine in machines]
        if isinstance(quantity, BarPeak):
            return demand_curves(self.mechanism, quantity)
        if isinstance(quantity, SwingPeak | SwingLeast | ClosedFormSwingQuantity) and not is_swing_form(quantity):
            return [SwingCurve(self.mechanism, quantity)]
        return []

    def bound_boxes(self, lower: Array, upper: Array) -> Bounded:
        """Return the bounds for boxes from lower to upper (n, k)."""
        with np.errstate(all="ignore"):
            n, k = lower.shape
            limits = Limits(n, k)
            numbers = self._machine_parameters(lower, upper, limits)
            r, l, e = (numbers[slot] for slot in range(3))
            limits.require_nonpositive(
                (r + e * self.branch.sign - l) / l if self.swing is None else self.swing.closure_violation(numbers)
            )
            for constraint in self.cheap:
                limits.add_constraint(constraint, *self._closed_form_bounds(constraint.quantity, numbers))
            middle = self.branch.designs_at_points(0.5 * (lower + upper))
            moves = designs_that_can_move(self.mechanism, self.problem.motion, middle)
            curves: dict[str, Enclosure] = {}
            for name, curves_of_quantity in self.curves.items():
                rows = np.flatnonzero(limits.alive)  # constraints before this one may have ruled out boxes
                part = {slot: _select_boxes(value, rows) for slot, value in numbers.items()}
                enclosed = _enclose_curves(curves_of_quantity, part, middle[rows], moves[rows])
                curves[name] = _scatter_boxes(enclosed, rows, n)
                for constraint in self.costly:
                    if constraint.quantity == name:
                        side = "lower" if curves_of_quantity[0].least else "upper"
                        held = Constraint(quantity=name, **{side: getattr(constraint, side)})
                        limits.add_curve_constraint(held, curves[name])
            low, high = limits.contracted_ranges()
            corner, smear = np.zeros((n, len(self.objectives))), 0.0 * lower
            for column, objective in enumerate(self.objectives):
                name = objective.quantity
                if name in curves:
                    value = curves[name]
                    corner[:, column] = _curve_bound(value, low, high, least=self.curves[name][0].least)
                else:
                    value, known_least, known_greatest = self._closed_form_bounds(name, numbers)
                    lowest, highest = (end.max(axis=1) for end in value.least_and_greatest(low, high))
                    lowest = lowest if known_least is None else np.maximum(lowest, known_least)
                    highest = highest if known_greatest is None else np.minimum(highest, known_greatest)
                    corner[:, column] = _minimised_bound(objective, lowest, highest)
                wide = np.abs(value.slopes).max(axis=2) * (high - low) / self.span[column]
                smear = np.fmax(smear, wide.T)
            centre, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
            trial = limits.trial_points(low, high)
            smear = np.fmax(smear, limits.width_effects(low, high))
            return Bounded(
                limits.alive,
                np.clip(centre + half * low.T, lower, upper),
                np.clip(centre + half * high.T, lower, upper),
                corner,
                smear,
                np.clip(centre + half * trial.T, lower, upper),
            )

    def _machine_parameters(self, lower: Array, upper: Array, limits: Limits) -> Numbers:
        """Return the machine parameters that designs set, (n, 1); confine computed dimensions to their bounds."""
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
            unknowns[name] = free_unknown(first, last, column, k)
        for step in branch.steps:
            sources = [unknowns[name] for name in step.sources]
            computed = step.formula(*sources) if sources else everywhere(float(step.formula()))
            bounds = branch.bounds[step.target]
            scale = max(bounds.upper, 1e-300)
            limits.require_nonpositive((computed - bounds.upper) * (1.0 / scale))
            limits.require_nonpositive((bounds.lower - computed) * (1.0 / scale))
            turning = self.swing is None
            ends = _ends_of_computed_dimension(step.target, unknowns if turning else {}, bounds, self.lean, n)
            unknowns[step.target] = computed.confine_to(*ends)
        unknowns["offset"] = unknowns["offset"] * branch.sign
        return parameters_over_boxes(self.mechanism, [unknowns[name] for name in branch.names])

    def _closed_form_bounds(self, name: str, numbers: Numbers) -> tuple[Enclosure, Array | None, Array | None]:
        """Return the closed forms of a quantity (n, forms), and further lower and upper bounds."""
        quantity = self.problem.quantity(name)
        if is_swing_form(quantity):
            return bounds_of_closed_form(self.mechanism, quantity, numbers), None, None
        r, l, e = (numbers[slot] for slot in range(3))
        number = parameter_lookup(self.mechanism, numbers)
        forms = [formula(number) for formula in quantity.formulas(self.mechanism)]
        value = reduce(join_parts, [form if isinstance(form, Enclosure) else 0.0 * r + form for form in forms])
        greatest = value.least_and_greatest()[1].max(axis=1)
        if not isinstance(quantity, ClosedFormQuantity) or quantity.rises is None:
            return value, None, greatest
        ends = [x.least_and_greatest() for x in (r, l, magnitude(e))]
        least_at, most_at = [
            [np.maximum(pair[rises != upper], 0.0)[:, 0] for pair, rises in zip(ends, quantity.rises, strict=True)]
            for upper in (True, False)
        ]
        # NaN for designs that do not rotate fully
        least, highest = [
            np.where(l > r + a, closed_form_value(int(quantity.forms[0]), r, l, a), np.nan)
            for r, l, a in (least_at, most_at)
        ]
        least, highest = least - _ROUNDED * np.abs(least), highest + _ROUNDED * np.abs(highest)
        return value, np.where(np.isnan(least), -np.inf, least), np.fmin(greatest, highest)


def _curve_bound(value: Enclosure, low: Array, high: Array, *, least: bool) -> Array:
    """Return a lower bound on minimised peaks or, with `least`, on negated least values."""
    lowest, highest = value.least_and_greatest(low, high)
    return np.asarray(-highest.min(axis=1) if least else lowest.max(axis=1))


def _enclose_curves(curves: Sequence[Curve], part: Numbers, middle: Array, moves: Mask) -> Enclosure:
    """Return a quantity's curves side by side; their greatest or least value bounds that of the quantity.

    Each is enclosed at the peak of the middle design, or at an arbitrary position if the middle design cannot move.
    """
    enclosures = []
    for curve in curves:
        positions = np.tile(curve.default_position, (len(middle), 1))
        if moves.any():
            positions[moves] = curve.peak_positions(middle[moves])
        enclosures.append(curve.enclose(part, positions, middle))
    return reduce(join_parts, enclosures)


def _ends_of_computed_dimension(
    name: str, unknowns: dict[str, Enclosure], bounds: Range, lean: float, n: int
) -> tuple[Array, Array]:
    """Return lower and upper end (n, 1) of a computed dimension. They follow from its bounds and r + |e| <= lean l."""
    ends = [
        unknowns[dimension].least_and_greatest()
        for dimension in DIMENSIONS
        if dimension != name and dimension in unknowns
    ]
    slack = _SLACK * bounds.upper
    low, high = np.full((n, 1), bounds.lower - slack), np.full((n, 1), bounds.upper + slack)
    if len(ends) < 2:
        return low, high
    (first_low, two), (three, four) = ends  # in the order crank, rod, offset, without the computed dimension
    if name == "rod":
        return np.maximum(low, (first_low + three) / lean), high
    return low, np.minimum(high, lean * four - first_low if name == "offset" else lean * two - three)


def _minimised_bound(objective: Objective, lowest: Array, highest: Array) -> Array:
    """Return a lower bound on a minimised objective, from the ends of its value."""
    if objective.sense == "maximise":
        return -highest
    if objective.target is not None:
        return np.maximum(np.maximum(lowest - objective.target, objective.target - highest), 0.0)
    return lowest


def _select_boxes(value: Enclosure, rows: IntArray) -> Enclosure:
    empty = None if value.empty is None else value.empty[rows]
    return Enclosure(value.centre[rows], value.slopes[:, rows], value.rest[rows], empty)


def _scatter_boxes(value: Enclosure, rows: IntArray, n: int) -> Enclosure:
    """Return an enclosure of n boxes that is unknown outside `rows`."""
    parts = value.centre.shape[1]
    centre, slopes = np.zeros((n, parts)), np.zeros((len(value.slopes), n, parts))
    rest = np.full((n, parts), np.nan)
    centre[rows], slopes[:, rows], rest[rows] = value.centre, value.slopes, value.rest
    return Enclosure(centre, slopes, rest)
