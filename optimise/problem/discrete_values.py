"""Design numbers with discrete values: multiples of a step, preferred numbers, a list."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array
from ...model.checks import store_as_tuples
from ...model.errors import InputError
from .requirements import Range

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
