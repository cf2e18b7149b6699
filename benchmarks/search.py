"""Processor time to the front and its quality, against peers on the same kernel and reduced problem.

That of all threads: ours take turns on all cores, for which no credit is given, as the load of a machine would decide.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import dropwhile
from time import process_time

import numpy as np

from slidercrank.optimise.front.dominance import nondominated
from slidercrank.optimise.front.hypervolume import hypervolume, ideal_and_range
from slidercrank.optimise.job import load_job
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.search.sample_and_zoom import sample_and_zoom
from slidercrank.optimise.solve import solve

from .machines import Array
from .peers import EVALUATIONS, MOEAD, NSGA2_, NSGA3_, run_peer
from .report import Row

_SOONER = {NSGA2_: 40.0, NSGA3_: 20.0, MOEAD: 1.5}
"""How many times sooner the archive of each peer is reached, at least."""
_ROUNDS = tuple(round(256 * 1.19**step) for step in range(24))
_DESIGNS = 100


def _archive(name: str, problem: Problem, span: Array, seed: int) -> tuple[float, Array, Array]:
    """Return seconds, non-dominated archive and last population of a peer."""
    last = np.zeros((0, len(problem.objectives)))

    def generation(values: Array) -> None:
        nonlocal last
        last = values

    begin = process_time()
    reduced = run_peer(name, problem, span, generation, seed=seed)
    seconds = process_time() - begin - reduced.keeping
    seen = np.concatenate(reduced.seen)
    return seconds, seen[nondominated(seen)], last


def _explored(problem: Problem) -> list[tuple[float, Array]]:
    """Return seconds and feasible archive of searches with more and more samples."""
    found = []
    for samples in _ROUNDS:
        sized = replace(problem, settings=replace(problem.settings, samples=samples))
        times = []
        for _ in range(3):
            begin = process_time()
            archive = sample_and_zoom(sized, [Evaluator(sized, branch) for branch in elimination_branches(sized)])
            times.append(process_time() - begin)
        found.append((min(times), archive.values[archive.is_feasible]))
    return found


def _least(ours: list[tuple[float, Array]], wanted: float, ideal: Array, range_: Array) -> float:
    """Return the least time of the searches from the first on that reaches a hypervolume."""
    reached = dropwhile(lambda search: hypervolume(search[1], ideal, range_) < wanted, ours)
    return min((seconds for seconds, _ in reached), default=math.inf)


def compare(job: str, seeds: tuple[int, ...] = (1, 2, 3, 4, 5)) -> list[Row]:
    """Return how many times sooner the same archive hypervolume is reached, and ratios of delivered hypervolumes."""
    given = load_job(job)
    sooner: dict[str, list[float]] = {name: [] for name in _SOONER}
    delivered = []
    _explored(given)  # compiles
    for seed in seeds:
        problem = replace(given, settings=replace(given.settings, seed=seed, designs=_DESIGNS))
        front = solve(problem)
        _, span = ideal_and_range(front.values)
        ours = _explored(problem)
        for name in _SOONER:
            seconds, archive, population = _archive(name, problem, span, seed)
            together = np.concatenate([archive, *(values for _, values in ours)])
            ideal, range_ = ideal_and_range(together[nondominated(together)])
            wanted = hypervolume(archive, ideal, range_)
            sooner[name].append(seconds / _least(ours, wanted, ideal, range_))
            if name == NSGA2_:
                delivered.append(hypervolume(front.values, ideal, range_) / hypervolume(population, ideal, range_))
    name = given.name
    return [
        *(
            Row(f"{name}: equal archive hypervolume, {peer} ({EVALUATIONS:,} evaluations) / ours", times, at_least=most)
            for (peer, times), most in zip(sooner.items(), _SOONER.values(), strict=True)
        ),
        Row(f"{name}: hypervolume of 100 delivered designs / NSGA-II's population of 100", delivered, at_least=1.0),
    ]
