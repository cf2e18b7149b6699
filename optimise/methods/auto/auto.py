"""The default method (sampling, zooming, polish by SQP), and the delivery of designs from any method.

The delivery polishes candidates, fills the gaps between them and selects among them.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ....model.arrays import Array, IntArray, Mask, sorted_unique
from ...front.choose_design import nearest_neighbours
from ...front.dominance import dominating, nondominated
from ...front.front import ParetoFront
from ...front.hypervolume import ReportProgress, choose_designs_by_hypervolume
from ...problem.constraint_violation import FEASIBLE
from ...problem.problem import Problem
from ...search.assemble_front import SELECTING, assemble_front, objective_ranges
from ...search.candidates import SAME, Candidates, FrontCandidates, Polished, stack_rows
from ...search.evaluation import Evaluator
from ...search.recorded_polish import move_onto_constraints_recorded, polish_recorded
from ...search.sample_and_zoom import (
    FIRST,
    SAMPLES,
    WIDTHS,
    Archive,
    Run,
    enumerate_branches,
    sample_and_zoom,
    samples_per_branch,
    searched_evaluators,
)
from ...search.sampling import first_samples, random_generator, sample_near_parents
from ..registry import Method

ROUNDS = 4
"""Rounds of the polish: later ones fill gaps that the first one leaves."""
BATCH = 256
"""Designs polished together: enough for every worker, but few enough to lose when a process is killed."""
_POOL = 2000  # greedy selection among more would cost more time than it saves
_FEWEST = 16  # minimum number of designs to polish, however few are requested, to reach the best ones
_STARTS = 24  # descents for the best value of a single objective
_EXTREMES = 6  # descents for the best value of one objective among several
_ONE = 1e-6  # distance in the unit box within which optima are the same
_WIDTH = 0.02  # spread, in the unit box, of new samples around polished designs
_FILLING = 2000  # designs of the archive from which gaps are filled
_CLEAR = 1e-6  # relative to the objectives' range: a smaller domination is rounding
# Relative to the objectives' range: a gain worth a loss of `_CLEAR`, e.g. from another choice for the same lengths.
_GAIN = 1e-3
_NEIGHBOURS = 2  # neighbours per objective, between which gaps are sought


def search_front_by_method(
    method: Method, problem: Problem, evaluators: list[Evaluator], run: Run
) -> ParetoFront | None:
    """Return the front that a method finds, None if nothing is feasible.

    Combinations without free unknowns are enumerated; the method searches the others.
    """
    enumerate_branches(problem, evaluators, run)
    free = searched_evaluators(evaluators)
    archive = method.search(problem, free, run) if free else Archive.empty(len(problem.objectives))
    return (deliver_front if method.polishes else deliver_unpolished)(problem, evaluators, archive, run)


def deliver_front(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the enumerated designs and those of an archive; None if none could be made feasible."""
    candidates, free = _start_candidates(problem, archive, run), searched_evaluators(evaluators)
    several = len(problem.objectives) > 1
    starts = []
    for group in archive.feasible_and_infeasible():
        rows = _choose_rows_to_polish(problem, group, evaluators[0], run) if several else group.leading_rows(0, _STARTS)
        starts += group[rows].points_by_branch(evaluators)
        if several:
            extremes = _starts_for_extremes(evaluators, group)
            run.expect_rounds(len(extremes) + len({index for _, index, _ in extremes}) + _batch_count(starts))
            for index, ends in _polish_extremes(evaluators, extremes, candidates.span):
                if ends is not None:
                    candidates.add_feasible(index, ends)
                run.report_round("polishing", free, archive)
    for attempt in range(ROUNDS):
        run.expect_rounds(_batch_count(starts))
        for index, u in starts:
            for begin in range(0, len(u), BATCH):
                run.begin_round("polishing")
                candidates.add_feasible(
                    index, polish_recorded(evaluators[index], u[begin : begin + BATCH], candidates.span)
                )
                run.report_round("polishing", free, archive)
        if attempt == ROUNDS - 1 or not len(candidates) or not free:
            break
        starts = points_to_polish_next(problem, free, archive, candidates, attempt, run.stage_reporter(SELECTING))
        if not starts:
            break
    return assemble_front(problem, evaluators, candidates, run) if len(candidates) else None


