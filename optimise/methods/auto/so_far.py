"""The front so far of a search that was told to end, delivered within a moment."""

from __future__ import annotations

import contextlib
import time

import numpy as np
from numpy.typing import NDArray

from ....objectives.own.interruption import interrupted_by
from ....objectives.own.quantity import runs_own
from ...front.front import ParetoFront
from ...front.stationarity import Array
from ...problem.problem import Problem
from ...search.assemble import assemble, empty, span_of, table_of
from ...search.candidates import Pile
from ...search.checkpoints import Cancelled
from ...search.evaluation import Evaluator
from ...search.recorded import projected
from ...search.search import Archive, Run
from .challenge import by_sheet

_PROJECTING = 0.3  # s, for moving designs onto the constraints
_ANALYSING = 0.7  # s, for the quantities of all designs
_OWN = 0.8  # s since the search was told to end, after which no call of an own function goes on
_BATCH = 16  # designs moved at a time
_TRIED = 50  # designs that tell how long all take
_MOST = 1000  # designs: to choose among more would take longer


def so_far(problem: Problem, evaluators: list[Evaluator], run: Run, *, silent: bool = False) -> ParetoFront:
    """Return the front of what a search has polished, else of what it has found, moved onto the constraints.

    Where that or the quantities of all designs would take longer than a moment, it has fewer of them, evenly spread;
    none where functions of the job's own do not return in that time. silent: they did not when the search was told to
    end, and are not asked again.
    """
    begin = time.perf_counter() if run.ledger.ended is None else run.ledger.ended
    run.ledger.close()

    def give_up() -> None:
        if silent or time.perf_counter() - begin > _OWN:
            raise Cancelled

    try:
        with interrupted_by(give_up, farewell=0.0) if any(map(runs_own, problem.own)) else contextlib.nullcontext():
            return _front(problem, evaluators, run)
    except Cancelled:
        return empty(problem, evaluators, run, "cancelled", _SLOW)


_SLOW = (
    "cancelled; functions of its own took too long to tell of what was found, of which all is kept for when it goes on"
)


def _front(problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront:
    pile, archive = run.pile, run.archive
    if archive is not None and len(archive) and (pile is None or not pile.free.any()):
        pile = _as_found(problem, evaluators, archive, pile)
    if pile is None or not len(pile):
        return empty(problem, evaluators, run, "cancelled", "cancelled before any feasible design was found")
    pile = pile.part(_spread(pile.values, _MOST))
    best = pile.best()
    rows = best[_spread(pile.values[best], problem.settings.designs)]
    return assemble(problem, evaluators, pile, run, _soon(problem, evaluators, pile, rows))


def _as_found(problem: Problem, evaluators: list[Evaluator], archive: Archive, settled: Pile | None) -> Pile:
    """Return a pile of the settled designs and of those of an archive, moved onto the constraints."""
    settled = settled or Pile(np.ones(archive.values.shape[1]))
    pile = settled.only_settled(span_of(problem, np.concatenate([archive.values, settled.values])))
    # What needs no move comes first.
    rows = np.concatenate([some[_spread(archive.values[some], problem.settings.designs)] for some in archive.groups()])
    end = time.perf_counter() + _PROJECTING
    # Each batch is spread over the whole front.
    batches = -(-len(rows) // _BATCH)
    for some in (rows[begin::batches] for begin in range(batches)):
        for index, u in by_sheet(evaluators, archive.sheet, archive.u, some):
            valid = u[evaluators[index].valid(u)]
            pile.add(index, evaluators[index], projected(evaluators[index], valid, pile.span))
        if len(pile) and time.perf_counter() > end:
            break
    return pile


def _soon(problem: Problem, evaluators: list[Evaluator], pile: Pile, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return those rows whose quantities are had within a moment, all of them as a rule."""
    if len(rows) <= _TRIED:
        return rows
    some = rows[:: -(-len(rows) // _TRIED)]
    variants = np.array([evaluators[index].sheet.variant for index in pile.sheet[some]], dtype=np.int64)
    begin = time.perf_counter()
    table_of(problem, variants, pile.dimensions[some])
    each = (time.perf_counter() - begin) / len(some)
    return rows[_spread(pile.values[rows], max(1, int(_ANALYSING / each)))]


def _spread(values: Array, count: int) -> NDArray[np.int64]:
    """Return at most `count` rows of objectives (n, m), never fewer than the best of each; spread over the first."""
    if len(values) <= count:
        return np.arange(len(values))
    best = np.argmin(values, axis=0)
    order = np.argsort(values[:, 0], kind="stable")
    evenly = order[np.linspace(0, len(order) - 1, max(0, count - len(best))).astype(int)]
    return np.unique(np.concatenate([best, evenly]))
