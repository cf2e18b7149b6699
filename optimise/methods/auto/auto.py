"""The default method, sampling, zooming and polish by SQP; and the delivery of what any method has found.

The delivery polishes candidates, fills the gaps that they leave and chooses among them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...front.front import ParetoFront
from ...front.hypervolume import choose, nondominated
from ...front.stationarity import Array
from ...problem.problem import Problem
from ...search.assemble import SELECTING, assemble, span_of
from ...search.candidates import Candidates, Finished
from ...search.evaluation import Evaluator
from ...search.recorded import polished, projected
from ...search.search import WIDTHS, Archive, Run, enumerate_settled, explore, searched
from ..method import Method
from .challenge import challengers

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
    finished, free = _begun(problem, archive, run), searched(evaluators)
    several = len(problem.objectives) > 1
    starts = []
    for group in archive.groups():
        some = _choice(problem, group, evaluators[0], run) if several else group.leading(0, _STARTS)
        starts += group[some].by_sheet(evaluators)
        if several:
            starts += _extremes(evaluators, group, finished.span)
    for attempt in range(ROUNDS):
        for index, u in starts:
            for begin in range(0, len(u), BATCH):
                batch = u[begin : begin + BATCH]
                finished.add(index, polished(evaluators[index], batch, finished.span))
                run.tell("polishing", free, archive)
        if attempt == ROUNDS - 1 or not len(finished) or not free:
            break
        starts = challengers(problem, free, archive, finished, attempt, run.stage(SELECTING))
        if not starts:
            break
    return assemble(problem, evaluators, finished, run) if len(finished) else None


def as_found(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the designs of an archive as they are, moved no more than onto the constraints.

    None if no design could be moved there. Designs that meet the constraints already are not touched.
    """
    finished = _begun(problem, archive, run)
    several = len(problem.objectives) > 1
    for group in archive.groups():
        some = _choice(problem, group, evaluators[0], run) if several else slice(_STARTS)
        move(finished, group[some], evaluators)
    return assemble(problem, evaluators, finished, run) if len(finished) else None


def _begun(problem: Problem, archive: Archive, run: Run) -> Finished:
    """Return the settled designs, which those of the archive are to join; the run has them too."""
    values = np.concatenate([archive.values, run.finished.values])
    if len(problem.objectives) > 1:
        values = values[nondominated(values)]
    run.finished = run.finished.only_settled(span_of(problem, values) if len(values) else run.finished.span)
    return run.finished


def move(finished: Finished, candidates: Candidates, evaluators: list[Evaluator]) -> None:
    """Add candidates as they are, those that violate constraints moved onto them."""
    for index, u in candidates.by_sheet(evaluators):
        valid = u[evaluators[index].valid(u)]
        finished.add(index, projected(evaluators[index], valid, finished.span))


def _candidates(problem: Problem) -> int:
    return max(16, int(1.3 * problem.settings.designs))


def _choice(problem: Problem, group: Archive, evaluator: Evaluator, run: Run) -> NDArray[np.int64]:
    """Return the rows of designs whose polish is to become the front; a recorded step."""
    best, rows = np.argmin(group.values, axis=0), np.arange(len(group))
    if len(rows) > _POOL:
        rows = np.unique(np.concatenate([np.linspace(0, len(rows) - 1, _POOL).astype(int), best]))
    always = tuple(int(np.flatnonzero(rows == row)[0]) for row in dict.fromkeys(best.tolist()))
    values, stand = group.values[rows], run.stage(SELECTING)

    def compute() -> tuple[NDArray[np.int64]]:
        return (choose(values, _candidates(problem), always=always, stand=stand),)

    return rows[evaluator.step("choice", (values,), compute)[0]]


def _extremes(evaluators: list[Evaluator], group: Archive, span: Array) -> list[tuple[int, Array]]:
    """Return, for each objective, the designs that are best in it, improved in it alone."""
    return [
        (index, polished(evaluators[index], u, span, chosen=(column,)).u)
        for column in range(group.values.shape[1])
        for index, u in group[group.leading(column, _EXTREMES)].by_sheet(evaluators)
    ]


def auto(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the archive of what sampling and zooming find, which the polish starts from."""
    run.rounds = len(run.told) + 1 + len(WIDTHS) + -(-_candidates(problem) // BATCH)  # if nothing needs filling
    return explore(problem, evaluators, run)


AUTO = Method(
    name="auto",
    title="Default",
    help="Exact elimination, sampling, zooming, polish by SQP, choice by hypervolume.",
    family="default",
    objectives="any",
    search=auto,
    budget=None,
    uses=("scipy", "moocore"),
    polishes=True,
)
