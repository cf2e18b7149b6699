"""The search's first half: many screened designs, first everywhere, then around sparse parts of the front."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .evaluation import FEASIBLE, Evaluator
from .front import Progress
from .hypervolume import hypervolume, nondominated, scaling
from .problem import Problem
from .sampling import around, first_samples, generator
from .stationarity import Array

SAMPLES = 4096
"""Designs of a round."""
WIDTHS = (0.1, 0.05, 0.02, 0.01)
"""Spread of the zoom rounds, in the unit box."""
_CROWD = 2000  # parents of a round

Callback = Callable[[Progress], None]


@dataclass
class Archive:
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
class Run:
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


def explore(problem: Problem, evaluators: list[Evaluator], run: Run | None = None) -> Archive:
    """Return the archive of non-dominated screened designs: first samples, then zooms."""
    run = run or Run(problem, None, None, 1 + len(WIDTHS))
    archive = Archive(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, len(problem.objectives))))
    samples = problem.settings.samples or SAMPLES
    for attempt in range(3):
        # A small feasible region wants more points before it is given up.
        for index, evaluator in enumerate(evaluators):
            count = -(-samples * 8**attempt // len(evaluators))
            points = first_samples(count, evaluator.dimension, problem.settings.seed, index)
            screen_into(archive, index, evaluator, points)
        if len(archive.u) or run.stop():
            break
    run.tell("sampling", evaluators, archive.feasible, volume(archive.values))
    if len(archive.u):
        zoom(problem, evaluators, archive, run)
    return archive


def zoom(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> None:
    """Sample around sparse parts of the front, closer in every round."""
    samples = problem.settings.samples or SAMPLES
    for step in range(len(WIDTHS)):
        if run.stop():
            return
        random = generator(problem.settings.seed, 1000, step)
        some = random.choice(len(archive.u), _CROWD, replace=False) if len(archive.u) > _CROWD else slice(None)
        parents, values, of = archive.u[some], archive.values[some], archive.sheet[some]
        for index, evaluator in enumerate(evaluators):
            own = of == index
            if own.any() and evaluator.dimension:
                count = max(1, int(samples * own.mean()))
                points = around(parents[own][:, : evaluator.dimension], values[own], count, WIDTHS[step], random)
                screen_into(archive, index, evaluator, points)
        run.tell("zooming", evaluators, archive.feasible, volume(archive.values))


def screen_into(archive: Archive, index: int, evaluator: Evaluator, u: Array) -> None:
    """Screen points of one sheet and put the feasible ones into the archive."""
    _, objectives, violation = evaluator.screen(u)
    good = violation <= FEASIBLE
    archive.add(index, u[good], objectives[good])


def volume(values: Array) -> float:
    """Return the hypervolume of designs in their own scaling; of a part of them where they are many."""
    if not len(values):
        return 0.0
    ideal, span = scaling(values)
    return hypervolume(values[:: 1 + len(values) // 400], ideal, span)
