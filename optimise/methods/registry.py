"""Every method that a module of this package declares, by name, and the refusal of problems that it cannot take."""

from __future__ import annotations

import pkgutil
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from ...model.errors import InputError
from .method import FAMILIES, Method

if TYPE_CHECKING:
    from ..problem.problem import Problem
    from ..search.evaluation import Evaluator


@cache
def methods() -> dict[str, Method]:
    """Return all methods by name: family by family, see `method.FAMILIES`."""
    package = import_module(__package__)
    modules = sorted(found.name for found in pkgutil.walk_packages(package.__path__, f"{__package__}."))
    declared = [value for name in modules for value in vars(import_module(name)).values() if isinstance(value, Method)]
    declared = sorted(dict.fromkeys(declared), key=lambda method: FAMILIES.index(method.family))
    by_name = {method.name: method for method in declared}
    if len(by_name) < len(declared):
        raise TypeError(f"two methods have one name: {', '.join(method.name for method in declared)}")
    return by_name


def method_of(problem: Problem) -> Method:
    """Return the method that a problem asks for. Raises `InputError` for an unknown name."""
    name, known = problem.settings.method, methods()
    if name not in known:
        raise InputError(f"the method must be one of {', '.join(known)}; got {name!r}; choose one of these")
    return known[name]


def budget(problem: Problem) -> int:
    """Return how many designs the problem's method may evaluate. Raises `InputError` if it takes no budget."""
    own = method_of(problem).budget
    if own is None:
        raise InputError(f"the method {problem.settings.method} has no budget of evaluations; name another method")
    return problem.settings.evaluations or own


def require_fit(problem: Problem) -> None:
    """Raise `InputError` if the method cannot take its number of objectives, or takes no budget but has one."""
    method, count = method_of(problem), len(problem.objectives)
    asked = problem.settings.evaluations
    if asked is not None and method.budget is None:
        raise InputError(
            f"the method {method.name} has no budget of evaluations; got {asked}; leave it out, or name a method"
        )
    if method.takes(count):
        return
    fitting = ", ".join(name for name, other in methods().items() if other.takes(count))
    wanted = ", ".join(objective.quantity for objective in problem.objectives)
    takes = "one objective" if method.objectives == "one" else "several objectives"
    raise InputError(f"the method {method.name} takes {takes}; got {count} ({wanted}); use one of {fitting}")


def require_eliminated(problem: Problem, evaluators: list[Evaluator]) -> None:
    """Raise `InputError` if the method cannot meet an equality that is left after elimination."""
    method = method_of(problem)
    if method.equalities:
        return
    for evaluator in evaluators:
        for constraint in evaluator.constraints:
            if constraint.equality:
                raise InputError(
                    f"the method {method.name} cannot hold {constraint.quantity} at one value, because no formula "
                    "eliminates it; use slsqp or auto, or give it a min and a max"
                )


def require_gradients(problem: Problem, what: str | None = None) -> None:
    """Raise `InputError` if the problem's method needs a gradient that a quantity does not have.

    what: needs gradients in place of the method, as the subject of a sentence.
    """
    lacking = problem.without_gradient()
    if not lacking:
        return
    method = method_of(problem)
    if what is not None or method.gradients:
        count = len(problem.objectives)
        fitting = [name for name, other in methods().items() if not other.gradients and other.takes(count)]
        instead = "" if what else f"use one of {', '.join(fitting)}, or "
        raise InputError(
            f"{what or f'the method {method.name}'} needs the gradient of every quantity; got {', '.join(lacking)} "
            f'with gradient = "none"; {instead}set gradient = "finite differences"'
        )
    for constraint in problem.every_constraint:
        if constraint.equality and constraint.quantity in lacking:
            raise InputError(
                f"{constraint.quantity} can be held at one value only with its gradient; got equals, and gradient = "
                '"none"; give it a min and a max, or set gradient = "finite differences"'
            )
