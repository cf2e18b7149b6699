"""Zero for every design: refused as an objective and where a rule excludes it; told where a rule says nothing."""

from __future__ import annotations

from ...model.errors import InputError
from .causes import zero_because
from .problem import Problem


def require_ranking(problem: Problem) -> None:
    """Raise `InputError` for a quantity that is zero whatever the design, robust or not, in all variants.

    As an objective, and in a constraint that zero does not meet.
    """
    machines = [part.mechanism for part in problem.parts()]
    for objective in problem.objectives:
        reason = zero_because(problem.quantity(objective.quantity), machines)
        if reason:
            raise InputError(f"objectives.{objective.quantity}: {reason}")
    for constraint in problem.constraints:
        low = constraint.lower is not None and constraint.lower > 0.0
        high = constraint.upper is not None and constraint.upper < 0.0
        quantity = problem.quantity(constraint.quantity)
        reason = zero_because(quantity, machines) if low or high else None
        if reason:
            word = "equals" if constraint.equality else "min" if low else "max"
            bound = (constraint.lower if low else constraint.upper) or 0.0
            raise InputError(
                f"constraints.{constraint.quantity}: {word} {bound * quantity.unit.factor:.6g} {quantity.unit.symbol} "
                f"excludes zero, and it is zero for every design of this job: {reason}"
            )


def idle_rules(problem: Problem) -> list[str]:
    """Return a warning for each constraint on a quantity that is zero for every design, which all of them meet."""
    machines = [part.mechanism for part in problem.parts()]
    reasons = {each.quantity: zero_because(problem.quantity(each.quantity), machines) for each in problem.constraints}
    return [
        f"constraints.{name} leaves no design out: it is zero for every design of this job; {reason}"
        for name, reason in reasons.items()
        if reason
    ]
