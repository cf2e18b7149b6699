"""The names of the methods and where each lives; the module of a method is imported only when the method is used.

    auto                                        the default: sampling, zooming, polish by SQP (`auto`)
    slsqp, trust_constr                         gradient methods from many starts, one objective
    differential_evolution, shgo                global methods, one objective
    minimax                                     sequential convex programming, one objective, all peaks at once
    epsilon_constraint, chebyshev, nbi          fronts by scalarisation, two objectives or more
    nsga2, nsga3, tpe, cmaes, random, sobol     evolutionary and model-based methods, plain sampling

A method is a function of its name, `search(problem, evaluators, run) -> Archive`. It takes its budget from
`budget(problem)` and tells the run of every round. Its costly steps go through the ledger, see `ledger`: by that it can
be stopped within a moment, and go on. What it returns is delivered as it was found, without the polish of the default:
that keeps methods independent checks of one another.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Literal, Protocol, cast, get_args

from ...model.errors import InputError

if TYPE_CHECKING:
    from ..problem.problem import Problem
    from ..search.evaluation import Evaluator
    from ..search.search import Archive, Run

Name = Literal[
    "auto",
    "slsqp",
    "trust_constr",
    "differential_evolution",
    "shgo",
    "minimax",
    "epsilon_constraint",
    "chebyshev",
    "nbi",
    "nsga2",
    "nsga3",
    "tpe",
    "cmaes",
    "random",
    "sobol",
]
NAMES: tuple[str, ...] = get_args(Name)


class Search(Protocol):
    """What a method does."""

    def __call__(self, problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
        """Return what was found: feasible designs, or ones so near that the delivery brings them onto the limits."""
        ...


@dataclass(frozen=True)
class Method:
    """A method that can be asked for.

    module: in this package. budget: evaluations where the job sets none. objectives: how many it can take.
    equalities: whether it copes with an equality that cannot be eliminated. gradients: whether it needs them.
    """

    module: str
    budget: int
    objectives: Literal["one", "several", "any"]
    equalities: bool = True
    gradients: bool = True

    def takes(self, count: int) -> bool:
        """Whether the method can take this many objectives."""
        return self.objectives == "any" or (self.objectives == "one") == (count == 1)


METHODS: dict[str, Method] = {
    "slsqp": Method("gradient", 20_000, "one"),
    "trust_constr": Method("gradient", 20_000, "one", equalities=False),
    "differential_evolution": Method("global_search", 50_000, "one", equalities=False),
    "shgo": Method("global_search", 50_000, "one", equalities=False),
    "minimax": Method("minimax.minimax", 50_000, "one"),
    "epsilon_constraint": Method("scalarised", 100_000, "several"),
    "chebyshev": Method("scalarised", 100_000, "several"),
    "nbi": Method("scalarised", 100_000, "several"),
    "nsga2": Method("nsga", 20_000, "any", gradients=False),
    "nsga3": Method("nsga", 20_000, "several", gradients=False),
    "tpe": Method("tpe", 1_000, "any", gradients=False),
    "cmaes": Method("cma_es", 10_000, "one", gradients=False),
    "random": Method("sampling", 20_000, "any", gradients=False),
    "sobol": Method("sampling", 20_000, "any", gradients=False),
}
"""Every method but "auto"."""


def require_known(name: str) -> None:
    """Raise `InputError` if no method has this name."""
    if name not in NAMES:
        raise InputError(f"the method must be one of {', '.join(NAMES)}; got {name!r}; choose one of these")


def require_fit(problem: Problem) -> None:
    """Raise `InputError` if the problem's method cannot take its number of objectives."""
    name, count = problem.settings.method, len(problem.objectives)
    require_known(name)
    if name == "auto" or METHODS[name].takes(count):
        return
    fitting = ", ".join(["auto", *(other for other, method in METHODS.items() if method.takes(count))])
    wanted = ", ".join(objective.quantity for objective in problem.objectives)
    takes = "one objective" if METHODS[name].objectives == "one" else "several objectives"
    raise InputError(f"the method {name} takes {takes}; got {count} ({wanted}); use one of {fitting}")


def require_eliminated(problem: Problem, evaluators: list[Evaluator]) -> None:
    """Raise `InputError` if the method cannot meet an equality that is left after elimination."""
    name = problem.settings.method
    if name == "auto" or METHODS[name].equalities:
        return
    for evaluator in evaluators:
        for constraint in evaluator.constraints:
            if constraint.equality:
                raise InputError(
                    f"the method {name} cannot hold {constraint.quantity} at one value, because no formula eliminates "
                    "it; use slsqp or auto, or give it a min and a max"
                )


def search_of(name: str) -> Search:
    """Return the search of a method, importing its module. Raises `InputError` for an unknown name."""
    require_known(name)
    if name == "auto":
        raise InputError("the method auto has a search of its own; see `solve`")
    return cast(Search, getattr(import_module(f".{METHODS[name].module}", __package__), name))


def budget(problem: Problem) -> int:
    """Return how many designs the problem's method may evaluate."""
    return problem.settings.evaluations or METHODS[problem.settings.method].budget
