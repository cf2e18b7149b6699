"""Requirements and objectives of a problem: ranges and discrete values of numbers, constraints, objectives.

SI, immutable.
"""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Literal

import numpy as np

from ...model.arrays import Array
from ...model.checks import store_as_tuples
from ...model.errors import InputError, number_in_si_and_usual_unit, warn_user
from ...objectives.kinds import ANGLE
from ...objectives.registry import FACTS, QUANTITIES, first_names_text
from ...objectives.torque_and_power import PEAK_TORQUE

Sense = Literal["minimise", "maximise", "target"]
SENSES: dict[str, Sense] = {
    "minimise": "minimise",
    "minimize": "minimise",
    "maximise": "maximise",
    "maximize": "maximise",
    "target": "target",
}
"""The sense for each word, in either spelling."""
Word = Literal["min", "max", "equals"]
"""Words of a constraint's bounds."""
RELATIONS: dict[Word, str] = {"min": "at least", "max": "at most", "equals": "exactly"}
"""The words as relations, in messages."""
_TURN = 2.0 * math.pi
_NAME = re.compile(r"[a-z][a-z0-9_]*")
# A `Problem` requires the spelling of `expression.formula_text`.
_FORMULA = re.compile(r".* - .*|-.*|.*[+*/(].*|[a-z_]+\..*")


@dataclass(frozen=True, kw_only=True)
class Range:
    """Range of a dimension, m; equal bounds fix it."""

    lower: float
    upper: float

    def __post_init__(self) -> None:
        if not (_is_finite(self.lower) and _is_finite(self.upper) and self.lower <= self.upper):
            raise InputError(
                f"a range needs lower <= upper, both finite; got {_number_text(self.lower)} to "
                f"{_number_text(self.upper)}"
            )

    @property
    def fixed(self) -> bool:
        """Whether the range is a single value."""
        return self.lower == self.upper


@dataclass(frozen=True, kw_only=True)
class Constraint:
    """A quantity that must lie in [lower, upper], SI; None leaves a side open; equal bounds require a value.

    Warns about a bound that was probably meant in another unit.
    """

    quantity: str
    lower: float | None = None
    upper: float | None = None

    def __post_init__(self) -> None:
        _require_name(self.quantity)
        if self.lower is None and self.upper is None:
            raise InputError(f"the constraint on {self.quantity} needs a lower bound, an upper bound or a value")
        for bound in (self.lower, self.upper):
            if bound is not None and not _is_finite(bound):
                raise InputError(
                    f"the constraint on {self.quantity} must be a finite number in SI units; got {_number_text(bound)}"
                )
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            raise InputError(
                f"the constraint on {self.quantity} is empty: min {self.lower:g} exceeds max {self.upper:g}"
            )
        _warn_of_units(self.quantity, {"lower": self.lower, "upper": self.upper})

    @property
    def equality(self) -> bool:
        """Whether a single value is required."""
        return self.lower is not None and self.lower == self.upper

    @property
    def sides(self) -> list[tuple[Word, float]]:
        """The closed sides: each bound with its word in a job."""
        if self.equality and self.lower is not None:
            return [("equals", self.lower)]
        pairs: tuple[tuple[Word, float | None], ...] = (("min", self.lower), ("max", self.upper))
        return [(word, bound) for word, bound in pairs if bound is not None]


@dataclass(frozen=True, kw_only=True)
class Objective:
    """A quantity to minimise, to maximise, or to bring to a target (in its SI unit).

    sense: "minimize" and "maximize" become "minimise" and "maximise". Warns as `Constraint` does.

    Raises `InputError` for any other word, and for a name that no quantity can have. `Problem`, which may have custom
    quantities, checks whether the quantity exists.
    """

    quantity: str
    sense: Sense
    target: float | None = None

    def __post_init__(self) -> None:
        _require_name(self.quantity)
        object.__setattr__(self, "sense", _standard_sense(self.quantity, self.sense))
        if (self.sense == "target") != (self.target is not None):
            raise InputError(f"the objective {self.quantity} must have a target if, and only if, its sense is 'target'")
        if self.target is not None and not _is_finite(self.target):
            raise InputError(
                f"the target of {self.quantity} must be a finite number in SI units; got {_number_text(self.target)}"
            )
        _warn_of_units(self.quantity, {"target": self.target})


