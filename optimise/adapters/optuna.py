"""A problem as the objective function for an Optuna study."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ..problem.problem import Problem
from .standard_form import standard_form

if TYPE_CHECKING:
    from optuna.trial import Trial

_FAR = 1e30
"""Replaces infinity, which Optuna rejects in studies with several objectives."""


def optuna_objective(
    problem: Problem, *, eliminate: bool = True, elimination_branch: int | None = None
) -> Callable[[Trial], tuple[float, ...]]:
    """Return an objective function for `study.optimize`, with minimised objectives and requirements as constraints.

    Create the study with direction "minimize" for each objective. eliminate: whether to eliminate equalities, see
    `standard_form`; the parameters then range from 0 to 1. elimination_branch: index of the solution branch if the
    equalities have several. Each trial stores its design in the user attribute "design": crank, rod, offset, m, extra
    variables, SI. Raises `InputError` as `standard_form` does.
    """
    form = standard_form(problem, eliminate=eliminate, elimination_branch=elimination_branch)

    def objective(trial: Trial) -> tuple[float, ...]:
        x = np.array(
            [
                trial.suggest_float(name, low, high)
                for name, low, high in zip(form.names, form.lower.tolist(), form.upper.tolist(), strict=True)
            ]
        )
        arrays = form.arrays(x)
        for place, (name, value) in enumerate(zip(form.inequalities, arrays.G.tolist(), strict=True)):
            trial.set_constraint(f"{place} {name}", min(value, _FAR))
        for name, value in zip(form.equalities, arrays.H.tolist(), strict=True):
            trial.set_constraint(name, min(abs(value) - _TOLERANCE, _FAR))
        design = form.designs(x)
        trial.set_user_attr("design", design.tolist() if np.isfinite(design).all() else None)
        return tuple(min(value, _FAR) for value in arrays.F.tolist())

    return objective


_TOLERANCE = 1e-4
"""Relative tolerance within which an equality counts as met if equalities are not eliminated."""
