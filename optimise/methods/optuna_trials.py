"""Conversion between points in the unit box and Optuna's trials.

Optuna proposes points; this package evaluates, stores and resumes.

CMA-ES: one objective, continuous coordinates, and a normal distribution that learns the shape of the objective.

    N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, 2016
    A. Auger, N. Hansen, "A restart CMA evolution strategy with increasing population size", IEEE CEC 2005

Once converged, it restarts elsewhere with twice the population. Each branch has a separate search, in turn: a normal
distribution cannot span two. Only ranks matter, so constraints enter as ranks: feasible designs come first, by
objective, then the others by violation.

This uses the `cmaes` package directly, because Optuna's sampler ignores constraints and stores the state as a pickle
with every trial. The same generations lead to the same state again, so nothing else needs to be stored.

TPE by Optuna: proposes promising points from densities fitted to the evaluated designs.

    J. Bergstra, R. Bardenet, Y. Bengio, B. Kegl, "Algorithms for hyper-parameter optimization", NIPS 2011
    Y. Ozaki et al., "Multiobjective tree-structured Parzen estimator", JAIR 73, 2022

Intended for slow models: a proposal takes 20 to 100 ms, growing with the number of designs. The densities are over all
coordinates together, because feasible regions lie obliquely in the box.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from ...model.arrays import Array
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..search.candidates import stack_rows
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from .population import Brood, Generation, Rows, evolve, generation_seed, generation_size
from .registry import Method

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution
    from optuna.samplers import BaseSampler
    from optuna.study import Study
    from optuna.trial import FrozenTrial

    Space = dict[str, BaseDistribution]

_BRANCH = "sheet"  # name of the categorical parameter; samplers draw parameters in alphabetical order


@contextmanager
def silence_optuna() -> Iterator[None]:
    """Silence Optuna's study messages and its warnings about experimental operators within the context."""
    import optuna

    level = optuna.logging.get_verbosity()
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
            yield
    finally:
        optuna.logging.set_verbosity(level)


def search_space(evaluators: list[Evaluator]) -> Space:
    """Return Optuna's parameters: the coordinates of the unit box, and the branch if there are several."""
    from optuna.distributions import CategoricalDistribution, FloatDistribution

    dimension = max(evaluator.dimension for evaluator in evaluators)
    parameters: Space = {f"u{column:03d}": FloatDistribution(0.0, 1.0) for column in range(dimension)}
    if len(evaluators) > 1:
        parameters[_BRANCH] = CategoricalDistribution(list(range(len(evaluators))))
    return parameters


def new_study(problem: Problem, sampler: BaseSampler) -> Study:
    """Return a study in memory with a problem's objectives and no trials."""
    import optuna

    return optuna.create_study(directions=["minimize"] * len(problem.objectives), sampler=sampler)


def completed_trials(space: Space, points: Generation, mark: dict[str, Any]) -> list[FrozenTrial]:
    """Return evaluated points as completed trials, each with its constraint.

    Optuna would count a trial without a constraint as feasible, and accept NaN or infinite objectives as they are. So
    every trial has its violation, and only infeasible ones have substitute objectives, which no selection compares. The
    substitutes are infinite unless all objectives are: NSGA-III scales by the finite ones.
    """
    from optuna.trial import create_trial

    names = sorted(name for name in space if name != _BRANCH)
    feasible = points.violation <= FEASIBLE
    absent = np.inf if feasible.any() else 0.0
    trials = []
    for row, good in enumerate(feasible.tolist()):
        values = points.values[row].tolist() if good else [absent] * points.values.shape[1]
        if good and not np.isfinite(values).all():
            raise ArithmeticError(f"a feasible design has objectives {values}")
        params: dict[str, Any] = dict(zip(names, points.u[row].tolist(), strict=True))
        if _BRANCH in space:
            params[_BRANCH] = int(points.branch[row])
        violation = 0.0 if good else float(points.violation[row])
        trials.append(
            create_trial(
                params=params,
                distributions=space,
                values=values,
                constraints={"violation": violation},
                system_attrs=dict(mark),
            )
        )
    return trials


