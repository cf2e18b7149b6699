"""Reachable values in place of a requirement that cannot be met, in numbers that can be asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from ...model.arrays import Array
from ..problem.problem import Problem
from ..problem.requirements import RELATIONS, Constraint, Sense, Word, merged
from ..problem.restatement import restate
from ..problem.violation import FEASIBLE
from .best import Best, wanting
from .safe_side import exact, safe

_LOWEST = 0.02
"""Of a floor: what is kept of it where it is let go. Nearer to locking nothing is worth telling."""
_SENSES: dict[Word, Sense] = {"min": "maximise", "max": "minimise", "equals": "target"}
"""How to come nearest to a bound."""


@dataclass(frozen=True)
class Relaxation:
    """A requirement that cannot be met, and its reachable value (shown units) while all others are kept.

    alone: whether no value near the one that can be had is possible, so that it is told in all its digits. standing:
    whether nobody asked for it: a floor that holds where a job sets none.
    """

    quantity: str
    relation: str
    requested: float
    reachable: float
    unit: str
    title: str
    alone: bool = False
    standing: bool = False

    @property
    def rounded_value(self) -> str:
        """The reachable value, in digits that can be asked for."""
        if self.alone:
            return exact(self.reachable)
        return safe(self.reachable, "down" if self.reachable < self.requested else "up")

    @property
    def number(self) -> float:
        """The reachable value as a number, as it is told."""
        return float(self.rounded_value)

    @property
    def with_unit(self) -> str:
        """The reachable value as it is told, with its unit."""
        return f"{self.rounded_value} {self.unit}".rstrip()

    def sentence(self, *, other_requirements: str = "all else") -> str:
        """Return the relaxation in words. other_requirements: what the other requirements are called."""
        limit_word = {"at least": "at most", "at most": "at least", "exactly": "at the nearest"}[self.relation]
        requested_value = "is kept where a job sets none" if self.standing else "is asked"
        requirement = f"{self.title} {self.relation} {self._requested_number()}"
        return (
            f"{requirement} {requested_value}, {limit_word} {self.with_unit} is possible with {other_requirements} met"
        )

    def instead(self) -> str:
        """Return the reachable requirement to ask for instead, in words."""
        return f"{self.title} {self.relation} {self.with_unit} instead of {self._requested_number()}"

    def _requested_number(self) -> str:
        return f"{self.requested:.10g} {self.unit}".rstrip()


def missed(problem: Problem, constraint: Constraint, word: Word, bound: float, value: float) -> Relaxation | None:
    """Return a missed side of a constraint with its reachable value (SI); None if the value meets it."""
    slack = FEASIBLE * (abs(bound) or 1.0)
    off = {"min": bound - value, "max": value - bound, "equals": abs(value - bound)}[word]
    if off <= slack:
        return None
    quantity = problem.quantity(constraint.quantity)
    factor, symbol = quantity.unit.factor, quantity.unit.symbol
    standing = all(item.quantity != constraint.quantity for item in problem.constraints)
    return Relaxation(
        quantity.name, RELATIONS[word], bound * factor, value * factor, symbol, quantity.title, standing=standing
    )


def relaxations(
    problem: Problem, constraint: Constraint, best: Callable[[Problem], Best | None]
) -> Iterator[Relaxation | Array]:
    """Yield the reachable value for each unreachable side of a constraint, where giving that side up is enough.

    Where a side can be had after all, the design (3 + v,) that has it with all else kept is given instead. best: gives
    the best of a problem with one objective, None where nothing meets its requirements.
    """
    for word, bound in constraint.sides:
        sense = _SENSES[word]
        free = _drop_side(problem, constraint, word)
        # What grows without bound somewhere is brought near to what is asked instead: beyond that it does not matter.
        unbounded = problem.quantity(constraint.quantity).in_line == math.inf
        sought: Sense = "target" if unbounded else sense
        reached = best(wanting(free, constraint.quantity, sought, bound if sought == "target" else None))
        if reached is None:
            continue
        item = missed(problem, constraint, word, bound, reached.value)
        if item is None:
            yield reached.design
            continue
        if sense == "target":
            rounded = item.number / problem.quantity(constraint.quantity).unit.factor
            again = best(wanting(free, constraint.quantity, "target", rounded))
            alone = again is None or missed(problem, constraint, word, rounded, again.value) is not None
            item = replace(item, alone=alone)
        yield item


def _drop_side(problem: Problem, constraint: Constraint, word: Word) -> Problem:
    """Return the problem with one side of a constraint let go.

    Of a floor a little is kept: the one that a job without it has would hide what can be had below that.
    """
    lower = constraint.lower if word == "max" else None
    upper = constraint.upper if word == "min" else None
    constraints = tuple(item for item in problem.constraints if item.quantity != constraint.quantity)
    if lower is not None or upper is not None:
        constraints = (*constraints, Constraint(quantity=constraint.quantity, lower=lower, upper=upper))
    names = restate(problem, constraint)
    left = restate(problem, constraints[-1]) if lower is not None or upper is not None else None
    floor = problem.quantity(names.quantity).floor
    if floor is not None and names.lower is not None and (left is None or left.lower is None):
        constraints = merged((*constraints, Constraint(quantity=names.quantity, lower=_LOWEST * names.lower)))
    return replace(problem, constraints=constraints)
