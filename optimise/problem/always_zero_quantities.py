"""Quantities that are zero for every design: an error as objectives or where excluded; a warning where idle."""

from __future__ import annotations

from ...model.errors import InfeasibleError, InputError
from .job_remark import Change, Remark
from .problem import Problem


def require_nonzero_quantities(problem: Problem) -> None:
    """Raise an error for a quantity that is zero for every design, robust or not, in all variants.

    `InputError` for an objective, `InfeasibleError` for a constraint that zero violates.
    """
    machines = [part.mechanism for part in problem.parts()]
    for objective in problem.objectives:
        reason = problem.quantity(objective.quantity).zero_because(machines)
        if reason:
            raise InputError(f"objectives.{objective.quantity}: {reason}")
    for constraint in problem.constraints:
        quantity = problem.quantity(constraint.quantity)
        for word, bound in constraint.sides:
            excluding = {"min": bound > 0.0, "max": bound < 0.0, "equals": bound != 0.0}[word]
            reason = quantity.zero_because(machines) if excluding else None
            if reason:
                raise InfeasibleError(
                    f"constraints.{quantity.name}: {word} {bound * quantity.unit.factor:.6g} {quantity.unit.symbol} "
                    f"excludes zero, and it is zero for every design of this job: {reason}"
                )


def idle_constraint_warnings(problem: Problem) -> list[str]:
    """Return a warning for each constraint on a quantity that is zero, and so meets it, for every design."""
    machines = [part.mechanism for part in problem.parts()]
    reasons = {
        sentence.quantity: problem.quantity(sentence.quantity).zero_because(machines)
        for sentence in problem.constraints
    }
    return [
        Remark(
            f"constraints.{name} excludes no design: it is zero for every design of this job; {reason}",
            Change(f"constraints.{name}", None, "Remove the requirement"),
        )
        for name, reason in reasons.items()
        if reason
    ]
