"""Formulas that are linear in dimensions and varying numbers, exactly: their factors as fractions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from .expression import Node, Number, fold

SIZE = "|offset|"
"""The offset without its sign, as a name of linear formulas."""


@dataclass(frozen=True)
class Linear:
    """A sum of factors times names, and a constant, SI. factors: none is zero, in the order of the names."""

    factors: tuple[tuple[str, Fraction], ...]
    constant: Fraction

    @property
    def names(self) -> tuple[str, ...]:
        """The names that it depends on."""
        return tuple(name for name, _ in self.factors)

    def plus(self, other: Linear, times: Fraction = Fraction(1)) -> Linear:
        """Return the sum with another one times a factor."""
        found = dict(self.factors)
        for name, factor in other.factors:
            found[name] = found.get(name, Fraction(0)) + times * factor
        kept = tuple((name, factor) for name, factor in found.items() if factor)
        return Linear(kept, self.constant + times * other.constant)

    def times(self, factor: Fraction) -> Linear:
        """Return a multiple."""
        return Linear((), Fraction(0)).plus(self, factor) if factor else Linear((), Fraction(0))


@dataclass(frozen=True)
class _Linears:
    """An algebra of linear formulas; None for what is none. known: those that are named."""

    known: Mapping[str, Linear | None]

    def number(self, number: Number) -> Linear | None:
        return Linear((), Fraction(number.si))

    def name(self, name: str) -> Linear | None:
        return self.known.get(name)

    def call(self, function: str, arguments: list[Linear | None]) -> Linear | None:
        given = [item for item in arguments if item is not None]
        if len(given) < len(arguments):
            return None
        one, other = given[0], given[-1]
        if function == "neg":
            return one.times(Fraction(-1))
        if function in ("+", "-"):
            return one.plus(other, Fraction(1 if function == "+" else -1))
        if function == "*" and not (one.factors and other.factors):
            return one.times(other.constant) if not other.factors else other.times(one.constant)
        if function == "/" and not other.factors and other.constant:
            return one.times(1 / other.constant)
        if function == "abs" and one == Linear((("offset", Fraction(1)),), Fraction(0)):
            return Linear(((SIZE, Fraction(1)),), Fraction(0))
        return None


def linear_of(node: Node, known: Mapping[str, Linear | None]) -> Linear | None:
    """Return a formula that is linear in what it names; None if it is not. known: what names mean, as `unknown`."""
    return fold(node, _Linears(known))


def unknown(name: str) -> Linear:
    """Return a dimension or a varying number itself."""
    return Linear(((name, Fraction(1)),), Fraction(0))
