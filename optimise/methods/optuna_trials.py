"""Conversion between points in the unit box and Optuna's trials.

Optuna proposes points; this package evaluates, stores and resumes.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from ...model.arrays import Array
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..search.evaluation import Evaluator
from .population import Generation, Rows

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
