"""The search's second half: polish candidates, fill the gaps that they leave, choose what to deliver."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .assemble import SELECTING, assemble, span_of
from .challenge import by_sheet, challengers
from .evaluation import Evaluator
from .front import ParetoFront
from .hypervolume import choose
from .ledger import integers
from .pile import Pile
from .problem import Problem
from .recorded import polished, projected
from .sampling import apart
from .search import Archive, Run
from .stationarity import Array

ROUNDS = 4
"""Rounds of the polish: the later ones fill gaps that the first one leaves."""
BATCH = 64
"""Designs polished together."""
_POOL = 2000  # greedy choice among more would take longer than it gains
_STARTS = 24  # for the best value of a single objective
_EXTREMES = 6  # for the best value of one objective among several


def deliver(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the designs of an archive; None if no candidate could be made feasible."""
    pile = Pile(span_of(problem, archive.values))
    several = len(problem.objectives) > 1
    rows = _choice(problem, archive, evaluators[0], run) if several else _spread(archive, 0, _STARTS)
    starts = by_sheet(evaluators, archive.sheet, archive.u, rows)
    if several:
        starts += _extremes(evaluators, archive, pile.span)
    run.pile = pile
    for attempt in range(ROUNDS):
        for index, u in starts:
            for begin in range(0, len(u), BATCH):
                batch = u[begin : begin + BATCH]
                pile.add(index, evaluators[index], polished(evaluators[index], batch, pile.span))
                run.tell("polishing", evaluators, archive, pile.values)
        if attempt == ROUNDS - 1 or not len(pile):
            break
        starts = challengers(problem, evaluators, archive, pile, attempt, run.stage(SELECTING))
        if not starts:
            break
    if not len(pile):
        return None
    return assemble(problem, evaluators, pile, run)


def as_found(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the designs of an archive as they are, moved no more than onto the constraints.

    None if no design could be moved there. Designs that meet the constraints already are not touched.
    """
    pile = Pile(span_of(problem, archive.values))
    several = len(problem.objectives) > 1
    rows = _choice(problem, archive, evaluators[0], run) if several else np.arange(min(len(archive), _STARTS))
    for index, u in by_sheet(evaluators, archive.sheet, archive.u, rows):
        valid = u[evaluators[index].valid(u)]
        pile.add(index, evaluators[index], projected(evaluators[index], valid, pile.span))
    if not len(pile):
        return None
    return assemble(problem, evaluators, pile, run)


def _candidates(problem: Problem) -> int:
    return max(16, int(1.3 * problem.settings.designs))


def planned(problem: Problem) -> int:
    """Return how many batches the polish takes if nothing needs filling."""
    return -(-_candidates(problem) // BATCH)


def _choice(problem: Problem, archive: Archive, evaluator: Evaluator, run: Run) -> NDArray[np.int64]:
    """Return the rows of the archive whose polish is to become the front; a step of the evaluator's ledger."""
    best = np.argmin(archive.values, axis=0)
    rows = np.arange(len(archive))
    if len(rows) > _POOL:
        rows = np.unique(np.concatenate([np.linspace(0, len(rows) - 1, _POOL).astype(int), best]))
    always = tuple(int(np.flatnonzero(rows == row)[0]) for row in dict.fromkeys(best.tolist()))
    values, ledger, stand = archive.values[rows], evaluator.ledger, run.stage(SELECTING)

    def compute() -> tuple[NDArray[np.int64]]:
        return (choose(values, _candidates(problem), always=always, stand=stand),)

    return rows[integers(ledger.step("choice", (values,), compute, evaluator)[0])]


def _spread(archive: Archive, column: int, count: int) -> NDArray[np.int64]:
    """Return the rows of designs that are best in an objective, each apart from the better ones."""
    return apart(archive.values[:, column], archive.u, archive.sheet, count)


def _extremes(evaluators: list[Evaluator], archive: Archive, span: Array) -> list[tuple[int, Array]]:
    """Return, for each objective, designs improved in it alone."""
    return [
        (index, polished(evaluators[index], u, span, chosen=(column,)).u)
        for column in range(archive.values.shape[1])
        for index, u in by_sheet(evaluators, archive.sheet, archive.u, _spread(archive, column, _EXTREMES))
    ]
