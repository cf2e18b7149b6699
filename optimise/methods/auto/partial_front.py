"""The front found so far by a cancelled search, delivered within a moment."""

import contextlib
import time

import numpy as np

from ....model.arrays import Array, IntArray
from ....model.kernel.batches import interrupted_by
from ....objectives.own.quantity import runs_custom_function
from ...front.dominance import nondominated
from ...front.front import ParetoFront
from ...problem.problem import Problem
from ...search.assemble_front import assemble_front, columns_of_designs, empty_front, objective_ranges
from ...search.candidates import FrontCandidates
from ...search.checkpoints import Cancelled
from ...search.evaluation import Evaluator
from ...search.sample_and_zoom import Archive, Run
from .auto import add_moved_onto_constraints

_LEAST, _MOST_SECONDS, _SHARE = 1.0, 5.0, 0.1
"""Time in which a front is delivered: a tenth of the search, within limits, s."""
_PROJECTING, _ANALYSING = 0.3, 0.7  # fractions of it, to move designs onto the constraints, and to compute quantities
_FUNCTION_TIME = 0.8  # s since the search was asked to stop, after which calls of custom functions are ended
_BATCH = 16  # designs to move at a time
_TRIED = 50  # designs to time first; custom functions get them in one call
_MOST = 1000  # maximum number of designs; selection among more would take longer


def partial_front(problem: Problem, evaluators: list[Evaluator], run: Run, *, silent: bool = False) -> ParetoFront:
    """Return the front of a search's polished designs and of its other designs, moved onto the constraints.

    If this or the quantities of all designs would take longer than a moment, it has fewer designs, evenly spread. A
    long search may take longer, because more would be lost. There are no designs if custom functions do not return in
    time. silent: whether they did not return upon cancellation, and must not be called again.
    """
    begin = time.perf_counter() if run.checkpoints.ended is None else run.checkpoints.ended
    run.checkpoints.close()

    def give_up() -> None:
        if silent or time.perf_counter() - begin > _FUNCTION_TIME:
            raise Cancelled

    try:
        with (
            interrupted_by(give_up, farewell=0.0)
            if any(map(runs_custom_function, problem.own))
            else contextlib.nullcontext()
        ):
            return _assemble_front(problem, evaluators, run)
    except Cancelled:
        return empty_front(problem, evaluators, run, "cancelled", _SLOW)


_SLOW = (
    "cancelled; custom functions were too slow to report the designs found so far; they are kept until the "
    "run continues"
)


def _assemble_front(problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront:
    candidates, archive = run.candidates, run.archive
    seconds = min(max(_LEAST, _SHARE * run.checkpoints.elapsed_seconds), _MOST_SECONDS)
    if len(archive):
        if not candidates.has_free_unknowns.any():
            span = objective_ranges(problem, np.concatenate([archive.values, candidates.values]))
            candidates = candidates.only_enumerated(span)
        _add_archived_designs(problem, evaluators, archive, candidates, _PROJECTING * seconds)
    if not len(candidates):
        return empty_front(problem, evaluators, run, "cancelled", "cancelled before any feasible design was found")
    candidates = candidates[_evenly_spread_rows(candidates.values, _MOST)]
    best = candidates.nondominated_rows()
    rows = best[_evenly_spread_rows(candidates.values[best], problem.settings.designs)]
    rows = _rows_computable_in_time(problem, evaluators, candidates, rows, _ANALYSING * seconds)
    return assemble_front(problem, evaluators, candidates, run, rows)


def _add_archived_designs(
    problem: Problem, evaluators: list[Evaluator], archive: Archive, candidates: FrontCandidates, seconds: float
) -> None:
    """Add designs of an archive, moved onto the constraints, unless a polished design is better."""
    polished = candidates.values[candidates.has_free_unknowns]
    groups = (group[_undominated_rows(group.values, polished)] for group in archive.feasible_and_infeasible())
    # Designs that need no move come first.
    first, *rest = (group[_evenly_spread_rows(group.values, problem.settings.designs)] for group in groups)
    chosen = first.join(*rest)
    end = np.inf
    # Each batch is spread over the whole front.
    batches = -(-len(chosen) // _BATCH)
    for begin in range(batches):
        add_moved_onto_constraints(candidates, chosen[begin::batches], evaluators)
        if begin == 0:  # which may have loaded kernels
            end = time.perf_counter() + seconds
        if len(candidates) and time.perf_counter() > end:
            break


def _undominated_rows(values: Array, rivals: Array) -> IntArray:
    """Return the rows of objectives (n, m) that no rival (k, m) dominates; all rows if there are no rivals."""
    if not len(rivals):
        return np.arange(len(values))
    rows = nondominated(np.concatenate([rivals, values])) - len(rivals)
    return rows[rows >= 0]


def _rows_computable_in_time(
    problem: Problem, evaluators: list[Evaluator], candidates: FrontCandidates, rows: IntArray, seconds: float
) -> IntArray:
    """Return the rows whose quantities can be computed in a time, usually all of them."""
    count = _TRIED if any(map(runs_custom_function, problem.own)) else 1
    seconds_per_design, end = 1e-9, time.perf_counter() + 0.5 * seconds
    while count <= _TRIED and count < len(rows) and (begin := time.perf_counter()) < end:
        sample = candidates[rows[:: -(-len(rows) // count)]]
        variants = np.array([evaluators[index].branch.variant for index in sample.branch], dtype=np.int64)
        columns_of_designs(problem, variants, sample.dimensions(evaluators))
        count, seconds_per_design = 2 * count, (time.perf_counter() - begin) / len(sample)
    return rows[_evenly_spread_rows(candidates.values[rows], max(1, int(seconds / seconds_per_design)))]


def _evenly_spread_rows(values: Array, count: int) -> IntArray:
    """Return at most `count` rows of objectives (n, m), always with the best in each.

    Spread over the first objective.
    """
    if len(values) <= count:
        return np.arange(len(values))
    best = np.argmin(values, axis=0)
    order = np.argsort(values[:, 0], kind="stable")
    evenly = order[np.linspace(0, len(order) - 1, max(0, count - len(best))).astype(int)]
    return np.unique(np.concatenate([best, evenly]))
