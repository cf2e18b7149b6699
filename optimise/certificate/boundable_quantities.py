"""Quantities that can be bounded over boxes of designs, and the reasons why others cannot."""

from __future__ import annotations

from typing import TypeGuard

from ...model.swing.swing_states import ERROR
from ...objectives.bar_pieces import BarPeak
from ...objectives.closed_form import ClosedFormQuantity
from ...objectives.cycle_peak import CyclePeak
from ...objectives.quantity import Quantity
from ...objectives.swing_quantity import ClosedFormSwingQuantity, SwingLeast, SwingPeak
from ..problem.problem import Problem
from ..problem.requirements import Constraint, Objective, Sense
from .enclosed_machine import unboundable_load_reason


def unbounded_reason(problem: Problem, objective: Objective) -> str:
    """Return why an objective cannot be bounded over a box; empty if it can.

    Bounds exist for quantities with `formulas`, and for the travel and angle of a swing. Machines without friction also
    have lower bounds on peaks over the cycle or swing, and upper bounds on the least values of a swing.
    """
    reasons = (_unbounded_reason_in_part(part, objective) for part in problem.parts())
    return next(filter(None, reasons), "")


def _unbounded_reason_in_part(problem: Problem, objective: Objective) -> str:
    quantity, mechanism = problem.quantity(objective.quantity), problem.mechanism
    if mechanism.lever is not None:
        return f"{quantity.title} has no bound over a range of designs where a cylinder moves a lever"
    if quantity.formulas(mechanism) or is_swing_form(quantity):
        return ""
    if not isinstance(quantity, BarPeak | CyclePeak | SwingPeak | SwingLeast | ClosedFormSwingQuantity):
        profile = " along a speed profile" if isinstance(quantity, ClosedFormQuantity) else ""
        return f"{quantity.title}{profile} has no bound over a range of designs"
    has_forces = _has_forces(quantity)
    if has_forces and mechanism.friction.acts and not (isinstance(quantity, SwingPeak) and quantity.free):
        return f"{quantity.title} has no bound over a range of designs with friction"
    if has_forces and (load := unboundable_load_reason(mechanism)):
        return f"{quantity.title} has no bound over a range of designs: {load}"
    least = isinstance(quantity, SwingLeast | ClosedFormSwingQuantity) or (
        isinstance(quantity, BarPeak) and quantity.least
    )
    if objective.sense != ("maximise" if least else "minimise"):
        side, sense = ("an upper", "maximised") if least else ("a lower", "minimised")
        return f"{quantity.title} only has {side} bound, so it can only be certified if it is {sense}"
    return ""


def is_swing_form(quantity: Quantity) -> TypeGuard[ClosedFormSwingQuantity]:
    """Whether a quantity has a closed form in the two ends of a swing."""
    return isinstance(quantity, ClosedFormSwingQuantity) and quantity.measure != "angle"


def _has_forces(quantity: Quantity) -> bool:
    if isinstance(quantity, CyclePeak):
        return quantity.signal.needs_forces
    return isinstance(quantity, BarPeak | SwingLeast) or (isinstance(quantity, SwingPeak) and quantity.state != ERROR)


def is_usable(problem: Problem, constraint: Constraint) -> bool:
    """Whether a constraint helps to rule out boxes; any other still holds for every design that is counted."""
    stated = [bound for bound in (constraint.lower, constraint.upper) if bound is not None]
    return len(ignored_sides(problem, constraint)) < len(stated)


def ignored_sides(problem: Problem, constraint: Constraint) -> list[str]:
    """Describe the sides of a constraint that do not rule out boxes."""
    sides: tuple[tuple[str, float | None, Sense], ...] = (
        ("minimum", constraint.lower, "maximise"),
        ("maximum", constraint.upper, "minimise"),
    )
    return [
        word
        for word, bound, sense in sides
        if bound is not None and unbounded_reason(problem, Objective(quantity=constraint.quantity, sense=sense))
    ]
