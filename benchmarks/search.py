"""Time to the front and its quality, against pymoo's NSGA-II on the same kernel and reduced problem."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize

from slidercrank.optimise.front.hypervolume import hypervolume, nondominated, scaling
from slidercrank.optimise.job import load_job
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import sheets
from slidercrank.optimise.search.evaluation import FEASIBLE, Evaluator
from slidercrank.optimise.search.search import explore
from slidercrank.optimise.solve import solve

from .machines import Array
from .report import Row

EVALUATIONS = 20_000
_ROUNDS = (1024, 2048, 3072, 4096, 5120, 6144, 8192, 12288)


class _Reduced(PymooProblem):  # type: ignore[misc]
    """The reduced problem as pymoo wants it; keeps all feasible designs and leaves that out of the time."""

    def __init__(self, evaluator: Evaluator) -> None:
        super().__init__(
            n_var=evaluator.dimension, n_obj=len(evaluator.problem.objectives), n_ieq_constr=1, xl=0.0, xu=1.0
        )
        self.evaluator = evaluator
        self.archive: list[Array] = []
        self.keeping = 0.0

    def _evaluate(self, x: Array, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
        _, objectives, violation = self.evaluator.screen(x)
        begin = perf_counter()
        self.archive.append(objectives[violation <= FEASIBLE])
        self.keeping += perf_counter() - begin
        out["F"] = np.where(np.isfinite(objectives), objectives, 1e9)
        out["G"] = np.where(np.isfinite(violation), violation, 1e3)[:, None]


def _nsga2(problem: Problem, seed: int) -> tuple[float, Array, Array]:
    """Return seconds, non-dominated archive and final population of NSGA-II."""
    reduced = _Reduced(Evaluator(problem, sheets(problem)[0]))
    begin = perf_counter()
    result = minimize(reduced, NSGA2(pop_size=100), ("n_eval", EVALUATIONS), seed=seed, verbose=False)
    seconds = perf_counter() - begin - reduced.keeping
    archive = np.concatenate(reduced.archive)
    return seconds, archive[nondominated(archive)], np.atleast_2d(result.F)


def compare(job: str, seeds: tuple[int, ...] = (1, 2, 3, 4, 5)) -> list[Row]:
    """Return how many times sooner the same archive hypervolume is reached, and the ratio of delivered hypervolumes."""
    given = load_job(job)
    sooner, delivered = [], []
    explore(given, [Evaluator(given, sheet) for sheet in sheets(given)])  # compiles
    for seed in seeds:
        problem = replace(given, settings=replace(given.settings, seed=seed, designs=100))
        seconds, archive, population = _nsga2(problem, seed)
        front = solve(problem)
        ours = []
        for samples in _ROUNDS:
            sized = replace(problem, settings=replace(problem.settings, samples=samples))
            times = []
            for _ in range(3):
                begin = perf_counter()
                found = explore(sized, [Evaluator(sized, sheet) for sheet in sheets(sized)])
                times.append(perf_counter() - begin)
            ours.append((min(times), found.values))
        together = np.concatenate([archive, *(values for _, values in ours)])
        ideal, span = scaling(together[nondominated(together)])
        wanted = hypervolume(archive, ideal, span)
        reached = [time for time, values in ours if hypervolume(values, ideal, span) >= wanted]
        sooner.append(seconds / min(reached) if reached else 0.0)
        delivered.append(hypervolume(front.values, ideal, span) / hypervolume(population, ideal, span))
    name = given.name
    return [
        Row(f"{name}: equal archive hypervolume, NSGA-II ({EVALUATIONS:,} evaluations) / ours", sooner, at_least=20.0),
        Row(f"{name}: hypervolume of 100 delivered designs / NSGA-II's population of 100", delivered, at_least=1.0),
    ]
