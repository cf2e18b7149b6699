"""Formulas that are exactly linear in dimensions and variables, with their factors as fractions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from .expression import Node, Number, evaluate_in_algebra

SIZE = "|offset|"
"""Absolute value of the offset, as a name in linear formulas."""


@dataclass(frozen=True)
class Linear:
    """A sum of factors times names, plus a constant, SI. factors: none is zero, in the order of the names."""

    factors: tuple[tuple[str, Fraction], ...]
    constant: Fraction

    @property
    def names(self) -> tuple[str, ...]:
        """The names on which it depends."""
        return tuple(name for name, _ in self.factors)

    def plus(self, addend: Linear, times: Fraction = Fraction(1)) -> Linear:
        """Return the sum with a multiple of another linear formula."""
        factors = dict(self.factors)
        for name, factor in addend.factors:
            factors[name] = factors.get(name, Fraction(0)) + times * factor
        nonzero = tuple((name, factor) for name, factor in factors.items() if factor)
        return Linear(nonzero, self.constant + times * addend.constant)

    def times(self, factor: Fraction) -> Linear:
        """Return a multiple."""
        return Linear((), Fraction(0)).plus(self, factor) if factor else Linear((), Fraction(0))


@dataclass(frozen=True)
class _LinearAlgebra:
    """An algebra of linear formulas; None for any nonlinear formula. known: linear formulas of the names."""

    definitions: Mapping[str, Linear | None]

    def number(self, number: Number) -> Linear | None:
        return Linear((), Fraction(number.si))

    def name(self, name: str) -> Linear | None:
        return self.definitions.get(name)

    def call(self, function: str, arguments: list[Linear | None]) -> Linear | None:
        linear = [item for item in arguments if item is not None]
        if len(linear) < len(arguments):
            return None
        first, last = linear[0], linear[-1]
        if function == "neg":
            return first.times(Fraction(-1))
        if function in ("+", "-"):
            return first.plus(last, Fraction(1 if function == "+" else -1))
        if function == "*" and not (first.factors and last.factors):
            return first.times(last.constant) if not last.factors else last.times(first.constant)
        if function == "/" and not last.factors and last.constant:
            return first.times(1 / last.constant)
        if function == "abs" and first == Linear((("offset", Fraction(1)),), Fraction(0)):
            return Linear(((SIZE, Fraction(1)),), Fraction(0))
        return None


def linear_of(node: Node, definitions: Mapping[str, Linear | None]) -> Linear | None:
    """Return a formula as linear in the names that it contains; None if it is not linear.

    definitions: linear formulas by name; `linear_unknown` gives those for dimensions and variables.
    """
    return evaluate_in_algebra(node, _LinearAlgebra(definitions))


def linear_unknown(name: str) -> Linear:
    """Return a dimension or a variable as a linear formula."""
    return Linear(((name, Fraction(1)),), Fraction(0))
