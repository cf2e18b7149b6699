"""Evolution by generations: breed, evaluate as one batch, store.

A method only defines how to breed a brood from the previous generations. Every brood has its own random numbers, seeded
by the run's seed and the brood's number. It depends only on these generations, so a recorded brood need not be bred
again.

Random and Sobol points, the baseline for all other methods, are broods without parents.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ...model.arrays import Array, IntArray
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..search.candidates import Table
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from .registry import Method, evaluation_budget

Rows = IntArray

BAND = 0.01
"""Relative violation that counts as none if an equality remains, which no sample meets; the delivery removes it."""


@dataclass(frozen=True)
class Brood:
    """Points to evaluate together.

    branch: (n,), index of each point's branch. u: (n, k), points in the unit box; columns beyond a branch's dimension
    are ignored. parents: (p,), rows of the parents, counted over the points of all generations; empty if the method has
    none.
    """

    branch: Rows
    u: Array
    parents: Rows = field(default_factory=lambda: np.zeros(0, np.int64))

    def __len__(self) -> int:
        return len(self.u)


@dataclass
class Generation(Table):
    """The points of a brood with their values.

    branch, u: see `Brood`. values: (n, m) objectives as minimised, SI; NaN where a constraint is violated. violation:
    (n,), greatest relative violation beyond the tolerance (see `BAND`), infinite where no linkage rotates fully.
    parents: parents of the brood.
    """

    branch: Rows
    u: Array
    values: Array
    violation: Array
    parents: Rows = field(kw_only=True)


def generation_seed(seed: int, generation: int) -> int:
    """Return the seed of one generation, independent of all others, so that a run may resume at any generation."""
    return int(np.random.SeedSequence([seed, generation]).generate_state(1)[0])


def generation_size(problem: Problem, usual: int) -> int:
    """Return the number of designs in a generation, at most the whole budget. usual: default number."""
    return min(problem.settings.samples or usual, evaluation_budget(problem))


Breed = Callable[[Sequence[Generation]], Brood]
"""How a method finds its next points: a function from the previous generations, and nothing else, to a brood."""


def evolve(problem: Problem, evaluators: list[Evaluator], run: Run, breed: Breed, *, size: int) -> Archive:
    """Return the archive of non-dominated feasible designs from all generations that the budget allows.

    size: size of a generation, for progress reports.
    """
    allowed = evaluation_budget(problem)
    run.rounds = max(1, allowed // size)
    archive, evaluations = Archive.empty(len(problem.objectives)), _Evaluations()
    past: list[Generation] = []
    count = 0
    while True:
        brood = _breed_recorded(evaluators[0], breed, past)
        if count + len(brood) > allowed and past:
            break
        past.append(_evaluate_brood(evaluators, brood, archive, evaluations))
        count += len(brood)
        run.report_round("evolving", evaluators, archive)
    return archive


def _breed_recorded(evaluator: Evaluator, breed: Breed, past: list[Generation]) -> Brood:
    def compute() -> tuple[Rows, Array, Rows]:
        evaluator.checkpoints.poll()
        brood = breed(past)
        return brood.branch, brood.u, brood.parents

    return Brood(*evaluator.recorded_step("breeding", (np.array([len(past)]),), compute))


_Evaluations = dict[tuple[int, bytes], tuple[Array, float]]
"""Objectives and violation of every evaluated point, by branch and coordinates, so that none is evaluated twice."""


def _evaluate_brood(
    evaluators: list[Evaluator], brood: Brood, archive: Archive, evaluations: _Evaluations
) -> Generation:
    """Return the generation from a brood and archive its feasible designs; each branch's new points form one batch."""
    points = zip(brood.branch.tolist(), brood.u + 0.0, strict=True)  # no negative zeros
    keys = [(index, point[: evaluators[index].dimension].tobytes()) for index, point in points]
    fresh = {key: row for row, key in enumerate(keys) if key not in evaluations}
    for index, evaluator in enumerate(evaluators):
        fresh_points = [(key, row) for key, row in fresh.items() if key[0] == index]
        if fresh_points:
            u = brood.u[[row for _, row in fresh_points], : evaluator.dimension]
            values, violation = objectives_and_violations(evaluator, u, BAND if evaluator.loose else 0.0)
            evaluations.update({key: (values[i], violation[i]) for i, (key, _) in enumerate(fresh_points)})
            good = violation <= FEASIBLE
            feasible = np.full(int(good.sum()), not evaluator.loose)
            archive.feasible += int(feasible.sum())
            if good.any():
                archive.add_points(index, u[good], values[good], feasible)
    values, violation = (np.array([evaluations[key][part] for key in keys]) for part in (0, 1))
    return Generation(brood.branch, brood.u, values, violation, parents=brood.parents)


def objectives_and_violations(evaluator: Evaluator, u: Array, band: float = 0.0) -> tuple[Array, Array]:
    """Return objectives (n, m) and violation beyond a band (n,) for points.

    Infeasible points have NaN objectives, and points with a non-finite objective count as infinitely violated.
    """
    _, values, violation = evaluator.screen_designs_objectives_violation(u, band=band)
    violation = np.maximum(violation - band, 0.0) if band else violation
    undefined = (violation <= FEASIBLE) & ~np.isfinite(values).all(axis=1) | np.isnan(violation)
    violation = np.where(undefined, np.inf, violation)
    return np.where((violation <= FEASIBLE)[:, None], values, np.nan), violation


Draw = Callable[[int, int, int], Array]

BATCH = 1024
"""Number of designs in a generation if the job sets no number of samples: Sobol points are evenly spread in powers of
two."""


def search_random_points(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
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
    search=search_random_points,
)
SOBOL = _baseline(
    name="sobol",
    title="Sobol points",
    help="One scrambled Sobol sequence: a baseline that every other method should beat.",
    search=sobol,
    uses=("scipy",),
)
