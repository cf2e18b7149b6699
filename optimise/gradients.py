"""Which problems have gradients: a function of your own may have none."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.errors import InputError
from ..objectives.own.quantity import OwnQuantity
from .methods.registry import METHODS
from .problem import Constraint, Problem

WITHOUT = tuple(
    name for name, method in METHODS.items() if method.module in ("evolutionary", "parzen", "adaptation", "sampling")
)
"""Methods that use values only."""


def without_gradient(problem: Problem) -> list[str]:
    """Return the quantities that objectives and constraints name, those of choices too, and that have no gradient."""
    asked = [o.quantity for o in problem.objectives] + [c.quantity for c in _constraints(problem)]
    lacking = [own.name for own in problem.own if isinstance(own, OwnQuantity) and own.gradient == "none"]
    return [name for name in lacking if name in asked]


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
    for constraint in _constraints(problem):
        if constraint.equality and constraint.quantity in lacking:
            raise InputError(
                f"{constraint.quantity} can be held at one value only with its gradient; got equals, and gradient = "
                '"none"; give it a min and a max, or set gradient = "finite differences"'
            )


def _constraints(problem: Problem) -> Iterator[Constraint]:
    yield from problem.constraints
    for variant in problem.variants:
        yield from variant.limits
