"""Designs within the ranges of a problem that a warning before a search is judged by."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.arrays import Array
from ..problem.problem import Problem
from .elimination import sheets
from .evaluation import Evaluator
from .sampling import first_samples

_SAMPLES = 32
"""Designs of a sheet."""
_SHEETS = 20
"""Sheets: of very many choices the first ones."""


def samples(problem: Problem) -> Iterator[tuple[Problem, Array]]:
    """Yield designs (n, 3 + k) that move as asked, with the problem of their choices.

    They meet what is eliminated, and need not be feasible otherwise.
    """
    for sheet in sheets(problem)[:_SHEETS]:
        points = first_samples(_SAMPLES, len(sheet.free), 0, 0)
        yield problem.part(sheet.variant), sheet.dimensions(points)[Evaluator(problem, sheet).valid(points)]
