"""The search's second half: polish candidates, fill the gaps that they leave, choose what to deliver."""

from __future__ import annotations

import time

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ..objectives.analysis import analyse
from .challenge import by_sheet, challengers
from .evaluation import Evaluator, constraints_of
from .front import ParetoFront, Status
from .gradients import without_gradient
from .hypervolume import choose, hypervolume, scaling
from .identity import versions
from .pile import STATIONARY, Pile
from .problem import Problem, choice_field
from .recorded import polished, projected
from .sampling import apart
from .search import Archive, Run
from .stationarity import Array, multipliers

ROUNDS = 4
"""Rounds of the polish: the later ones fill gaps that the first one leaves."""
BATCH = 64
"""Designs polished between two questions whether to stop."""
_POOL = 2000  # greedy choice among more would take longer than it gains
_STARTS = 24  # for the best value of a single objective
_EXTREMES = 6  # for the best value of one objective among several
_MOMENT = 0.3  # s, for designs of a search that was told to end
_BATCH = 16  # of these at a time


def deliver(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the designs of an archive; None if no candidate could be made feasible."""
    pile = Pile(span_of(problem, archive.values))
    several = len(problem.objectives) > 1
    rows = _choice(problem, archive) if several else _spread(archive, 0, _STARTS)
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
        starts = challengers(problem, evaluators, archive, pile, attempt)
        if not starts:
            break
    if not len(pile):
        return None
    return _assemble(problem, evaluators, pile, run, "done")


def as_found(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront | None:
    """Return the front from the designs of an archive as they are, moved no more than onto the constraints.

    None if no design could be moved there. Designs that meet the constraints already are not touched.
    """
    pile = Pile(span_of(problem, archive.values))
    rows = _choice(problem, archive) if len(problem.objectives) > 1 else np.arange(min(len(archive), _STARTS))
    for index, u in by_sheet(evaluators, archive.sheet, archive.u, rows):
        valid = u[evaluators[index].valid(u)]
        pile.add(index, evaluators[index], projected(evaluators[index], valid, pile.span))
    if not len(pile):
        return None
    return _assemble(problem, evaluators, pile, run, "done")


def so_far(problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront:
    """Return the front of what a search has found that was told to end: what it has polished, else as it was found.

    Takes in no more than what a moment is enough for, the best of each objective first.
    """
    run.ledger.close()
    pile, archive = run.pile, run.archive
    if (pile is None or not len(pile)) and archive is not None and len(archive):
        pile = Pile(span_of(problem, archive.values))
        end = time.perf_counter() + _MOMENT
        for rows in _batches(archive, _choice(problem, archive)):
            for index, u in by_sheet(evaluators, archive.sheet, archive.u, rows):
                valid = u[evaluators[index].valid(u)]
                pile.add(index, evaluators[index], projected(evaluators[index], valid, pile.span))
            if len(pile) and time.perf_counter() > end:
                break
    if pile is None or not len(pile):
        return empty(problem, evaluators, run, "cancelled", "cancelled before any feasible design was found")
    return _assemble(problem, evaluators, pile, run, "cancelled")


def _batches(archive: Archive, rows: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Return rows of an archive in batches, the best of each objective first."""
    best = np.argmin(archive.values[rows], axis=0)
    order = np.array(list(dict.fromkeys([*best.tolist(), *range(len(rows))])), dtype=np.int64)
    return np.split(rows[order], range(_BATCH, len(rows), _BATCH))


def span_of(problem: Problem, values: Array) -> Array:
    """Return the ranges (m,) that objectives (n, m) are scaled by; sizes where a single objective has no front."""
    _, span = scaling(values)
    sizes = np.array([abs(objective.target or 0.0) for objective in problem.objectives])
    if values.shape[1] == 1:
        best = np.abs(values.min(axis=0))
        return np.asarray(np.maximum(np.maximum(best, sizes), np.ptp(values, axis=0)) + 1e-300)
    # A target that the whole front meets has no range but rounding.
    return np.maximum(span, 1e-6 * sizes)


def _candidates(problem: Problem) -> int:
    return max(16, int(1.3 * problem.settings.designs))


def planned(problem: Problem) -> int:
    """Return how many batches the polish takes if nothing needs filling."""
    return -(-_candidates(problem) // BATCH)


def _choice(problem: Problem, archive: Archive) -> NDArray[np.int64]:
    """Return the rows of the archive whose polish is to become the front."""
    best = np.argmin(archive.values, axis=0)
    rows = np.arange(len(archive))
    if len(rows) > _POOL:
        rows = np.unique(np.concatenate([np.linspace(0, len(rows) - 1, _POOL).astype(int), best]))
    always = tuple(int(np.flatnonzero(rows == row)[0]) for row in dict.fromkeys(best.tolist()))
    return rows[choose(archive.values[rows], _candidates(problem), always=always)]


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


def _assemble(problem: Problem, evaluators: list[Evaluator], pile: Pile, run: Run, status: Status) -> ParetoFront:
    rows = pile.best()
    if len(problem.objectives) > 1:
        best = tuple(dict.fromkeys(np.argmin(pile.values[rows], axis=0).tolist()))
        rows = rows[choose(pile.values[rows], problem.settings.designs, always=best)]
    values = pile.values[rows]
    rows = rows[np.lexsort(values.T[::-1])]
    values, dimensions = pile.values[rows], pile.dimensions[rows]
    span = span_of(problem, values) if len(rows) > 1 else pile.span
    goals = [pile.goals[row] for row in rows]
    active = [pile.active[row] for row in rows]
    residual = np.array(
        [
            multipliers(slopes * (pile.span / span)[owner.astype(int)][:, None], edges)[0]
            for (owner, slopes), edges in zip(goals, active, strict=True)
        ]
    )
    if without_gradient(problem):  # nothing is known of slopes: neither whether a design is optimal nor its rates
        residual[:] = np.inf
        goals = [(owner, slopes[:, :0]) for owner, slopes in goals]
        active = [edges[:, :0] for edges in active]
    variants = np.array([evaluators[index].sheet.variant for index in pile.sheet[rows]], dtype=np.int64)
    table = _table(problem, variants, dimensions)
    table["residual"] = residual
    table["status"] = np.where(residual <= STATIONARY, "stationary", "best found")
    evaluations = sum(evaluator.evaluations for evaluator in evaluators)
    message = f"{len(rows)} design{'s' if len(rows) != 1 else ''}, {evaluations} evaluated"
    if status == "cancelled":
        message = f"cancelled: {message}, the front may be incomplete"
    ideal = values.min(axis=0)
    return ParetoFront(
        problem=problem,
        status=status,
        message=message,
        designs=table,
        dimensions=dimensions,
        values=values,
        goals=tuple((owner, slopes * pile.span[owner.astype(int)][:, None]) for owner, slopes in goals),
        active=tuple(active),
        hypervolume=hypervolume(values, ideal, span),
        history=run.history(ideal, span),
        evaluations=evaluations,
        seconds=run.ledger.seconds,
        seed=problem.settings.seed,
        versions=versions(),
        variants=tuple(variants.tolist()) if problem.variants else (),
    )


def _table(problem: Problem, variants: NDArray[np.int64], dimensions: Array) -> pd.DataFrame:
    """Return all quantities of designs and what was chosen for them, with the slacks of their constraints."""
    parts = []
    for variant in np.unique(variants).tolist():
        rows = np.flatnonzero(variants == variant)
        part = problem.part(variant)
        table = analyse(part.mechanism, dimensions[rows], own=problem.own)
        _slacks(table, part, dimensions[rows])
        for place, name in enumerate(problem.choices):
            label = problem.variants[variant].labels[place]
            table.insert(list(table.columns).index("stroke_mm"), choice_field(name), label)
        parts.append(table.set_index(rows))
    return parts[0] if len(parts) == 1 else pd.concat(parts).sort_index()


def _slacks(table: pd.DataFrame, problem: Problem, dimensions: Array) -> None:
    for constraint in constraints_of(problem):
        quantity = problem.quantity(constraint.quantity)
        values = quantity.evaluate(problem.mechanism, dimensions).values
        slack = np.full(len(values), np.inf)
        if constraint.equality:
            slack = -np.abs(values - float(constraint.lower or 0.0))
        else:
            if constraint.upper is not None:
                slack = np.minimum(slack, constraint.upper - values)
            if constraint.lower is not None:
                slack = np.minimum(slack, values - constraint.lower)
        table[f"slack_{quantity.field}"] = slack * quantity.unit.factor + 0.0  # no negative zero


def empty(problem: Problem, evaluators: list[Evaluator], run: Run, status: Status, message: str) -> ParetoFront:
    """Return a front without designs, which says why."""
    m = len(problem.objectives)
    return ParetoFront(
        problem=problem,
        status=status,
        message=message,
        designs=pd.DataFrame(),
        dimensions=np.zeros((0, 3)),
        values=np.zeros((0, m)),
        goals=(),
        active=(),
        hypervolume=0.0,
        history=tuple(run.told),
        evaluations=sum(evaluator.evaluations for evaluator in evaluators),
        seconds=run.ledger.seconds,
        seed=problem.settings.seed,
        versions=versions(),
    )


def only(problem: Problem, evaluators: list[Evaluator], pile: Pile, run: Run, row: int) -> ParetoFront:
    """Return a front of one design of the pile; its residual is scaled by the pile's span."""
    single = Pile(pile.span)
    for name in ("sheet", "u", "dimensions", "values", "residual"):
        setattr(single, name, getattr(pile, name)[row : row + 1])
    single.goals, single.active = [pile.goals[row]], [pile.active[row]]
    return _assemble(problem, evaluators, single, run, "done")