def merge_constraints(constraints: Iterable[Constraint]) -> tuple[Constraint, ...]:
    """Return constraints with those on the same quantity merged. Raises `InputError` if these contradict each other."""
    merged_constraints: dict[str, Constraint] = {}
    for constraint in constraints:
        name = constraint.quantity
        same = (merged_constraints.get(name, constraint), constraint)
        lower = max((item.lower for item in same if item.lower is not None), default=None)
        upper = min((item.upper for item in same if item.upper is not None), default=None)
        merged_constraints[name] = Constraint(quantity=name, lower=lower, upper=upper)
    return tuple(merged_constraints.values())


def _require_name(name: object) -> None:
    """Raise `InputError` for a name that no quantity can have."""
    if not isinstance(name, str) or not (_NAME.fullmatch(name) or _FORMULA.fullmatch(name)):
        raise InputError(
            "the name of a quantity may only have lower-case letters, digits and underscores, such as "
            f"{PEAK_TORQUE.name!r}; got {name!r}; choose from {first_names_text(QUANTITIES)}, or a custom quantity "
            "of the problem"
        )


def _standard_sense(name: str, sense: object) -> Sense:
    """Return a sense in its standard spelling. Raises `InputError` for an unknown one."""
    if not isinstance(sense, str) or sense not in SENSES:
        raise InputError(
            f"the sense of the objective {name} must be {', '.join(map(repr, SENSES))}; got {sense!r}; "
            "choose one of these"
        )
    return SENSES[sense]


def _warn_of_units(quantity: str, numbers: Mapping[str, float | None]) -> None:
    """Warn about the first number, SI, whose magnitude is plausible only in the quantity's usual unit."""
    kind = FACTS[quantity].kind if quantity in FACTS else None
    if kind is None or kind.believed is None:
        return
    most = min(kind.believed[1], _TURN) if kind is ANGLE else kind.believed[1]
    for name, number in numbers.items():
        if number is not None and abs(number) > most > 0.0:
            usual = kind.metric
            doubt = number_in_si_and_usual_unit(f"{name} =", number, kind.unit, usual.symbol, usual.factor)
            warn_user(f"requirements must be in SI: {quantity}, {doubt}")
            break


def _is_finite(value: object) -> bool:
    return isinstance(value, Real) and math.isfinite(value)


def _number_text(value: object) -> str:
    return f"{value:g}" if isinstance(value, Real) else repr(value)


SAME = 1e-12
"""Relative: closer values are the same."""


@dataclass(frozen=True, kw_only=True)
class Discrete:
    """A design number with discrete values.

    name: crank, rod, offset, or an extra variable of the machine. values: possible values, ascending, SI. rule: rule in
    words, such as "multiples of 0.5 mm". Raises `InputError` for values that are empty, not finite, or not ascending.
    """

    name: str
    values: tuple[float, ...]
    rule: str

    def __post_init__(self) -> None:
        store_as_tuples(self, "values")
        rising = all(low < high for low, high in zip(self.values, self.values[1:], strict=False))
        if not self.values or not all(map(math.isfinite, self.values)) or not rising:
            raise InputError(f"the values of {self.name} must be finite and ascending, at least one; sort them")

    def values_in(self, ends: Range) -> Array:
        """Return the values within a range."""
        tolerance = SAME * max(abs(ends.lower), abs(ends.upper))
        return np.array([value for value in self.values if ends.lower - tolerance <= value <= ends.upper + tolerance])


def require_distinct_numbers(discrete: Sequence[Discrete], names: Sequence[str]) -> None:
    """Raise `InputError` unless each is for a different number of the design."""
    given = [item.name for item in discrete]
    for name in given:
        if name not in names:
            raise InputError(
                f"discrete values must be for one of {', '.join(names)}; got {name!r}; make it a variable too"
            )
        if given.count(name) > 1:
            raise InputError(f"the values of {name} may be given only once; got them twice; keep one")
