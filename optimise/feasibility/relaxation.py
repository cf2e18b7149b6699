"""Reachable values in place of a requirement that cannot be met, rounded so that they can be required.

Rounded to nearest, every other limit would be unreachable: if 42.80776 deg is the limit, no design has 42.8078 deg.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from typing import Literal

from ...model.arrays import Array
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..problem.requirements import RELATIONS, Constraint, Sense, Word, merge_constraints
from ..problem.restatement import restate_constraint
from .best_value import Best, with_single_objective

Side = Literal["down", "up"]
"""Side of the possible values: below a greatest value ("down") or above a least value ("up")."""

DIGITS = 6
"""Significant digits of a limit: rounding gives away less than 1e-5 of it, far below any manufacturing tolerance."""
_EXACT = 12
_ROUNDING = 1e-10
"""Relative: a value closer than this to a shorter number becomes that number; a tenth of what counts as violated."""


def round_to_safe_side(value: float, side: Side, *, digits: int = DIGITS) -> str:
    """Return a limit in decimal digits, rounded to the side of the possible values.

    value: finite, in the display unit. A shorter number within rounding is used instead: 240 for 239.99999999999. It
    has no exponent from 1e-4 to 1e9, so that it can be typed as shown.
    """
    size = Decimal(repr(abs(float(value)) * _ROUNDING))
    rounded = Context(prec=digits, rounding=ROUND_FLOOR if side == "down" else ROUND_CEILING)
    return _number_text(rounded.plus(Decimal(repr(float(value))) + (size if side == "down" else -size)))


def isolated_value_in_full_digits(value: float) -> str:
    """Return an isolated possible value, in all digits that rounding errors leave certain."""
    return _number_text(Context(prec=_EXACT).plus(Decimal(repr(float(value)))))


def _number_text(number: Decimal) -> str:
    number = number.normalize()
    if number == 0:
        return "0"
    plain = -4 <= number.adjusted() < 9
    return f"{number:f}" if plain else f"{number:E}".replace("E", "e")


_LOWEST = 0.02
"""Fraction of a floor that remains when it is dropped. Values closer to locking are not worth reporting."""
_SENSES: dict[Word, Sense] = {"min": "maximise", "max": "minimise", "equals": "target"}
"""Objective that brings a quantity closest to each kind of bound."""


@dataclass(frozen=True)
class Relaxation:
    """A requirement that cannot be met, and its reachable value (display unit) if all others are met.

    alone: whether no value near the reachable one is possible, so all its digits are shown. standing: whether it is the
    default floor of a job that sets none.
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
        """The reachable value, in digits that can be required."""
        if self.alone:
            return isolated_value_in_full_digits(self.reachable)
        return round_to_safe_side(self.reachable, "down" if self.reachable < self.requested else "up")

    @property
    def reachable_number(self) -> float:
        """The reachable value as a number, as shown."""
        return float(self.rounded_value)

    @property
    def with_unit(self) -> str:
        """The reachable value as shown, with its unit."""
        return f"{self.rounded_value} {self.unit}".rstrip()

    def sentence(self, *, other_requirements: str = "all else") -> str:
        """Return the relaxation in words. other_requirements: phrase for the other requirements."""
        limit_word = {"at least": "at most", "at most": "at least", "exactly": "at the nearest"}[self.relation]
        requested_value = "applies if a job sets none" if self.standing else "is asked"
        requirement = f"{self.title} {self.relation} {self._requested_number()}"
        return (
            f"{requirement} {requested_value}, {limit_word} {self.with_unit} is possible with {other_requirements} met"
        )

    def replacement_text(self) -> str:
        """Return the reachable requirement that can replace this one, in words."""
        return f"{self.title} {self.relation} {self.with_unit} instead of {self._requested_number()}"

    def _requested_number(self) -> str:
        return f"{self.requested:.10g} {self.unit}".rstrip()


def relaxation_of_missed_bound(
    problem: Problem, constraint: Constraint, word: Word, bound: float, value: float
) -> Relaxation | None:
    """Return the violated side of a constraint with its reachable value (SI); None if the value meets it."""
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
    """Yield the reachable value for each unreachable side of a constraint, if dropping that side is enough.

    If a side can be met after all, yields instead the design (3 + v,) that meets it and all other requirements. best:
    returns the best design for a problem with one objective, or None if no design meets its requirements.
    """
    for word, bound in constraint.sides:
        sense = _SENSES[word]
        free = _drop_side(problem, constraint, word)
        # A quantity without upper bound is brought close to the required value instead; values beyond it do not matter.
        unbounded = problem.quantity(constraint.quantity).in_line == math.inf
        sought: Sense = "target" if unbounded else sense
        reached = best(with_single_objective(free, constraint.quantity, sought, bound if sought == "target" else None))
        if reached is None:
            continue
        item = relaxation_of_missed_bound(problem, constraint, word, bound, reached.value)
        if item is None:
            yield reached.design
            continue
        if sense == "target":
            rounded = item.reachable_number / problem.quantity(constraint.quantity).unit.factor
            again = best(with_single_objective(free, constraint.quantity, "target", rounded))
            alone = (
                again is None or relaxation_of_missed_bound(problem, constraint, word, rounded, again.value) is not None
            )
            item = replace(item, alone=alone)
        yield item


def _drop_side(problem: Problem, constraint: Constraint, word: Word) -> Problem:
    """Return the problem without one side of a constraint.

    A small part of a floor remains, because the default floor would hide reachable values below it.
    """
    lower = constraint.lower if word == "max" else None
    upper = constraint.upper if word == "min" else None
    constraints = tuple(item for item in problem.constraints if item.quantity != constraint.quantity)
    if lower is not None or upper is not None:
        constraints = (*constraints, Constraint(quantity=constraint.quantity, lower=lower, upper=upper))
    names = restate_constraint(problem, constraint)
    left = restate_constraint(problem, constraints[-1]) if lower is not None or upper is not None else None
    floor = problem.quantity(names.quantity).floor
    if floor is not None and names.lower is not None and (left is None or left.lower is None):
        constraints = merge_constraints(
            (*constraints, Constraint(quantity=names.quantity, lower=_LOWEST * names.lower))
        )
    return replace(problem, constraints=constraints)
