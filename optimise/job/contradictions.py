"""Contradictions within a job, found before anything runs.

Only what is certain is refused: each test holds for every design within the ranges. Requirements that exclude each
other in a subtler way the optimiser finds and reports.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.errors import JobError
from ..problem.problem import Problem
from ..problem.zero_objectives import require_ranking
from .box import require_reachable
from .slow_stroke import require_slow_stroke


def require_consistent(problem: Problem) -> None:
    """Raise JobError, naming key, rule, value and remedy, if the problem contradicts itself."""
    for key, quantity, word, value in _asked(problem):
        _require_possible(problem, key, quantity, word, value)
    for objective in problem.objectives:
        _require_free(problem, objective.quantity)
    require_ranking(problem)
    require_reachable(problem)
    require_slow_stroke(problem)


def _asked(problem: Problem) -> Iterator[tuple[str, str, str, float]]:
    """Yield key, quantity, word and value of every bound and target."""
    for constraint in problem.constraints:
        name, lower, upper = constraint.quantity, constraint.lower, constraint.upper
        words = (("equals", lower),) if constraint.equality else (("min", lower), ("max", upper))
        for word, value in words:
            if value is not None:
                yield f"constraints.{name}", name, word, value
    for objective in problem.objectives:
        if objective.target is not None:
            yield f"objectives.{objective.quantity}", objective.quantity, "target", objective.target


def _require_possible(problem: Problem, key: str, name: str, word: str, value: float) -> None:
    """Refuse a value that a quantity has for no linkage at all."""
    of = problem.quantity(name)
    got = f"got {word} {value * of.unit.factor:.6g} {of.unit.symbol}".rstrip()
    if of.domain is not None and of.domain.refuses(value, least=word == "min"):
        raise JobError(f"{key}: {of.domain.rule}; {got}; {of.domain.remedy}")
    if not of.signed and value < 0.0:
        raise JobError(f"{key}: {name} is never negative; {got}; give its size")


def _require_free(problem: Problem, name: str) -> None:
    """Refuse an objective that is the same for every design."""
    if any(c.equality and c.quantity == name for c in problem.constraints):
        raise JobError(
            f"objectives.{name}: a quantity that is held at one value cannot be an objective too; "
            f"got constraints.{name} with equals; leave out one of the two"
        )
    centred = problem.offset.fixed and problem.offset.lower == 0.0
    everywhere = problem.quantity(name).in_line
    if centred and everywhere is not None:
        value = "infinite" if everywhere == math.inf else f"{everywhere:g}"
        raise JobError(
            f"objectives.{name}: without offset it is {value} for every design; got offset fixed "
            "at 0; give variables.offset a range or leave out the objective"
        )
