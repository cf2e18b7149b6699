"""Requirements of a job on one of its designs: ranges of the dimensions, and constraints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..runs.result import Row

if TYPE_CHECKING:
    from ...model.machine.mechanism import Mechanism
    from ...optimise.problem.problem import Problem, Range

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
    return {f"{name}_mm": (1e3 * of.lower, 1e3 * of.upper) for name, of in _dimensions(part).items()}


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


def _dimensions(part: Problem) -> dict[str, Range]:
    return {"crank": part.crank, "rod": part.rod, "offset": part.offset}
