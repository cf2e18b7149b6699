"""Constraints of a problem with their floors, and violations by designs."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...model.arrays import Array, Mask
from ...model.cycle.gas_work import compressor_may_deliver_nothing
from ...objectives.flow import VOLUMETRIC_EFFICIENCY
from ...objectives.force_transmission import SELF_LOCKING_MARGIN, TRANSMISSION_ANGLE
from ...objectives.lengths_and_time_ratio import TIME_RATIO
from ...objectives.lever_drive import BUCKLING_MARGIN, PRESSURE_MARGIN
from ...objectives.lever_geometry import CYLINDER_LENGTH_MARGIN, LEVER_TRANSMISSION_ANGLE
from ...objectives.lever_turn import ARM_TRANSMISSION_ANGLE
from ...objectives.quantity import Quantity
from ...objectives.robust.quantity import RobustQuantity
from ...objectives.stroke_times import STROKE_TIME_RATIOS
from ...objectives.swing_quantities import SWING_TRANSMISSION_ANGLE
from .problem import Problem
from .requirements import Constraint, Objective, merge_constraints
from .restatement import restate_constraint

FEASIBLE = 1e-9
"""Relative violation of a constraint that counts as rounding."""
_FLOORS_OF_LEVER = (
    LEVER_TRANSMISSION_ANGLE,
    ARM_TRANSMISSION_ANGLE,
    CYLINDER_LENGTH_MARGIN,
    PRESSURE_MARGIN,
    BUCKLING_MARGIN,
)
Side = tuple[float, float, float]
"""One side of a requirement: 1 for an upper or -1 for a lower bound, the bound, and the scale of an excess."""


def constraints_with_floors(problem: Problem) -> tuple[Constraint, ...]:
    """Return a problem's constraints, with default floors where none is set.

    Floors apply to the transmission angle; with friction, also to the self-locking margin; if a compressor may deliver
    nothing, also to the volumetric efficiency. For a required slow stroke, a floor applies to the time ratio or, with a
    speed profile, to that stroke's ratio. A swing has only one, on its transmission angle, as the margin from dead
    points. A lever has further ones as far as its cylinder is known: it must be long, strong and stiff enough.
    """
    if problem.mechanism.lever is not None:
        return _with_floors_of_lever(problem, problem.constraints)
    if problem.motion is not None:
        return _with_floor(problem, problem.constraints, SWING_TRANSMISSION_ANGLE)
    constraints = _with_floor(problem, problem.constraints, TRANSMISSION_ANGLE)
    if problem.mechanism.with_largest_variables.friction.acts:
        constraints = _with_floor(problem, constraints, SELF_LOCKING_MARGIN)
    if compressor_may_deliver_nothing(problem.mechanism):
        constraints = _with_floor(problem, constraints, VOLUMETRIC_EFFICIENCY)
    if problem.slow_stroke is not None:
        constraints = _with_slow_stroke(problem, constraints)
    return constraints


def _with_floors_of_lever(problem: Problem, constraints: tuple[Constraint, ...]) -> tuple[Constraint, ...]:
    """Return constraints with the floors of a lever, as far as its cylinder is known."""
    for quantity in _FLOORS_OF_LEVER:
        fits = problem.motion is None or quantity.unfit_swing_reason(problem.motion) is None
        if fits and not quantity.undefined_because([problem.mechanism]):
            constraints = _with_floor(problem, constraints, quantity)
    return constraints


def _with_slow_stroke(problem: Problem, constraints: tuple[Constraint, ...]) -> tuple[Constraint, ...]:
    """Return constraints with a time ratio above 1; with a speed profile, the ratio of the required slow stroke."""
    found = _with_floor(problem, constraints, TIME_RATIO, above=1.0)
    if problem.mechanism.speed_profile is None:
        return found
    restated = (restate_constraint(problem, item) for item in found)
    least = max(c.lower for c in restated if c.quantity == TIME_RATIO.name and c.lower is not None)
    assert problem.slow_stroke is not None
    name = STROKE_TIME_RATIOS[problem.slow_stroke].name
    upper = next((c.upper for c in constraints if c.quantity == name and c.upper is not None), None)
    if upper is not None:
        least = min(least, 1.0 + 0.5 * (upper - 1.0))
    return merge_constraints((*constraints, Constraint(quantity=name, lower=least)))


def restated_constraints(problem: Problem) -> tuple[Constraint, ...]:
    """Return the constraints with their floors, and formulas restated on known quantities."""
    return tuple(restate_constraint(problem, item) for item in constraints_with_floors(problem))


def _with_floor(
    problem: Problem, constraints: tuple[Constraint, ...], of: Quantity, above: float | None = None
) -> tuple[Constraint, ...]:
    """Return constraints with a floor on a quantity if it has none. above: a lower bound that does not count.

    A bound on a formula that restates the quantity counts as a bound on it, and so does one on its robust form, except
    for a floor with `above`.
    """
    assert of.floor is not None
    forms = (problem.quantity(c.quantity) for c in constraints if c.lower is not None and above is None)
    if any(isinstance(form, RobustQuantity) and form.inner.name == of.name for form in forms):
        return constraints
    bounds_of_quantity = [
        c for c in (restate_constraint(problem, item) for item in constraints) if c.quantity == of.name
    ]
    if any(c.lower is not None and (above is None or c.lower > above) for c in bounds_of_quantity):
        return constraints
    upper, least = min((c.upper for c in bounds_of_quantity if c.upper is not None), default=None), above or 0.0
    lower = of.floor if upper is None else min(of.floor, least + 0.5 * (upper - least))
    other_constraints = [c for c in constraints if c.quantity != of.name]
    return (*other_constraints, Constraint(quantity=of.name, lower=float(lower), upper=upper))


def minimised_values(objective: Objective, values: Array) -> Array:
    """Return an objective's values as minimised: negated if maximised, a distance if it has a target."""
    if objective.sense == "maximise":
        return -values
    if objective.target is not None:
        return np.abs(values - objective.target)
    return values


