"""The default search: eliminate, sample, zoom, polish, choose."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
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
from .front import ParetoFront, Progress, Status
from .hypervolume import choose, hypervolume, nondominated, scaling
from .infeasibility import diagnose
from .polish import Polished, polish
from .problem import Problem
from .sampling import around, first_samples, generator
from .stationarity import Array, multipliers

SAMPLES = 4096
"""Designs of a round."""
ZOOMS = 4
"""Rounds around the front after the first one."""
WIDTHS = (0.1, 0.05, 0.02, 0.01)
"""Spread of the zoom rounds in the unit box."""
STATIONARY = 1e-6
"""Residual, objectives scaled by their range, below which a design counts as stationary."""
_BATCH = 64
_CROWD = 6000

Callback = Callable[[Progress], None]


@dataclass
class _Archive:
    """Non-dominated designs found so far: sheet index, unit-box point (padded to three columns), objectives."""

    sheet: NDArray[np.int64]
    u: Array
    values: Array
    feasible: int = 0

    def add(self, sheet: int, u: Array, values: Array) -> None:
        """Take in feasible designs and drop what is dominated."""
        padded = np.zeros((len(u), 3))
        padded[:, : u.shape[1]] = u
        self.feasible += len(u)
        self.sheet = np.concatenate([self.sheet, np.full(len(u), sheet)])
        self.u = np.concatenate([self.u, padded])
        self.values = np.concatenate([self.values, values])
        self.keep(nondominated(self.values))

    def keep(self, rows: NDArray[np.int64]) -> None:
        """Keep only these rows."""
        self.sheet, self.u, self.values = self.sheet[rows], self.u[rows], self.values[rows]


@dataclass
class _Run:
    """State of one search."""

    problem: Problem
    progress: Callback | None
    cancelled: Callable[[], bool] | None
    rounds: int
    start: float = field(default_factory=time.perf_counter)
    history: list[Progress] = field(default_factory=list)

    def tell(self, stage: str, evaluators: list[Evaluator], feasible: int, volume: float) -> None:
        """Record the end of a round."""
        entry = Progress(
            stage,
            len(self.history) + 1,
            max(self.rounds, len(self.history) + 1),
            sum(evaluator.evaluations for evaluator in evaluators),
            feasible,
            volume,
            time.perf_counter() - self.start,
        )
        self.history.append(entry)
        if self.progress is not None:
            self.progress(entry)

    def stop(self) -> bool:
        """Whether the search is to end after this round."""
        return self.cancelled is not None and self.cancelled()


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
    run = _Run(problem, progress, cancelled, 1 + ZOOMS + batches)
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
    run = _Run(problem, None, None, 1)
    archive = explore(problem, evaluators, run)
    if not len(archive.u):
        return None
    found = _deliver(problem, evaluators, archive, run)
    if not len(found):
        return None
    quantity = QUANTITIES[problem.objectives[0].quantity]
    return float(quantity.evaluate(problem.mechanism, found.dimensions[:1]).values[0])


def explore(problem: Problem, evaluators: list[Evaluator], run: _Run | None = None) -> _Archive:
    """Return the archive of non-dominated screened designs: first samples, then zooms."""
    run = run or _Run(problem, None, None, 1 + ZOOMS)
    archive = _Archive(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, len(problem.objectives))))
    samples = problem.settings.samples or SAMPLES
    for attempt in range(3):
        # A small feasible region wants more points before it is given up.
        for index, evaluator in enumerate(evaluators):
            count = -(-samples * 8**attempt // len(evaluators))
            _screen(archive, index, evaluator, first_samples(count, evaluator.dimension, problem.settings.seed, index))
        if len(archive.u) or run.stop():
            break
    run.tell("sampling", evaluators, archive.feasible, _volume(archive.values))
    if len(archive.u):
        zoom(problem, evaluators, archive, run)
    return archive


def zoom(problem: Problem, evaluators: list[Evaluator], archive: _Archive, run: _Run) -> None:
    """Sample around sparse parts of the front, closer in every round."""
    samples = problem.settings.samples or SAMPLES
    for step in range(ZOOMS):
        if run.stop():
            return
        random = generator(problem.settings.seed, 1000, step)
        if len(archive.u) > _CROWD:
            archive.keep(np.sort(random.choice(len(archive.u), _CROWD, replace=False)))
        parents, values, of = archive.u, archive.values, archive.sheet
        for index, evaluator in enumerate(evaluators):
            own = of == index
            if own.any() and evaluator.dimension:
                count = max(1, int(samples * own.mean()))
                points = around(parents[own][:, : evaluator.dimension], values[own], count, WIDTHS[step], random)
                _screen(archive, index, evaluator, points)
        run.tell("zooming", evaluators, archive.feasible, _volume(archive.values))


def _screen(archive: _Archive, index: int, evaluator: Evaluator, u: Array) -> None:
    _, objectives, violation = evaluator.screen(u)
    good = violation <= FEASIBLE
    archive.add(index, u[good], objectives[good])


def _volume(values: Array) -> float:
    if not len(values):
        return 0.0
    ideal, span = scaling(values)
    return hypervolume(values[:: 1 + len(values) // 2000], ideal, span)


def _seed(archive: _Archive, evaluators: list[Evaluator], dimensions: Array) -> None:
    """Put designs found by the feasibility search into the archive, in the coordinates of their sheet."""
    for index, evaluator in enumerate(evaluators):
        sheet = evaluator.sheet
        own = dimensions[np.sign(dimensions[:, 2]) != -sheet.sign]
        if len(own):
            _screen(archive, index, evaluator, _coordinates(sheet, own))


def _coordinates(sheet: Sheet, dimensions: Array) -> Array:
    columns = [np.abs(dimensions[:, UNKNOWNS.index(name)]) for name in sheet.free]
    u = np.stack(columns, axis=1) if columns else np.zeros((len(dimensions), 0))
    return np.clip((u - sheet.lower) / np.where(sheet.upper > sheet.lower, sheet.upper - sheet.lower, 1.0), 0.0, 1.0)


def _candidates(problem: Problem) -> int:
    return max(16, int(1.3 * problem.settings.designs))


def _deliver(problem: Problem, evaluators: list[Evaluator], archive: _Archive, run: _Run) -> ParetoFront:
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
            run.tell("polishing", evaluators, archive.feasible, _volume(values[nondominated(values)]))
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
    archive: _Archive,
    span: Array,
    run: _Run,
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


def _empty(problem: Problem, run: _Run, evaluators: list[Evaluator], status: Status, message: str) -> ParetoFront:
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
