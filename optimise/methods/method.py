"""A method of searching: what it can take, what it computes with, and its search.

Each module of this package declares its own methods; `registry` finds them. Packages that a method computes with are
imported inside functions: to know what a method can take costs next to nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol, get_args

if TYPE_CHECKING:
    from ..problem.problem import Problem
    from ..search.evaluation import Evaluator
    from ..search.search import Archive, Run

Family = Literal["default", "gradient", "global", "scalarisation", "evolutionary", "model-based", "sampling"]
FAMILIES: tuple[Family, ...] = get_args(Family)
"""In the order in which lists name methods; within a family modules follow each other by name, as do lines in one."""


class Search(Protocol):
    """The search of a method."""

    def __call__(self, problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
        """Return designs found: feasible ones, or ones so near that the delivery brings them onto the limits.

        evaluators: of the sheets that leave something free, at least one. Costly steps are recorded, so that
        a search can be stopped within a moment and go on.
        """
        ...


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method that a job can ask for.

    name: in job files. title, help: a few words, and one sentence on how it searches. objectives: how many it can take.
    budget: evaluations where the job sets none; None for a method that ends by itself and takes no budget. uses:
    packages that compute, besides NumPy. gradients: whether it needs them. equalities: whether it copes with one that
    cannot be eliminated. polishes: whether designs are polished to stationarity; otherwise they are delivered as they
    were found, which keeps methods independent checks of one another.
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

    def takes(self, count: int) -> bool:
        """Whether the method can take this many objectives."""
        return self.objectives == "any" or (self.objectives == "one") == (count == 1)