def ask_points(study: Study, space: Space, count: int, poll: Callable[[], None]) -> tuple[Rows, Array]:
    """Return branches (n,) and points (n, k) that a study's sampler proposes. poll: called before each trial."""
    names = sorted(name for name in space if name != _BRANCH)
    trials = []
    for _ in range(count):
        poll()
        trials.append(study.ask(space).params)
    u = np.array([[trial[name] for name in names] for trial in trials])
    return np.array([trial.get(_BRANCH, 0) for trial in trials], dtype=np.int64), np.clip(u, 0.0, 1.0)


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
            climb.learn_from_generation(generation)
        u = climb.next_generation(generation_seed(seed, len(past)))
        return Brood(np.full(len(u), climb.index), stack_rows(np.zeros((0, widest)), u))

    return evolve(problem, evaluators, run, breed, size=size)


class _Climb:
    """The search on one branch: a distribution that learns from the values of its points, with restarts."""

    def __init__(self, index: int, dimension: int, size: int, seed: int) -> None:
        self.index, self.dimension, self.size, self.seed = index, dimension, size, seed
        self.starts, self.generations = 0, 0
        self.start_climb()

    def start_climb(self) -> None:
        """Start from the centre the first time, then from a random point."""
        from cmaes import CMA

        random = np.random.default_rng(np.random.SeedSequence([self.seed, _RESTART, self.index, self.starts]))
        mean = random.random(self.dimension) if self.starts else np.full(self.dimension, 0.5)
        bounds = np.tile([0.0, 1.0], (self.dimension, 1))
        self.optimiser = CMA(mean=mean, sigma=STEP, bounds=bounds, population_size=self.size)
        self.starts += 1

    def next_generation(self, seed: int) -> Array:
        """Return the points (n, k) of the next generation."""
        self.optimiser.reseed_rng(seed)
        return np.array([self.optimiser.ask() for _ in range(self.optimiser.population_size)])

    def learn_from_generation(self, generation: Generation) -> None:
        """Learn from the values of a generation."""
        self.generations += 1
        u, values = generation.u[:, : self.dimension], generation.values[:, 0]
        excess = np.where(generation.violation <= FEASIBLE, 0.0, generation.violation)
        if np.isinf(excess).all():  # there is nothing to rank
            self.start_climb()
            return
        ranks = np.empty(len(u))
        ranks[np.lexsort([values, excess])] = np.arange(len(u))
        self.optimiser.tell([(point, float(rank)) for point, rank in zip(u, ranks, strict=True)])
        flat = not excess.any() and np.ptp(values) <= _FLAT * np.abs(values).max()
        if flat or np.ptp(u, axis=0).max() <= _CONVERGED or self.optimiser.should_stop():
            self.size *= 2
            self.start_climb()


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


BATCH = 20
"""Designs proposed before any of them is evaluated, if the job sets no number of samples; pending ones count as poor
(constant liar), so that a batch spreads."""


def tpe(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the designs that the tree-structured Parzen estimator finds; its densities are refitted every time."""
    from optuna.samplers import TPESampler

    size, axes = generation_size(problem, BATCH), search_space(evaluators)

    def breed(past: Sequence[Generation]) -> Brood:
        seed = generation_seed(problem.settings.seed, len(past))
        study = new_study(problem, TPESampler(seed=seed, multivariate=True, constant_liar=True))
        if past:
            study.add_trials(completed_trials(axes, past[0].join(*past[1:]), {}))
        branch, u = ask_points(study, axes, size, run.checkpoints.poll)
        return Brood(branch, u)

    with silence_optuna():
        return evolve(problem, evaluators, run, breed, size=size)


TPE = Method(
    name="tpe",
    title="TPE",
    help="Proposes promising designs with Optuna, from densities fitted to all evaluated designs.",
    family="model-based",
    objectives="any",
    search=tpe,
    budget=1_000,
    uses=("optuna",),
    gradients=False,
)
