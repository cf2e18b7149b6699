"""NSGA-II and NSGA-III by Optuna: a population whose children inherit from the designs that survive selection.

    K. Deb, A. Pratap, S. Agarwal, T. Meyarivan, "A fast and elitist multiobjective genetic algorithm: NSGA-II",
    IEEE Transactions on Evolutionary Computation 6(2), 2002
    K. Deb, H. Jain, "An evolutionary many-objective optimization algorithm using reference-point-based nondominated
    sorting approach, part I", the same, 18(4), 2014

Children are created by simulated binary crossover and polynomial mutation. Constraints enter by constrained domination:
feasible designs come first, then smaller violations. Several branches (signs of the offset) become one categorical
parameter, so selection follows the front. A fixed part of the budget per branch would be wasted on poor branches.

Selection and crossover need only the last generation and its parents. So each generation is a new Optuna study in
memory with these designs and a new sampler: its cost is constant, and it depends only on them.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from ...model.errors import InputError
from ..problem.problem import Problem
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from .optuna_trials import ask_points, completed_trials, new_study, search_space, silence_optuna
from .population import Brood, Generation, evolve, generation_seed, generation_size
from .registry import Method

POPULATION = 100
"""Number of designs in a generation if the job sets no number of samples."""


def nsga2(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the designs that NSGA-II finds; crowding distance keeps its population diverse."""
    from optuna.samplers import NSGAIISampler

    return _search_genetic(problem, evaluators, run, NSGAIISampler)


def nsga3(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the designs that NSGA-III finds; about one reference direction per member keeps its population diverse."""
    from optuna.samplers import NSGAIIISampler

    size, objectives = population_size(problem), len(problem.objectives)
    return _search_genetic(
        problem, evaluators, run, NSGAIIISampler, dividing_parameter=axis_divisions(size, objectives)
    )


def population_size(problem: Problem) -> int:
    """Return the number of designs in a generation. Raises `InputError` for fewer than two, which cannot breed."""
    size = generation_size(problem, POPULATION)
    if size < 2:
        raise InputError(
            f"{problem.settings.method} needs at least two designs to breed from; got {size}; raise samples and "
            "evaluations"
        )
    return size


def axis_divisions(population: int, objectives: int) -> int:
    """Return the number of axis divisions that gives at most as many reference directions as designs.

    p divisions give (p + m - 1 over m - 1) directions (Das and Dennis, 1998).
    """
    parts = 1
    while objectives > 1 and math.comb(parts + objectives, objectives - 1) <= population:
        parts += 1
    return parts


def _search_genetic(problem: Problem, evaluators: list[Evaluator], run: Run, sampler: Any, **options: Any) -> Archive:
    """Return the designs that one of Optuna's genetic samplers finds."""
    from optuna.samplers.nsgaii import PolynomialMutation, SBXCrossover

    size, axes = population_size(problem), search_space(evaluators)

    def breed(past: Sequence[Generation]) -> Brood:
        seed = generation_seed(problem.settings.seed, len(past))
        genetic = sampler(population_size=size, seed=seed, crossover=crossover, mutation=mutation, **options)
        study = new_study(problem, genetic)
        pool = np.zeros(0, np.int64)
        if past:
            history = past[0].join(*past[1:])
            pool = np.concatenate([past[-1].parents, np.arange(len(history))[-len(past[-1]) :]])
            # The sampler treats them all as one generation, and selects from both parts alike.
            study.add_trials(completed_trials(axes, history[pool], {genetic._get_generation_key(): 0}))
        branch, u = ask_points(study, axes, size, run.checkpoints.poll)
        survivors = [trial.number for trial in genetic.get_parent_population(study, 1)] if past else []
        return Brood(branch, u, pool[survivors])

    with silence_optuna():
        crossover, mutation = SBXCrossover(), PolynomialMutation()
        return evolve(problem, evaluators, run, breed, size=size)


_genetic_method = partial(Method, family="evolutionary", budget=20_000, uses=("optuna",), gradients=False)
NSGA2 = _genetic_method(
    name="nsga2",
    title="NSGA-II",
    help="Genetic algorithm with Optuna's operators; crowding distance keeps the population diverse.",
    objectives="any",
    search=nsga2,
)
NSGA3 = _genetic_method(
    name="nsga3",
    title="NSGA-III",
    help="Genetic algorithm with Optuna's operators; reference directions keep the population diverse.",
    objectives="several",
    search=nsga3,
)
