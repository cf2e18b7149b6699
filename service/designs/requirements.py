"""Requirements of a job on a design: ranges of the dimensions, constraints, and by how much each is missed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...objectives.kinds import System, shown_in
from ..runs.result import Cell, Row

if TYPE_CHECKING:
    from ...model.machine.mechanism import Mechanism
    from ...optimise.problem.problem import Problem

_RPM = 9.549296585513721  # in one rad/s
MET = 1e-8
"""Share of a bound to which designs meet their constraints."""


@dataclass(frozen=True)
class Requirement:
    """A quantity that must lie between two values, in its unit; None leaves a side open."""

    quantity: str
    column: str
    title: str
    unit: str
    lower: float | None
    upper: float | None

    @property
    def slack(self) -> str:
        """The column of the distance to the nearer bound."""
        return f"slack_{self.column}"

    def met(self, row: Row) -> bool:
        """Return whether a design meets it; one without the number does not."""
        slack = row.get(self.slack)
        size = max(abs(self.lower or 0.0), abs(self.upper or 0.0), 1e-300)
        return isinstance(slack, float) and slack >= -MET * size


@dataclass(frozen=True, kw_only=True)
class JudgedRule:
    """A rule of a job at one design, in the unit that is shown for its quantity.

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


def requirements_of(part: Problem) -> list[Requirement]:
    """Return the constraints of a problem without choices, with the floors that hold where it sets none."""
    from ...optimise.search.evaluation import constraints_of

    found = []
    for constraint in constraints_of(part):
        of = part.quantity(constraint.quantity)
        ends = (None if end is None else end * of.unit.factor for end in (constraint.lower, constraint.upper))
        found.append(Requirement(of.name, of.field, of.title, of.unit.symbol, *ends))
    return found


def ranges_of(part: Problem) -> dict[str, tuple[float, float]]:
    """Return where crank, rod and offset may lie, mm, by column."""
    dimensions = {"crank": part.crank, "rod": part.rod, "offset": part.offset}
    return {f"{name}_mm": (1e3 * of.lower, 1e3 * of.upper) for name, of in dimensions.items()}


def names_of(part: Problem) -> dict[str, str]:
    """Return the names of all quantities of a problem, its own ones included, by column."""
    from ...objectives.registry import QUANTITIES

    return {of.field: of.name for of in (*QUANTITIES.values(), *part.own)}


def outside(part: Problem, row: Row) -> list[str]:
    """Return the columns of crank, rod and offset that are out of their ranges."""
    found = []
    for column, (lower, upper) in ranges_of(part).items():
        room = MET * max(abs(lower), abs(upper))
        value = row[column]
        if not isinstance(value, float) or not lower - room <= value <= upper + room:
            found.append(column)
    return found


def speed_rpm(mechanism: Mechanism) -> float:
    """Return the crank speed, rpm, counter-clockwise positive."""
    return _RPM * float(mechanism.speed)


def judged(problem: Problem, row: Row, system: System = "metric") -> list[JudgedRule]:
    """Return the ranges of crank, rod and offset and the constraints of a job, judged at a design's metric row.

    system: of the units of the answer.
    """
    found = []
    for name in ("crank", "rod", "offset"):
        column = f"{name}_mm"
        ranges = dict.fromkeys(ranges_of(part)[column] for part in problem.parts())  # of several, where it is chosen
        each = [_judged(Requirement(name, column, name, "mm", *ends), row[column], system) for ends in ranges]
        found.append(min(each, key=lambda rule: rule.missed_by or 0.0))
    return found + [_judged(rule, row.get(rule.column), system) for rule in requirements_of(problem)]


def _judged(rule: Requirement, value: Cell, system: System) -> JudgedRule:
    number = float(value) if isinstance(value, int | float) and not math.isnan(value) else None
    missed = None
    if number is not None:
        below = 0.0 if rule.lower is None else rule.lower - number
        above = 0.0 if rule.upper is None else number - rule.upper
        missed = max(0.0, below, above)
        if missed <= MET * max(abs(rule.lower or 0.0), abs(rule.upper or 0.0)):
            missed = 0.0
    unit, factor = shown_in(rule.unit, system)
    told = {"lower": rule.lower, "upper": rule.upper, "value": number, "missed_by": missed}
    shown = {name: None if item is None else item * factor for name, item in told.items()}
    return JudgedRule(quantity=rule.quantity, title=rule.title, unit=unit, met=missed == 0.0, **shown)
