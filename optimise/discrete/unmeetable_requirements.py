"""Requirements on the dimensions that no combination of discrete values meets, detected before a search."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...model.errors import InfeasibleError
from ...model.linkage.dimensions import DIMENSIONS
from ..problem.problem import Problem
from .combinations import Axes, FeasibleDesigns, best_of_all_combinations
from .discrete_messages import failure_message

MOST = 200_000
"""Maximum number of combinations to check."""


def require_meetable(problem: Problem) -> None:
    """Raise InfeasibleError, naming the nearest, if no combination of three discrete dimensions meets the requirements.

    Checks only requirements that need no cycle, and at most `MOST` combinations; the search handles the rest.
    """
    if not problem.discrete:
        return
    axes = [_dimension_axes(Axes.of_problem(part)) for part in problem.parts()]
    if not all(axis.has_no_free_number for axis in axes) or sum(axis.count for axis in axes) > MOST:
        return
    judged = FeasibleDesigns.empty(axes[0].part)
    for axis in axes:
        judged = judged.merge(best_of_all_combinations(axis, dimensions_only=True))
        if len(judged.dimensions):
            return
    sizes = tuple(item for item in problem.discrete if item.name in DIMENSIONS)
    if sizes:
        raise InfeasibleError(f"variables.{sizes[0].name}: {failure_message(replace(problem, discrete=sizes), judged)}")


def _dimension_axes(axes: Axes) -> Axes:
    """Return axes with a single value for each other number; these requirements depend only on the dimensions."""
    fixed_values = [np.array([item.lower]) for item in axes.part.mechanism.varying]
    return Axes(axes.part, (*axes.values[:3], *fixed_values))
