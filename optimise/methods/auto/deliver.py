"""The search's second half: polish candidates, fill the gaps that they leave, choose what to deliver."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...front.front import ParetoFront
from ...front.hypervolume import choose, nondominated
from ...front.stationarity import Array
from ...problem.problem import Problem
from ...search.assemble import SELECTING, assemble, span_of
from ...search.candidates import Pile
from ...search.checkpoints import integers
from ...search.enumeration import enumerate_settled, searched
from ...search.evaluation import Evaluator
from ...search.recorded import polished, projected
from ...search.sampling import apart
from ...search.search import Archive, Run
from ..method import Method
from .challenge import by_sheet, challengers

ROUNDS = 4
"""Rounds of the polish: the later ones fill gaps that the first one leaves."""
BATCH = 64
"""Designs polished together."""
_POOL = 2000  # greedy choice among more would take longer than it gains
_STARTS = 24  # for the best value of a single objective
_EXTREMES = 6  # for the best value of one objective among several


def searched_by(method: Method, problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront | None:
    """Return the front that a method finds, None where nothing is feasible.

    Combinations that leave nothing free are enumerated; the method searches the rest.
    """
    enumerate_settled(problem, evaluators, run)
    free = searched(evaluators)
    archive = method.search(problem, free, run) if free else Archive.empty(len(problem.objectives))
    return (deliver if method.polishes else as_found)(problem, evaluators, archive, run)


def deliver(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the settled designs and those of an archive; None if none could be made feasible."""
    pile, free = _begun(problem, archive, run), searched(evaluators)
    several = len(problem.objectives) > 1
    starts = []
    for rows in archive.groups():
        some = _choice(problem, archive, rows, evaluators[0], run) if several else _spread(archive, rows, 0, _STARTS)
        starts += by_sheet(evaluators, archive.sheet, archive.u, some)
        if several:
            starts += _extremes(evaluators, archive, rows, pile.span)
    for attempt in range(ROUNDS):
        for index, u in starts:
            for begin in range(0, len(u), BATCH):
                batch = u[begin : begin + BATCH]
                pile.add(index, evaluators[index], polished(evaluators[index], batch, pile.span))
                run.tell("polishing", free, archive)
        if attempt == ROUNDS - 1 or not len(pile) or not free:
            break
        starts = challengers(problem, free, archive, pile, attempt, run.stage(SELECTING))
        if not starts:
            break
    if not len(pile):
        return None
    return assemble(problem, evaluators, pile, run)


def as_found(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the designs of an archive as they are, moved no more than onto the constraints.

    None if no design could be moved there. Designs that meet the constraints already are not touched.
    """
    pile = _begun(problem, archive, run)
    several = len(problem.objectives) > 1
    for rows in archive.groups():
        some = _choice(problem, archive, rows, evaluators[0], run) if several else rows[:_STARTS]
        for index, u in by_sheet(evaluators, archive.sheet, archive.u, some):
            valid = u[evaluators[index].valid(u)]
            pile.add(index, evaluators[index], projected(evaluators[index], valid, pile.span))
    if not len(pile):
        return None
    return assemble(problem, evaluators, pile, run)


def _begun(problem: Problem, archive: Archive, run: Run) -> Pile:
    """Return a pile of the settled designs, which those of the archive are to join; the run has it too."""
    settled = Pile(np.ones(len(problem.objectives))) if run.pile is None else run.pile
    values = np.concatenate([archive.values, settled.values])
    if len(problem.objectives) > 1:
        values = values[nondominated(values)]
    run.pile = settled.only_settled(span_of(problem, values) if len(values) else settled.span)
    return run.pile


def _candidates(problem: Problem) -> int:
    return max(16, int(1.3 * problem.settings.designs))


def planned(problem: Problem) -> int:
    """Return how many batches the polish takes if nothing needs filling."""
    return -(-_candidates(problem) // BATCH)


def _choice(
    problem: Problem, archive: Archive, rows: NDArray[np.int64], evaluator: Evaluator, run: Run
) -> NDArray[np.int64]:
    """Return those of some rows whose polish is to become the front; a step of the evaluator's ledger."""
    best = rows[np.argmin(archive.values[rows], axis=0)]
    if len(rows) > _POOL:
        rows = np.unique(np.concatenate([rows[np.linspace(0, len(rows) - 1, _POOL).astype(int)], best]))
    always = tuple(int(np.flatnonzero(rows == row)[0]) for row in dict.fromkeys(best.tolist()))
    values, ledger, stand = archive.values[rows], evaluator.ledger, run.stage(SELECTING)

    def compute() -> tuple[NDArray[np.int64]]:
        return (choose(values, _candidates(problem), always=always, stand=stand),)

    return rows[integers(ledger.step("choice", (values,), compute, evaluator)[0])]


def _spread(archive: Archive, rows: NDArray[np.int64], column: int, count: int) -> NDArray[np.int64]:
    """Return those of some rows that are best in an objective, each apart from the better ones."""
    return rows[apart(archive.values[rows, column], archive.u[rows], archive.sheet[rows], count)]


def _extremes(
    evaluators: list[Evaluator], archive: Archive, rows: NDArray[np.int64], span: Array
) -> list[tuple[int, Array]]:
    """Return, for each objective, the designs of some rows that are best in it, improved in it alone."""
    return [
        (index, polished(evaluators[index], u, span, chosen=(column,)).u)
        for column in range(archive.values.shape[1])
        for index, u in by_sheet(evaluators, archive.sheet, archive.u, _spread(archive, rows, column, _EXTREMES))
    ]
