"""Random and Sobol points: the baseline for all other methods."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from ...model.arrays import Array
from ..problem.problem import Problem
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from .population import Brood, Generation, evolve, generation_seed, generation_size
from .registry import Method

Draw = Callable[[int, int, int], Array]

BATCH = 1024
"""Number of designs in a generation if the job sets no number of samples: Sobol points are evenly spread in powers of
two."""


def random(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the designs found by uniformly random points, distributed over the branches at random."""

    def draw(generation: int, size: int, dimension: int) -> Array:
        return np.random.default_rng(generation_seed(problem.settings.seed, generation)).random((size, dimension))

    return _search_by_draws(problem, evaluators, run, draw)


def sobol(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the designs found by one scrambled Sobol sequence; one coordinate selects among several branches."""
    from scipy.stats import qmc

    def draw(generation: int, size: int, dimension: int) -> Array:
        sequence = qmc.Sobol(dimension, rng=np.random.default_rng(problem.settings.seed))
        if not generation:  # rounded up to a power of two, because SciPy warns otherwise
            return np.asarray(sequence.random_base2((size - 1).bit_length())[:size])
        sequence.fast_forward(generation * size)
        return np.asarray(sequence.random(size))

    return _search_by_draws(problem, evaluators, run, draw)


def _search_by_draws(problem: Problem, evaluators: list[Evaluator], run: Run, draw: Draw) -> Archive:
    size = generation_size(problem, BATCH)
    dimension, several = max(evaluator.dimension for evaluator in evaluators), len(evaluators) > 1

    def breed(past: Sequence[Generation]) -> Brood:
        points = draw(len(past), size, dimension + several)
        chosen = np.floor(points[:, -1] * len(evaluators)).astype(np.int64) if several else np.zeros(size, np.int64)
        return Brood(chosen, points[:, :dimension])

    return evolve(problem, evaluators, run, breed, size=size)


_baseline = partial(Method, family="sampling", objectives="any", budget=20_000, gradients=False)
RANDOM = _baseline(
    name="random",
    title="Random points",
    help="Uniformly random points: a baseline that every other method should beat.",
    search=random,
)
SOBOL = _baseline(
    name="sobol",
    title="Sobol points",
    help="One scrambled Sobol sequence: a baseline that every other method should beat.",
    search=sobol,
    uses=("scipy",),
)
