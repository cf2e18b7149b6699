"""Search methods by name, and checks that a method can solve a problem.

Each module of this package declares its own methods; `methods` finds them. packages that a method uses are imported
inside functions, so that reading a method's facts is cheap.
"""

from __future__ import annotations

import pkgutil
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Literal, Protocol, get_args

from ...model.errors import InputError

if TYPE_CHECKING:
    from ..problem.problem import Problem
    from ..search.evaluation import Evaluator
    from ..search.sample_and_zoom import Archive, Run


Family = Literal["default", "gradient", "global", "scalarisation", "evolutionary", "model-based", "sampling"]
FAMILIES: tuple[Family, ...] = get_args(Family)
"""Order in which lists name the methods; within a family, modules are in alphabetical order and methods in module
order."""


class Search(Protocol):
    """The search function of a method."""

    def __call__(self, problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
        """Return the designs found: feasible, or close enough for the delivery to move them onto the limits.

        evaluators: evaluators of the branches with free unknowns, at least one. Costly steps are recorded, so that a
        search can stop within a moment and resume.
        """
        ...


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method that a job can select.

    name: name in job files. title, help: a few words, and one sentence on how it searches. objectives: supported
    numbers of objectives. budget: default number of evaluations; None for a method that ends by itself and has no
    budget. uses: packages that compute, besides NumPy. gradients: whether it needs them. equalities: whether it
    supports those that cannot be eliminated. polishes: whether designs are polished to stationarity; otherwise they are
    delivered as found, so that methods remain independent checks of one another.
    """

    name: str
    title: str
    help: str
    family: Family
    objectives: Literal["one", "several", "any"]
    search: Search
    budget: int | None
    uses: tuple[str, ...] = ()
    gradients: bool = True
    equalities: bool = True
    polishes: bool = False

    def supports_objective_count(self, count: int) -> bool:
        """Whether the method supports this number of objectives."""
        return self.objectives == "any" or (self.objectives == "one") == (count == 1)


@cache
def methods_by_name() -> dict[str, Method]:
    """Return all methods by name, family by family; see `FAMILIES`."""
    package = import_module(__package__)
    modules = sorted(module.name for module in pkgutil.walk_packages(package.__path__, f"{__package__}."))
    declared = [value for name in modules for value in vars(import_module(name)).values() if isinstance(value, Method)]
    declared = sorted(dict.fromkeys(declared), key=lambda method: FAMILIES.index(method.family))
    by_name = {method.name: method for method in declared}
    if len(by_name) < len(declared):
        raise TypeError(f"methods must have different names; got {', '.join(method.name for method in declared)}")
    return by_name


def method_of_problem(problem: Problem) -> Method:
    """Return the method that a problem selects. Raises `InputError` for an unknown name."""
    name, by_name = problem.settings.method, methods_by_name()
    if name not in by_name:
        raise InputError(f"the method must be one of {', '.join(by_name)}; got {name!r}; choose one of these")
    return by_name[name]


def evaluation_budget(problem: Problem) -> int:
    """Return the evaluation budget of the problem's method. Raises `InputError` if it has no budget."""
    default = method_of_problem(problem).budget
    if default is None:
        raise InputError(f"the method {problem.settings.method} has no budget of evaluations; name another method")
    return problem.settings.evaluations or default


def require_supported_settings(problem: Problem) -> None:
    """Raise `InputError` for an unsupported number of objectives, or for a budget that the method does not use."""
    method, count = method_of_problem(problem), len(problem.objectives)
    evaluations = problem.settings.evaluations
    if evaluations is not None and method.budget is None:
        raise InputError(
            f"the method {method.name} has no budget of evaluations; got {evaluations}; leave it out, or name a method"
        )
    if method.supports_objective_count(count):
        return
    fitting = ", ".join(
        name for name, candidate in methods_by_name().items() if candidate.supports_objective_count(count)
    )
    objectives = ", ".join(objective.quantity for objective in problem.objectives)
    takes = "one objective" if method.objectives == "one" else "several objectives"
    raise InputError(f"the method {method.name} needs {takes}; got {count} ({objectives}); use one of {fitting}")


def require_supported_equalities(problem: Problem, evaluators: list[Evaluator]) -> None:
    """Raise `InputError` if the method cannot meet an equality that remains after elimination."""
    method = method_of_problem(problem)
    if method.equalities:
        return
    for evaluator in evaluators:
        for constraint in evaluator.constraints:
            if constraint.equality:
                raise InputError(
                    f"the method {method.name} cannot keep {constraint.quantity} at one value, because no formula "
                    "eliminates it; use slsqp or auto, or give it a min and a max"
                )


def require_gradients(problem: Problem, caller: str | None = None) -> None:
    """Raise `InputError` if the problem's method needs a gradient and a quantity has none.

    caller: subject of the message in place of the method.
    """
    lacking = problem.without_gradient()
    if not lacking:
        return
    method = method_of_problem(problem)
    if caller is not None or method.gradients:
        count = len(problem.objectives)
        fitting = [
            name
            for name, candidate in methods_by_name().items()
            if not candidate.gradients and candidate.supports_objective_count(count)
        ]
        instead = "" if caller else f"use one of {', '.join(fitting)}, or "
        raise InputError(
            f"{caller or f'the method {method.name}'} needs the gradient of every quantity; got {', '.join(lacking)} "
            f'with gradient = "none"; {instead}set gradient = "finite differences"'
        )
    for constraint in problem.every_constraint:
        if constraint.equality and constraint.quantity in lacking:
            raise InputError(
                f'{constraint.quantity} needs a gradient to be kept at one value; got equals, and gradient = "none"; '
                'give it a min and a max, or set gradient = "finite differences"'
            )
