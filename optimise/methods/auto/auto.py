"""The default method, sampling, zooming and polish by SQP; and the delivery of what any method has found.

The delivery polishes candidates, fills the gaps that they leave and chooses among them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ....model.arrays import Array, Mask, Whole, distinct
from ...front.dominance import beating, nondominated
from ...front.front import ParetoFront
from ...front.hypervolume import Stand, choose
from ...front.neighbours import neighbours
from ...problem.problem import Problem
from ...problem.violation import FEASIBLE
from ...search.assemble import SELECTING, assemble, span_of
from ...search.candidates import SAME, Candidates, Finished, Polished, stacked
from ...search.evaluation import Evaluator
from ...search.recorded import polished, projected
from ...search.sampling import around, first_samples, generator
from ...search.search import FIRST, SAMPLES, WIDTHS, Archive, Run, enumerate_settled, explore, searched, share
from ..registry import Method

ROUNDS = 4
"""Rounds of the polish: the later ones fill gaps that the first one leaves."""
BATCH = 64
"""Designs polished together."""
_POOL = 2000  # greedy choice among more would take longer than it gains
_FEWEST = 16  # designs polished, however few are asked for: more of them reach the best
_STARTS = 24  # for the best value of a single objective
_EXTREMES = 6  # for the best value of one objective among several
_ONE = 1e-6  # of the unit box: optima nearer than this are one
_WIDTH = 0.02  # of the unit box: spread of fresh samples around polished designs
_FILLING = 2000  # designs of the archive that gaps are filled from
_CLEAR = 1e-6  # of the objectives' range: a domination that is more than rounding
_GAIN = 1e-3  # of the same: a gain that is worth a loss of `_CLEAR`, for example by another choice for the same lengths
_NEIGHBOURS = 2  # an objective, between which gaps are looked for


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
            for index, ends in _ends(evaluators, group, finished.span):
                if ends is not None:
                    finished.add(index, ends)
                run.tell("polishing", free, archive)
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
    return max(_FEWEST, int(1.3 * problem.settings.designs))


def _choice(problem: Problem, group: Archive, evaluator: Evaluator, run: Run) -> Whole:
    """Return the rows of designs whose polish is to become the front; a recorded step."""
    best, rows = np.argmin(group.values, axis=0), np.arange(len(group))
    if len(rows) > _POOL:
        rows = distinct(np.concatenate([np.linspace(0, len(rows) - 1, _POOL).astype(int), best]))
    always = tuple(int(np.flatnonzero(rows == row)[0]) for row in dict.fromkeys(best.tolist()))
    values, stand = group.values[rows], run.stage(SELECTING)

    def compute() -> tuple[Whole]:
        return (choose(values, _candidates(problem), always=always, stand=stand),)

    return rows[evaluator.step("choice", (values,), compute)[0]]


def _ends(evaluators: list[Evaluator], group: Archive, span: Array) -> Iterator[tuple[int, Polished | None]]:
    """Yield the ends of the front by sheet: designs best in one objective, and in the others as far as that allows.

    Each begins from several designs that lead in the objective, and is improved in it alone, then in all with that one
    held firmly. Where even so it loses what shows, the best in the objective alone is an end too. Held less firmly, it
    moves to where the others gain much for little, if its slope vanishes at the end. None: on the way.
    """
    parts: dict[int, list[tuple[int, Polished]]] = {}
    for column in range(len(span)):
        for index, u in group[group.leading(column, _EXTREMES)].by_sheet(evaluators):
            found = polished(evaluators[index], u, span, chosen=(column,))
            parts.setdefault(index, []).append((column, found[_differing(found.u)]))
            yield index, None
    for index, each in parts.items():
        first, *others = (found for _, found in each)
        alone = first.join(*others)
        best_in = np.concatenate([np.full(len(found), column) for column, found in each])
        held = polished(evaluators[index], alone.u, span, best_in=best_in)
        own = np.arange(len(alone)), best_in
        lost = held.values[own] > alone.values[own] + SAME  # no difference: both are infinite without a least value
        beside = polished(evaluators[index], alone.u, span)
        yield index, held.join(alone[lost | (held.violation > FEASIBLE)], beside)


def _differing(u: Array) -> Whole:
    """Return the rows of points (n, k) that differ from those before."""
    apart = np.abs(u[:, None] - u).max(axis=2, initial=0.0) > _ONE
    return np.flatnonzero((apart | np.triu(np.ones_like(apart))).all(axis=1))


def challengers(
    problem: Problem, evaluators: list[Evaluator], archive: Archive, finished: Finished, attempt: int, stand: Stand
) -> list[tuple[int, Array]]:
    """Return points by sheet for further polish; none if the front is as good and full as asked.

    First those that dominate a polished design. Then, where candidates are wanting, those that no polished design
    dominates, and points half-way between neighbours. stand: called many times a second.
    """
    best = finished[finished.best(stand)]
    front = best.values / best.span
    _sample(problem, evaluators, archive, best, attempt)
    stand(0, 1)
    screened = archive.values / best.span
    better, uncovered = _against(screened, front)
    stand(0, 1)
    # Samples within a band around the constraints prove nothing.
    rows = np.flatnonzero(better & archive.met)[:_FILLING]
    wanting = _candidates(problem) - len(front) if front.shape[1] > 1 else 0
    starts = archive[_few(screened, rows, front, max(wanting, 32), stand)].by_sheet(evaluators)
    if wanting > 0:
        rows = np.flatnonzero(uncovered & ~better)
        rows = _few(screened, rows[:: 1 + len(rows) // _FILLING], front, wanting, stand)
        starts += archive[rows].by_sheet(evaluators)
        starts += _half_way(evaluators, best, wanting)
    return starts


def _sample(problem: Problem, evaluators: list[Evaluator], archive: Archive, best: Finished, attempt: int) -> None:
    """Screen points everywhere, and the polished designs, what is around them, and all that on other sheets."""
    seed, k = problem.settings.seed, len(evaluators)
    random = generator(seed, 2000, attempt)
    everywhere = share(problem.settings.samples or FIRST, evaluators)
    nearby = -(-(problem.settings.samples or SAMPLES) // k)

    def points() -> Iterator[tuple[int, Evaluator, Array]]:
        for index, evaluator in enumerate(evaluators):
            yield index, evaluator, first_samples(everywhere, evaluator.dimension, seed, 200 + k * attempt + index)
            parents = stacked(np.zeros((0, evaluator.dimension)), best.u)[:, : evaluator.dimension]
            near = around(parents, best.values, nearby, _WIDTH, random)
            yield index, evaluator, np.concatenate([near, parents[best.sheet != index]])

    archive.screen_all(points())


def _against(screened: Array, front: Array) -> tuple[Mask, Mask]:
    """Return which screened designs dominate one of the front, and which none of the front dominates."""
    kept = np.zeros(len(front) + len(screened), dtype=bool)
    kept[nondominated(np.concatenate([front, screened]))] = True
    return beating(screened, front, clearly=_CLEAR, slightly=_GAIN), kept[len(front) :]


def _few(screened: Array, rows: Whole, front: Array, count: int, stand: Stand) -> Whole:
    """Return at most `count` of some rows: those that add most to the hypervolume of the front."""
    if len(rows) <= count:
        return rows
    if front.shape[1] == 1:
        return rows[np.argsort(screened[rows, 0], kind="stable")[:count]]
    union = np.concatenate([front, screened[rows]])
    picked = choose(union, len(front) + count, always=tuple(range(len(front))), stand=stand)
    return rows[picked[picked >= len(front)] - len(front)]


def _half_way(evaluators: list[Evaluator], best: Finished, count: int) -> list[tuple[int, Array]]:
    """Return the middles between neighbours on the front, the farthest apart first."""
    scaled = best.values / best.span
    n, m = scaled.shape
    if n < 2:
        return []
    _, nearest = neighbours(scaled, min(n, 1 + _NEIGHBOURS * m))
    both = np.stack(np.broadcast_arrays(np.arange(n)[:, None], nearest), axis=-1).reshape(-1, 2)
    pairs = distinct(np.sort(both), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    pairs = pairs[best.sheet[pairs[:, 0]] == best.sheet[pairs[:, 1]]]
    gap = np.linalg.norm((best.values[pairs[:, 0]] - best.values[pairs[:, 1]]) / best.span, axis=1)
    pairs = pairs[np.argsort(-gap, kind="stable")[:count]]
    middle = 0.5 * (best.u[pairs[:, 0]] + best.u[pairs[:, 1]])
    return replace(best[pairs[:, 0]], u=middle).by_sheet(evaluators)


def auto(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the archive of what sampling and zooming find, which the polish starts from."""
    run.rounds = len(run.told) + 1 + len(WIDTHS) + -(-_candidates(problem) // BATCH)  # if nothing needs filling
    return explore(problem, evaluators, run)


AUTO = Method(
    name="auto",
    title="Default",
    help="Exact elimination, sampling, zooming, polishing by SQP, selection by hypervolume.",
    family="default",
    objectives="any",
    search=auto,
    budget=None,
    uses=("scipy", "moocore"),
    polishes=True,
)
