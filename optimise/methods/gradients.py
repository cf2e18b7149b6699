"""Methods that need gradients, and what they say to a quantity that has none."""

from __future__ import annotations

from ...model.errors import InputError
from ..problem.gradients import constraints_anywhere, without_gradient
from ..problem.problem import Problem
from .registry import METHODS

WITHOUT = tuple(name for name, method in METHODS.items() if not method.gradients)
"""Methods that use values only."""


def require_gradients(problem: Problem, what: str | None = None) -> None:
    """Raise `InputError` if the problem's method needs a gradient that a quantity does not have.

    what: needs gradients in place of the method, as the subject of a sentence.
    """
    lacking = without_gradient(problem)
    if not lacking:
        return
    method = problem.settings.method
    if what is not None or method not in WITHOUT:
        fitting = [name for name in WITHOUT if METHODS[name].takes(len(problem.objectives))]
        other = "" if what else f"use one of {', '.join(fitting)}, or "
        raise InputError(
            f"{what or f'the method {method}'} needs the gradient of every quantity; got {', '.join(lacking)} with "
            f'gradient = "none"; {other}set gradient = "finite differences"'
        )
    for constraint in constraints_anywhere(problem):
        if constraint.equality and constraint.quantity in lacking:
            raise InputError(
                f"{constraint.quantity} can be held at one value only with its gradient; got equals, and gradient = "
                '"none"; give it a min and a max, or set gradient = "finite differences"'
            )
