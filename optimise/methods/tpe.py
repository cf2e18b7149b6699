"""TPE by Optuna: proposes where designs are likelier to be good than not, by densities fitted to what was evaluated.

    J. Bergstra, R. Bardenet, Y. Bengio, B. Kegl, "Algorithms for hyper-parameter optimization", NIPS 2011
    Y. Ozaki et al., "Multiobjective tree-structured Parzen estimator", JAIR 73, 2022

Meant for models that take long: a proposal costs 20 to 100 ms, growing with the designs so far. The densities are over
all coordinates together, since feasible regions lie aslant in the box.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..problem.problem import Problem
from ..search.evaluation import Evaluator
from ..search.search import Archive, Run
from .generation import Brood, Generation, generation_seed
from .method import Method
from .population import evolve
from .registry import budget
from .trials import asked, quiet, space, stored

BATCH = 20
"""Designs proposed before any of them is evaluated, where the job sets no number of samples; those under way count as
poor ones (constant liar), so that a batch spreads."""


def tpe(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the designs that the tree-structured Parzen estimator finds."""
    with quiet():
        breed = _Parzen(problem, evaluators, run.checkpoints.poll)
        return evolve(problem, evaluators, run, breed, size=breed.size)


class _Parzen:
    """Breeds by Optuna's TPE, whose densities it fits anew to all designs for each batch."""

    def __init__(self, problem: Problem, evaluators: list[Evaluator], poll: Callable[[], None]) -> None:
        self.poll = poll
        self.size = min(problem.settings.samples or BATCH, budget(problem))
        self.seed = problem.settings.seed
        self.objectives = len(problem.objectives)
        self.space = space(evaluators)

    def __call__(self, past: Sequence[Generation]) -> Brood:
        import optuna

        seed = generation_seed(self.seed, len(past))
        sampler = optuna.samplers.TPESampler(seed=seed, multivariate=True, constant_liar=True)
        study = optuna.create_study(directions=["minimize"] * self.objectives, sampler=sampler)
        if past:
            study.add_trials(stored(self.space, past[0].join(*past[1:]), {}))
        sheet, u = asked(study, self.space, self.size, self.poll)
        return Brood(sheet, u, np.zeros(0, np.int64))


TPE = Method(
    name="tpe",
    title="TPE",
    help="Proposes by Optuna designs that are likelier to be good, from densities fitted to all evaluated ones.",
    family="model-based",
    objectives="any",
    search=tpe,
    budget=1_000,
    uses=("optuna",),
    gradients=False,
)
