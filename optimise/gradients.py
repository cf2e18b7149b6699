"""Which problems have gradients: a function of your own may have none."""

from __future__ import annotations

from ..model.errors import InputError
from ..objectives.own.quantity import OwnQuantity
from .methods.registry import METHODS
from .problem import Problem

WITHOUT = tuple(name for name, method in METHODS.items() if method.module == "evolutionary")
"""Methods that use values only."""


def without_gradient(problem: Problem) -> list[str]:
    """Return the quantities that objectives and constraints name and that have no gradient."""
    asked = [o.quantity for o in problem.objectives] + [c.quantity for c in problem.constraints]
    lacking = [own.name for own in problem.own if isinstance(own, OwnQuantity) and own.gradient == "none"]
    return [name for name in lacking if name in asked]


def require_gradients(problem: Problem) -> None:
    """Raise `InputError` if the problem's method needs a gradient that a quantity does not have."""
    lacking = without_gradient(problem)
    if lacking and problem.settings.method not in WITHOUT:
        raise InputError(
            f"the method {problem.settings.method} needs the gradient of every quantity; got {', '.join(lacking)} with "
            f'gradient = "none"; use one of {", ".join(WITHOUT)}, or set gradient = "finite differences"'
        )
