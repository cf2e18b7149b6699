"""Requirements of a job, judged at a given design: the value of each, and by how much it is missed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...objectives.kinds import System, shown_in
from ..runs.result import Row
from .requirements import MET, ranges_of, requirements_of

if TYPE_CHECKING:
    from ...optimise.problem.problem import Problem


@dataclass(frozen=True, kw_only=True)
class JudgedRule:
    """A rule of a job at one design, in the unit of its quantity.

    lower, upper: None leaves a side open. value: None where the design does not have the quantity. missed_by: zero
    where the rule is met, None without a value.
    """

    quantity: str
    title: str
    unit: str
    lower: float | None
    upper: float | None
    value: float | None
    met: bool
    missed_by: float | None


def judged(problem: Problem, row: Row) -> list[JudgedRule]:
    """Return the ranges of crank, rod and offset and the constraints of a job, judged at a design's numbers."""
    found = []
    for name in ("crank", "rod", "offset"):
        column = f"{name}_mm"
        ranges = dict.fromkeys(ranges_of(part)[column] for part in problem.parts())  # of several, where it is chosen
        each = [_judged(name, name, "mm", lower, upper, row[column]) for lower, upper in ranges]
        found.append(min(each, key=lambda rule: rule.missed_by or 0.0))
    return found + [
        _judged(rule.quantity, rule.title, rule.unit, rule.lower, rule.upper, row.get(rule.column))
        for rule in requirements_of(problem)
    ]


def rule_in(rule: JudgedRule, system: System) -> JudgedRule:
    """Return a rule in the unit that a system shows."""
    unit, factor = shown_in(rule.unit, system)

    def of(value: float | None) -> float | None:
        return None if value is None else value * factor

    return replace(
        rule,
        unit=unit,
        lower=of(rule.lower),
        upper=of(rule.upper),
        value=of(rule.value),
        missed_by=of(rule.missed_by),
    )


def _judged(
    quantity: str, title: str, unit: str, lower: float | None, upper: float | None, value: object
) -> JudgedRule:
    number = float(value) if isinstance(value, int | float) and not math.isnan(value) else None
    missed = None
    if number is not None:
        below = 0.0 if lower is None else lower - number
        above = 0.0 if upper is None else number - upper
        missed = max(0.0, below, above)
        if missed <= MET * max(abs(lower or 0.0), abs(upper or 0.0)):
            missed = 0.0
    return JudgedRule(
        quantity=quantity,
        title=title,
        unit=unit,
        lower=lower,
        upper=upper,
        value=number,
        met=missed == 0.0,
        missed_by=missed,
    )
