"""TPE by Optuna: proposes promising points from densities fitted to the evaluated designs.

    J. Bergstra, R. Bardenet, Y. Bengio, B. Kegl, "Algorithms for hyper-parameter optimization", NIPS 2011
    Y. Ozaki et al., "Multiobjective tree-structured Parzen estimator", JAIR 73, 2022

Intended for slow models: a proposal takes 20 to 100 ms, growing with the number of designs. The densities are over all
coordinates together, because feasible regions lie obliquely in the box.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..problem.problem import Problem
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from .optuna_trials import ask_points, completed_trials, new_study, search_space, silence_optuna
from .population import Brood, Generation, evolve, generation_seed, generation_size
from .registry import Method

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
