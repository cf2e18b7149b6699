"""Sampled designs within the ranges of a problem, for warnings before a search."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...model.arrays import Array
from ...objectives.proportions import STROKE
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..problem.requirements import Constraint
from .elimination import EliminationBranch, elimination_branches
from .evaluation import Evaluator
from .sampling import first_samples

_SAMPLES = 32
"""Number of designs per branch, besides those with extreme numbers and stroke."""
_TRIED = 4096
"""Number of points over all branches from which these are taken: checks that need no cycle cost a microsecond per
point."""
_BRANCHES = 20
"""Maximum number of branches; with very many choices, the first ones."""
_NARROW = 0.1
"""Relative width of a range that points rarely hit; its middle is required instead."""


def sampled_designs(problem: Problem) -> Iterator[tuple[Problem, Array]]:
    """Yield designs (n, 3 + k) that make the required motion, with the problem for their choices.

    They meet the requirements on lengths, stroke and everything else that needs no cycle. If no point does, those with
    the least violation count.
    """
    branches = elimination_branches(problem)[:_BRANCHES]
    count = max(_SAMPLES, _TRIED // len(branches))
    for branch in branches:
        part = problem.part(branch.variant)
        tried = [_try_points(part, branch, count)]
        if not _has_feasible(tried[0]):
            middle = replace(part, constraints=tuple(map(_middle_of_narrow_range, part.constraints)))
            tried += [
                _try_points(middle, middle_branch, count)
                for middle_branch in elimination_branches(middle)
                if middle_branch.sign == branch.sign
            ]
        designs, misses = next(filter(_has_feasible, tried), tried[0])
        order = np.argsort(np.maximum(misses, FEASIBLE), kind="stable")
        count_feasible = np.count_nonzero(misses <= FEASIBLE) or _SAMPLES
        yield part, _representative_rows(part, designs[order][:count_feasible])


def _try_points(part: Problem, branch: EliminationBranch, count: int) -> tuple[Array, Array]:
    """Return designs (n, 3 + k) of a branch that make the required motion, and their violation (n,)."""
    evaluator = Evaluator(part, branch)
    points = first_samples(count, len(branch.free), 0, 0)
    points = points[evaluator.can_evaluate(points)]
    return branch.dimensions(points), evaluator.violation_without_cycle(points)


def _has_feasible(tried: tuple[Array, Array]) -> bool:
    return bool((tried[1] <= FEASIBLE).any())


def _middle_of_narrow_range(constraint: Constraint) -> Constraint:
    """Return the middle of a narrow range as a required value."""
    lower, upper = constraint.lower, constraint.upper
    if lower is None or upper is None or upper - lower > _NARROW * max(abs(lower), abs(upper)):
        return constraint
    return replace(constraint, lower=0.5 * (lower + upper), upper=0.5 * (lower + upper))


def _representative_rows(part: Problem, designs: Array) -> Array:
    """Return the first designs and those with extreme numbers and stroke."""
    if not len(designs):
        return designs
    stroke = STROKE.evaluate(part.mechanism, designs).values
    columns = np.column_stack([designs, np.where(np.isfinite(stroke), stroke, designs[:, 0])])
    rows = {*range(min(_SAMPLES, len(designs))), *columns.argmin(axis=0).tolist(), *columns.argmax(axis=0).tolist()}
    return designs[sorted(rows)]
