"""Quantities of a problem that have no gradient: a function of one's own may have none."""

from __future__ import annotations

from collections.abc import Iterator

from ...objectives.own.quantity import OwnQuantity
from .problem import Problem
from .requirements import Constraint


def without_gradient(problem: Problem) -> list[str]:
    """Return the quantities that objectives and constraints name, those of choices too, and that have no gradient."""
    asked = [o.quantity for o in problem.objectives] + [c.quantity for c in constraints_anywhere(problem)]
    lacking = [own.name for own in problem.own if isinstance(own, OwnQuantity) and own.gradient == "none"]
    return [name for name in lacking if name in asked]


def constraints_anywhere(problem: Problem) -> Iterator[Constraint]:
    """Yield the constraints of a problem and those that come with its choices."""
    yield from problem.constraints
    for variant in problem.variants:
        yield from variant.limits
