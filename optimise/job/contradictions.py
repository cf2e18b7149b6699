"""Contradictions within a job, found before anything runs.

Only what is certain is refused: each test holds for every design within the ranges. Requirements that exclude each
other in a subtler way the optimiser finds and reports.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.errors import JobError
from ...objectives.motion_deviation import DEVIATIONS
from ...objectives.registry import QUANTITIES
from ..problem.problem import Problem
from ..problem.zero_objectives import require_ranking
from .box import require_reachable
from .slow_stroke import require_slow_stroke

_SIGNED = ("mean_torque", "mean_power")


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
    unit = problem.quantity(name).unit
    got = f"got {word} {value * unit.factor:.6g} {unit.symbol}".rstrip()
    if name == "time_ratio" and value < 1.0:
        raise JobError(
            f"{key}: the time ratio is the slower stroke over the faster, so 1 or more; {got}; "
            "give the inverse (constraints.slow_stroke says which stroke is the slow one)"
        )
    if name == "transmission_angle" and not 0.0 < value < 0.5 * math.pi:
        raise JobError(
            f"{key}: the least transmission angle lies between 0 and 90 deg, ends excluded; {got}; "
            "30 to 50 deg are usual (a plain number is in rad)"
        )
    if name == "self_locking_margin" and not 0.0 < value < 0.5 * math.pi:
        raise JobError(
            f"{key}: the self-locking margin lies between 0, where friction locks, and 90 deg, ends excluded; {got}; "
            "10 deg and more are usual (a plain number is in rad)"
        )
    if name in ("rod_to_offset", "rod_to_crank") and word != "min" and value <= 1.0:
        raise JobError(
            f"{key}: the rod exceeds crank + |offset| for full rotation, so this is above 1; {got}; raise it"
        )
    if name in (*QUANTITIES, *DEVIATIONS) and name not in _SIGNED and value < 0.0:
        raise JobError(f"{key}: {name} is never negative; {got}; give its size")


def _require_free(problem: Problem, name: str) -> None:
    """Refuse an objective that is the same for every design."""
    if any(c.equality and c.quantity == name for c in problem.constraints):
        raise JobError(
            f"objectives.{name}: a quantity that is held at one value cannot be an objective too; "
            f"got constraints.{name} with equals; leave out one of the two"
        )
    centred = problem.offset.fixed and problem.offset.lower == 0.0
    if centred and name in ("time_ratio", "rod_to_offset"):
        value = "1" if name == "time_ratio" else "infinite"
        raise JobError(
            f"objectives.{name}: without offset it is {value} for every design; got offset fixed "
            "at 0; give variables.offset a range or leave out the objective"
        )
