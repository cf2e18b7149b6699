"""CMA-ES: one objective, continuous coordinates, and a normal distribution that learns the shape of the objective.

    N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, 2016
    A. Auger, N. Hansen, "A restart CMA evolution strategy with increasing population size", IEEE CEC 2005

Once converged, it restarts elsewhere with twice the population. Each branch has a separate search, in turn: a normal
distribution cannot span two. Only ranks matter, so constraints enter as ranks: feasible designs come first, by
objective, then the others by violation.

This uses the `cmaes` package directly, because Optuna's sampler ignores constraints and stores the state as a pickle
with every trial. The same generations lead to the same state again, so nothing else needs to be stored.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...model.arrays import Array
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..search.candidates import stack_rows
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from .population import Brood, Generation, evolve, generation_seed, generation_size
from .registry import Method

STEP = 0.3
"""Initial standard deviation in the unit box: the optimum is expected within about two of them from the centre."""
_CONVERGED = 1e-10
"""Extent of a generation in the unit box at which a search ends."""
_FLAT = 1e-14
"""Relative extent of its objectives at which it ends: below this, ranks are rounding."""
_RESTART = 1_000_000  # random stream beyond those of any generation


def cmaes(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the designs that CMA-ES with restarts finds for the problem's only objective."""
    seed, widest = problem.settings.seed, max(evaluator.dimension for evaluator in evaluators)
    default = 4 + math.floor(3.0 * math.log(widest))
    size = max(4, generation_size(problem, default))
    climbs = [_Climb(index, evaluator.dimension, size, seed) for index, evaluator in enumerate(evaluators)]

    def breed(past: Sequence[Generation]) -> Brood:
        climb = climbs[len(past) % len(climbs)]
        for generation in past[climb.index :: len(climbs)][climb.generations :]:
            climb.learn(generation)
        u = climb.ask(generation_seed(seed, len(past)))
        return Brood(np.full(len(u), climb.index), stack_rows(np.zeros((0, widest)), u))

    return evolve(problem, evaluators, run, breed, size=size)


class _Climb:
    """The search on one branch: a distribution that learns from the values of its points, with restarts."""

    def __init__(self, index: int, dimension: int, size: int, seed: int) -> None:
        self.index, self.dimension, self.size, self.seed = index, dimension, size, seed
        self.starts, self.generations = 0, 0
        self.begin()

    def begin(self) -> None:
        """Start from the centre the first time, then from a random point."""
        from cmaes import CMA

        random = np.random.default_rng(np.random.SeedSequence([self.seed, _RESTART, self.index, self.starts]))
        mean = random.random(self.dimension) if self.starts else np.full(self.dimension, 0.5)
        bounds = np.tile([0.0, 1.0], (self.dimension, 1))
        self.optimiser = CMA(mean=mean, sigma=STEP, bounds=bounds, population_size=self.size)
        self.starts += 1

    def ask(self, seed: int) -> Array:
        """Return the points (n, k) of the next generation."""
        self.optimiser.reseed_rng(seed)
        return np.array([self.optimiser.ask() for _ in range(self.optimiser.population_size)])

    def learn(self, generation: Generation) -> None:
        """Learn from the values of a generation."""
        self.generations += 1
        u, values = generation.u[:, : self.dimension], generation.values[:, 0]
        excess = np.where(generation.violation <= FEASIBLE, 0.0, generation.violation)
        if np.isinf(excess).all():  # there is nothing to rank
            self.begin()
            return
        ranks = np.empty(len(u))
        ranks[np.lexsort([values, excess])] = np.arange(len(u))
        self.optimiser.tell([(point, float(rank)) for point, rank in zip(u, ranks, strict=True)])
        flat = not excess.any() and np.ptp(values) <= _FLAT * np.abs(values).max()
        if flat or np.ptp(u, axis=0).max() <= _CONVERGED or self.optimiser.should_stop():
            self.size *= 2
            self.begin()


CMAES = Method(
    name="cmaes",
    title="CMA-ES",
    help="Samples a normal distribution that learns the shape of the objective, with restarts.",
    family="model-based",
    objectives="one",
    search=cmaes,
    budget=10_000,
    uses=("cmaes",),
    gradients=False,
)
