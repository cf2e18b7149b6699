"""The default method: combinations that leave nothing free are enumerated, the rest is sampled, zoomed and polished."""

from __future__ import annotations

from ...front.front import ParetoFront
from ...problem.problem import Problem
from ...search.enumeration import enumerate_settled, searched
from ...search.evaluation import Evaluator
from ...search.search import WIDTHS, Archive, Run, explore
from .deliver import deliver, planned


def search_by_default(problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront | None:
    """Return what the default method finds, None where nothing is feasible."""
    enumerate_settled(problem, evaluators, run)
    archive, free = Archive.empty(len(problem.objectives)), searched(evaluators)
    if free:
        run.rounds = len(run.told) + 1 + len(WIDTHS) + planned(problem)
        archive = explore(problem, free, run)
    return deliver(problem, evaluators, archive, run)