def minimised_objectives(problem: Problem, values: Array) -> Array:
    """Return the objectives (n, m) of a problem as minimised."""
    return np.stack(
        [minimised_values(quantity, values[:, column]) for column, quantity in enumerate(problem.objectives)], axis=1
    )


def closed_sides(constraint: Constraint) -> list[Side]:
    """Return the closed sides of a constraint."""
    bounds = ((1.0, constraint.upper), (-1.0, constraint.lower))
    return [(side, bound, abs(bound) or 1.0) for side, bound in bounds if bound is not None]


def relative_violation(constraint: Constraint, values: Array, *, allowed: float = 0.0) -> Array:
    """Return the relative violation (n,), zero or less where the constraint holds; infinite without a value.

    allowed: allowed excess over a bound, SI.
    """
    violation = np.full(len(values), -np.inf)
    for side, bound, scale in closed_sides(constraint):
        violation = np.maximum(violation, scaled_excess(values, side, bound, scale) - allowed / scale)
    return np.where(np.isnan(values), np.inf, violation)


def greatest_violation(
    problem: Problem, designs: Array, constraints: Sequence[Constraint], *, allowed: Mapping[str, float] | None = None
) -> Array:
    """Return the greatest relative violation (n,) of constraints by designs (n, 3 + v), zero where all hold.

    allowed: allowed excess of quantities over their bounds, SI, by name.
    """
    worst = np.zeros(len(designs))
    if len(designs) and constraints:
        held = problem.evaluate(designs, [item.quantity for item in constraints])
        for column, item in enumerate(constraints):
            beyond = (allowed or {}).get(item.quantity, 0.0)
            worst = np.maximum(worst, relative_violation(item, held[:, column], allowed=beyond))
    return worst


def rotates_beyond_rounding(designs: Array) -> Mask:
    """Return which designs (n, 3 + v) rotate fully by more than rounding.

    Round numbers can lock exactly: rod 110 mm, crank 70 mm, offset 40 mm.
    """
    crank, rod, offset = designs.T[:3]
    return np.asarray((crank > 0.0) & (rod - crank - np.abs(offset) > FEASIBLE * rod))


def scaled_excess(values: Array, side: float, bound: float, scale: float) -> Array:
    """Return the excess of values over one side of a requirement, in units of its scale."""
    return (values - bound if side > 0.0 else bound - values) / scale


def needs_computed_cycle(quantity: Quantity) -> bool:
    """Return whether a quantity has no closed form, so that a cycle must be computed."""
    return not quantity.depends_only_on_dimensions
