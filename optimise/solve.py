"""The default search: eliminate, sample, zoom, polish, choose."""

from __future__ import annotations

import time
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from platform import python_version

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ..model.errors import InputError
from ..objectives.analysis import analyse
from ..objectives.registry import QUANTITIES
from .elimination import UNKNOWNS, ZERO, Sheet, sheets
from .evaluation import FEASIBLE, Evaluator, constraints_of
from .front import ParetoFront, Status
from .hypervolume import choose, hypervolume, nondominated, scaling
from .infeasibility import diagnose
from .polish import Polished, polish
from .problem import Problem
from .search import WIDTHS, Archive, Callback, Run, explore, screen_into, volume, zoom
from .stationarity import Array, multipliers

STATIONARY = 1e-6
"""Residual, objectives scaled by their range, below which a design counts as stationary."""
_BATCH = 64


def solve(
    problem: Problem, *, progress: Callback | None = None, cancelled: Callable[[], bool] | None = None
) -> ParetoFront:
    """Return the Pareto front of a problem.

    progress: called after every round. cancelled: asked between rounds; when it says so, what was found so far is
    returned with status "cancelled". The same problem with the same seed gives the same designs, bit for bit.
    """
    if problem.settings.method != "auto":
        raise InputError(f"the method must be 'auto'; got {problem.settings.method!r}")
    evaluators = [Evaluator(problem, sheet) for sheet in sheets(problem)]
    batches = -(-_candidates(problem) // _BATCH)
    run = Run(problem, progress, cancelled, 1 + len(WIDTHS) + batches)
    archive = explore(problem, evaluators, run)
    if not len(archive.u):
        if run.stop():
            return _empty(problem, run, evaluators, "cancelled", "cancelled before any feasible design was found")
        diagnosis = diagnose(problem, _best)
        if not len(diagnosis.feasible):
            return _empty(problem, run, evaluators, "infeasible", diagnosis.message)
        _seed(archive, evaluators, diagnosis.feasible)
        if not len(archive.u):
            return _empty(problem, run, evaluators, "infeasible", _thin())
        zoom(problem, evaluators, archive, run)
    return _deliver(problem, evaluators, archive, run)


def _best(problem: Problem) -> float | None:
    """Return the best value (SI) of a problem's only objective, None where nothing is feasible."""
    evaluators = [Evaluator(problem, sheet) for sheet in sheets(problem)]
    run = Run(problem, None, None, 1)
    archive = explore(problem, evaluators, run)
    if not len(archive.u):
        return None
    found = _deliver(problem, evaluators, archive, run)
    if not len(found):
        return None
    quantity = QUANTITIES[problem.objectives[0].quantity]
    return float(quantity.evaluate(problem.mechanism, found.dimensions[:1]).values[0])


def _seed(archive: Archive, evaluators: list[Evaluator], dimensions: Array) -> None:
    """Put designs found by the feasibility search into the archive, in the coordinates of their sheet."""
    for index, evaluator in enumerate(evaluators):
        sheet = evaluator.sheet
        own = dimensions[np.sign(dimensions[:, 2]) != -sheet.sign]
        if len(own):
            screen_into(archive, index, evaluator, _coordinates(sheet, own))


def _coordinates(sheet: Sheet, dimensions: Array) -> Array:
    columns = [np.abs(dimensions[:, UNKNOWNS.index(name)]) for name in sheet.free]
    u = np.stack(columns, axis=1) if columns else np.zeros((len(dimensions), 0))
    return np.clip((u - sheet.lower) / np.where(sheet.upper > sheet.lower, sheet.upper - sheet.lower, 1.0), 0.0, 1.0)


def _candidates(problem: Problem) -> int:
    return max(16, int(1.3 * problem.settings.designs))


def _deliver(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> ParetoFront:
    """Polish candidates, keep what is non-dominated, and choose the designs to deliver."""
    m = len(problem.objectives)
    _, span = scaling(archive.values)
    best = tuple(int(np.argmin(archive.values[:, column])) for column in range(m))
    pool = archive.u, archive.values, archive.sheet
    if len(archive.u) > 2000:  # greedy choice among all would take longer than it gains
        thin = np.unique(np.concatenate([np.linspace(0, len(archive.u) - 1, 2000).astype(int), best]))
        pool = archive.u[thin], archive.values[thin], archive.sheet[thin]
        best = tuple(int(np.argmin(pool[1][:, column])) for column in range(m))
    rows = choose(pool[1], _candidates(problem), always=best) if m > 1 else np.argsort(pool[1][:, 0])[:16]
    u, of = pool[0][rows], pool[2][rows]
    parts: list[tuple[int, Polished]] = []
    status: Status = "done"
    for index, evaluator in enumerate(evaluators):
        k = evaluator.dimension
        own = u[of == index][:, :k]
        if m > 1 and len(own):
            own = np.concatenate([own, *_extremes(evaluator, pool, index, span)])
        for begin in range(0, len(own), _BATCH):
            if run.stop():
                status = "cancelled"
                break
            parts.append((index, polish(evaluator, own[begin : begin + _BATCH], span)))
            values = np.concatenate([part.values for _, part in parts]) * span
            run.tell("polishing", evaluators, archive.feasible, volume(values[nondominated(values)]))
    if run.stop():
        status = "cancelled"
    if not parts:  # cancelled before the first batch: what was screened, as it is
        first = int(of[0])
        some = u[of == first][:_BATCH, : evaluators[first].dimension]
        parts.append((first, polish(evaluators[first], some, span, iterations=0)))
    return _assemble(problem, evaluators, parts, archive, span, run, status)


def _extremes(
    evaluator: Evaluator, pool: tuple[Array, Array, NDArray[np.int64]], index: int, span: Array
) -> list[Array]:
    """Return, for each objective, designs improved in it alone from the best screened ones."""
    own = pool[2] == index
    u, values = pool[0][own][:, : evaluator.dimension], pool[1][own]
    return [
        polish(evaluator, u[np.argsort(values[:, column], kind="stable")[:3]], span, chosen=(column,)).u
        for column in range(values.shape[1])
    ]


def _assemble(
    problem: Problem,
    evaluators: list[Evaluator],
    parts: list[tuple[int, Polished]],
    archive: Archive,
    span: Array,
    run: Run,
    status: Status,
) -> ParetoFront:
    m = len(problem.objectives)
    dimensions = np.concatenate([evaluators[index].sheet.dimensions(part.u) for index, part in parts])
    dimensions = np.where(np.abs(dimensions) <= ZERO, 0.0, dimensions)
    values = np.concatenate([part.values for _, part in parts]) * span
    residual = np.concatenate([part.residual for _, part in parts])
    violation = np.concatenate([part.violation for _, part in parts])
    goals = [item for _, part in parts for item in part.goals]
    active = [item for _, part in parts for item in part.active]
    rows = np.flatnonzero(violation <= FEASIBLE)
    if not len(rows):
        return _empty(problem, run, evaluators, "infeasible", _thin())
    stationary = rows[residual[rows] <= STATIONARY]
    if len(stationary):
        rows = stationary
    rows = rows[_distinct(dimensions[rows])]
    rows = rows[nondominated(values[rows])]
    best = tuple(int(np.argmin(values[rows][:, column])) for column in range(m))
    rows = rows[choose(values[rows], problem.settings.designs, always=best)] if m > 1 else rows[:1]
    rows = rows[np.lexsort(values[rows].T[::-1])]
    ideal, final = scaling(values[rows])
    residual = np.array([_rescaled(goals[row], active[row], span, final, m) for row in rows])
    table = analyse(problem.mechanism, dimensions[rows])
    _slacks(table, problem, dimensions[rows])
    table["residual"] = residual
    table["status"] = np.where(residual <= STATIONARY, "stationary", "best found")
    evaluations = sum(evaluator.evaluations for evaluator in evaluators)
    count = len(rows)
    message = f"{count} design{'s' if count != 1 else ''}, {evaluations} evaluated"
    if status == "cancelled":
        message = f"cancelled: {message}, the front may be incomplete"
    return ParetoFront(
        problem=problem,
        status=status,
        message=message,
        designs=table,
        dimensions=dimensions[rows],
        values=values[rows],
        goals=tuple((goals[row][0], goals[row][1] * span[goals[row][0].astype(int)][:, None]) for row in rows),
        active=tuple(active[row] for row in rows),
        hypervolume=hypervolume(values[rows], ideal, final),
        history=tuple(run.history),
        evaluations=evaluations,
        seconds=time.perf_counter() - run.start,
        seed=problem.settings.seed,
        versions=versions(),
    )


def _distinct(dimensions: Array) -> NDArray[np.int64]:
    """Return one index of each group of designs that agree to 1e-7."""
    size = np.abs(dimensions).max(axis=0)
    _, first = np.unique(np.round(dimensions / np.where(size > 0.0, size, 1.0), 7), axis=0, return_index=True)
    return np.sort(first)


def _rescaled(goals: tuple[Array, Array], active: Array, span: Array, final: Array, m: int) -> float:
    """Residual with the objectives scaled by their range over the delivered front."""
    owner = goals[0].astype(int)
    return multipliers(goals[1] * (span / final)[owner][:, None], active)[0]


def _slacks(table: pd.DataFrame, problem: Problem, dimensions: Array) -> None:
    for constraint in constraints_of(problem):
        quantity = QUANTITIES[constraint.quantity]
        values = quantity.evaluate(problem.mechanism, dimensions).values
        if constraint.equality:
            slack = -np.abs(values - float(constraint.lower or 0.0))
        else:
            upper = np.inf if constraint.upper is None else constraint.upper
            lower = -np.inf if constraint.lower is None else constraint.lower
            slack = np.minimum(upper - values, values - lower)
        table[f"slack_{quantity.field}"] = slack * quantity.unit.factor + 0.0  # no negative zero


def _empty(problem: Problem, run: Run, evaluators: list[Evaluator], status: Status, message: str) -> ParetoFront:
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
        history=tuple(run.history),
        evaluations=sum(evaluator.evaluations for evaluator in evaluators),
        seconds=time.perf_counter() - run.start,
        seed=problem.settings.seed,
        versions=versions(),
    )


def _thin() -> str:
    return (
        "designs that meet all requirements to rounding exist, but none that meets the equalities exactly; "
        "widen the ranges a little"
    )


def versions() -> dict[str, str]:
    """Return the versions of this software and of what computes its numbers."""
    found = {"python": python_version()}
    for name in ("slidercrank", "numpy", "scipy", "numba", "moocore", "pandas"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "unknown"
    return found
