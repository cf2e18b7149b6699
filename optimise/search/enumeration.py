"""Sheets that leave nothing free: each has one design, which is evaluated exactly. No sampling decides about these."""

from __future__ import annotations

import numpy as np

from ..problem.problem import Problem
from .candidates import Finished
from .evaluation import Evaluator
from .recorded import polished
from .search import Archive, Run

_ROUND = 100  # sheets of a round


def searched(evaluators: list[Evaluator]) -> list[Evaluator]:
    """Return the evaluators of sheets that leave something free; they come first, so that indices stay the same."""
    return [evaluator for evaluator in evaluators if evaluator.dimension]


def enumerate_settled(problem: Problem, evaluators: list[Evaluator], run: Run) -> Finished:
    """Return the feasible designs of all sheets that leave nothing free, and give them to the run."""
    count = len(problem.objectives)
    free = searched(evaluators)
    finished = run.finished = Finished.none(np.ones(count))
    run.settled = evaluators[len(free) :]
    point = np.zeros((1, 0))
    for place, evaluator in enumerate(run.settled):
        run.ledger.poll()
        if evaluator.valid(point)[0]:
            finished.add(len(free) + place, polished(evaluator, point, finished.span))
        if (place + 1) % _ROUND == 0 or place + 1 == len(run.settled):
            run.tell("enumerating", free, Archive.empty(count))
    return finished