def deliver_unpolished(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from an archive's designs without polish, only moved onto the constraints.

    None if no design could be moved onto them. Designs that already meet the constraints stay unchanged.
    """
    candidates = _start_candidates(problem, archive, run)
    several = len(problem.objectives) > 1
    for group in archive.feasible_and_infeasible():
        rows = _choose_rows_to_polish(problem, group, evaluators[0], run) if several else slice(_STARTS)
        add_moved_onto_constraints(candidates, group[rows], evaluators)
    return assemble_front(problem, evaluators, candidates, run) if len(candidates) else None


def _start_candidates(problem: Problem, archive: Archive, run: Run) -> FrontCandidates:
    """Return the run's enumerated candidates, to which the archive's designs will be added."""
    values = np.concatenate([archive.values, run.candidates.values])
    if len(problem.objectives) > 1:
        values = values[nondominated(values)]
    run.candidates = run.candidates.only_enumerated(
        objective_ranges(problem, values) if len(values) else run.candidates.span
    )
    return run.candidates


def add_moved_onto_constraints(candidates: FrontCandidates, chosen: Candidates, evaluators: list[Evaluator]) -> None:
    """Add candidates unchanged, except those that violate constraints, which are moved onto them."""
    for index, u in chosen.points_by_branch(evaluators):
        valid = u[evaluators[index].can_evaluate(u)]
        candidates.add_feasible(index, move_onto_constraints_recorded(evaluators[index], valid, candidates.span))


def _polished_design_count(problem: Problem) -> int:
    return max(_FEWEST, int(1.3 * problem.settings.designs))


def _choose_rows_to_polish(problem: Problem, group: Archive, evaluator: Evaluator, run: Run) -> IntArray:
    """Return the rows of the designs to polish for the front; a recorded step."""
    best, rows = np.argmin(group.values, axis=0), np.arange(len(group))
    if len(rows) > _POOL:
        rows = sorted_unique(np.concatenate([np.linspace(0, len(rows) - 1, _POOL).astype(int), best]))
    always = tuple(int(np.flatnonzero(rows == row)[0]) for row in dict.fromkeys(best.tolist()))
    values, report = group.values[rows], run.stage_reporter(SELECTING)

    def compute() -> tuple[IntArray]:
        return (choose_designs_by_hypervolume(values, _polished_design_count(problem), always=always, report=report),)

    return rows[evaluator.recorded_step("choice", (values,), compute)[0]]


def _batch_count(starts: list[tuple[int, Array]]) -> int:
    return sum(-(-len(u) // BATCH) for _, u in starts)


def _starts_for_extremes(evaluators: list[Evaluator], group: Archive) -> list[tuple[int, int, Array]]:
    """Return objective, branch and points of the designs that lead in an objective."""
    return [
        (column, index, u)
        for column in range(group.values.shape[1])
        for index, u in group[group.leading_rows(column, _EXTREMES)].points_by_branch(evaluators)
    ]


def _polish_extremes(
    evaluators: list[Evaluator], starts: list[tuple[int, int, Array]], span: Array
) -> Iterator[tuple[int, Polished | None]]:
    """Yield the extreme designs on the front by branch: best in one objective, then in the others.

    The starts, several designs that lead in each objective, are improved in it alone, then in all objectives with this
    one held firmly. If the result still loses visibly, the best in the objective alone is an end too. Held less firmly,
    the design would move to where the others gain much for a small loss, if the slope of this objective vanishes at the
    end. None: in progress.
    """
    parts: dict[int, list[tuple[int, Polished]]] = {}
    for column, index, u in starts:
        polished_batch = polish_recorded(evaluators[index], u, span, chosen=(column,))
        parts.setdefault(index, []).append((column, polished_batch[_distinct_points(polished_batch.u)]))
        yield index, None
    for index, batches in parts.items():
        first, *rest = (polished_batch for _, polished_batch in batches)
        alone = first.join(*rest)
        best_in = np.concatenate([np.full(len(polished_batch), column) for column, polished_batch in batches])
        firm = polish_recorded(evaluators[index], alone.u, span, best_in=best_in)
        best_values = np.arange(len(alone)), best_in
        # No difference counts if both are infinite because there is no least value.
        lost = firm.values[best_values] > alone.values[best_values] + SAME
        unrestricted = polish_recorded(evaluators[index], alone.u, span)
        yield index, firm.join(alone[lost | (firm.violation > FEASIBLE)], unrestricted)


def _distinct_points(u: Array) -> IntArray:
    """Return the rows of points (n, k) that differ from earlier ones."""
    is_distinct = np.abs(u[:, None] - u).max(axis=2, initial=0.0) > _ONE
    return np.flatnonzero((is_distinct | np.triu(np.ones_like(is_distinct))).all(axis=1))


def points_to_polish_next(
    problem: Problem,
    evaluators: list[Evaluator],
    archive: Archive,
    candidates: FrontCandidates,
    attempt: int,
    report: ReportProgress,
) -> list[tuple[int, Array]]:
    """Return points by branch for further polish; none if the front is good and full enough.

    Points that dominate a polished design come first. If candidates are too few, points that no polished design
    dominates follow, and midpoints between neighbours. report: called many times a second.
    """
    best = candidates[candidates.nondominated_rows(report)]
    front = best.values / best.span
    _screen_fresh_points(problem, evaluators, archive, best, attempt)
    report(0, 1)
    screened = archive.values / best.span
    better, uncovered = _masks_of_dominating_and_undominated(screened, front)
    report(0, 1)
    # Samples within a band around the constraints prove nothing.
    rows = np.flatnonzero(better & archive.is_feasible)[:_FILLING]
    wanting = _polished_design_count(problem) - len(front) if front.shape[1] > 1 else 0
    starts = archive[_best_contributors(screened, rows, front, max(wanting, 32), report)].points_by_branch(evaluators)
    if wanting > 0:
        rows = np.flatnonzero(uncovered & ~better)
        rows = _best_contributors(screened, rows[:: 1 + len(rows) // _FILLING], front, wanting, report)
        starts += archive[rows].points_by_branch(evaluators)
        starts += _midpoints_of_gaps(evaluators, best, wanting)
    return starts


def _screen_fresh_points(
    problem: Problem, evaluators: list[Evaluator], archive: Archive, best: FrontCandidates, attempt: int
) -> None:
    """Screen new points everywhere, polished designs, points around them, and all these on other branches."""
    seed, k = problem.settings.seed, len(evaluators)
    random = random_generator(seed, 2000, attempt)
    everywhere = samples_per_branch(problem.settings.samples or FIRST, evaluators)
    nearby = -(-(problem.settings.samples or SAMPLES) // k)

    def points() -> Iterator[tuple[int, Evaluator, Array]]:
        for index, evaluator in enumerate(evaluators):
            yield index, evaluator, first_samples(everywhere, evaluator.dimension, seed, 200 + k * attempt + index)
            parents = stack_rows(np.zeros((0, evaluator.dimension)), best.u)[:, : evaluator.dimension]
            near = sample_near_parents(parents, best.values, nearby, _WIDTH, random)
            yield index, evaluator, np.concatenate([near, parents[best.branch != index]])

    archive.screen_all(points())


def _masks_of_dominating_and_undominated(screened: Array, front: Array) -> tuple[Mask, Mask]:
    """Return which screened designs dominate a design on the front, and which are not dominated by any."""
    undominated = np.zeros(len(front) + len(screened), dtype=bool)
    undominated[nondominated(np.concatenate([front, screened]))] = True
    return dominating(screened, front, clearly=_CLEAR, slightly=_GAIN), undominated[len(front) :]


def _best_contributors(screened: Array, rows: IntArray, front: Array, count: int, report: ReportProgress) -> IntArray:
    """Return at most `count` of the given rows: those that add most to the front's hypervolume."""
    if len(rows) <= count:
        return rows
    if front.shape[1] == 1:
        return rows[np.argsort(screened[rows, 0], kind="stable")[:count]]
    union = np.concatenate([front, screened[rows]])
    picked = choose_designs_by_hypervolume(union, len(front) + count, always=tuple(range(len(front))), report=report)
    return rows[picked[picked >= len(front)] - len(front)]


def _midpoints_of_gaps(evaluators: list[Evaluator], best: FrontCandidates, count: int) -> list[tuple[int, Array]]:
    """Return the midpoints between neighbours on the front, farthest apart first."""
    scaled = best.values / best.span
    n, m = scaled.shape
    if n < 2:
        return []
    _, nearest = nearest_neighbours(scaled, min(n, 1 + _NEIGHBOURS * m))
    neighbour_pairs = np.stack(np.broadcast_arrays(np.arange(n)[:, None], nearest), axis=-1).reshape(-1, 2)
    pairs = sorted_unique(np.sort(neighbour_pairs), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    pairs = pairs[best.branch[pairs[:, 0]] == best.branch[pairs[:, 1]]]
    gap = np.linalg.norm((best.values[pairs[:, 0]] - best.values[pairs[:, 1]]) / best.span, axis=1)
    pairs = pairs[np.argsort(-gap, kind="stable")[:count]]
    middle = 0.5 * (best.u[pairs[:, 0]] + best.u[pairs[:, 1]])
    return replace(best[pairs[:, 0]], u=middle).points_by_branch(evaluators)


def auto(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the archive of designs from sampling and zooming, from which the polish starts."""
    # This holds if no gaps need filling and every branch has an extreme design for each objective.
    m = len(problem.objectives)
    extremes = (m + 1) * len(evaluators) if m > 1 else 0
    run.expect_rounds(1 + len(WIDTHS) + extremes + -(-_polished_design_count(problem) // BATCH))
    return sample_and_zoom(problem, evaluators, run)


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
