"""Formulas as trees of numbers in SI, names and functions; evaluating a tree in an algebra gives it a meaning.

Algebras here are text, formulas exactly linear in dimensions and variables with factors as fractions, and values with
derivatives by the chain rule, node by node.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol, TypeVar

import numpy as np

from ..quantity import Array, Values

T = TypeVar("T")


@dataclass(frozen=True)
class Number:
    """A number with its unit. si: its value in SI. digits, unit: as typed; "" for a plain number."""

    si: float
    digits: str
    unit: str = ""


@dataclass(frozen=True)
class Name:
    """A quantity, a dimension or a varying number."""

    name: str


@dataclass(frozen=True)
class Call:
    """A function of other nodes. function: an operator in `SIGNS`, "neg" for a unary minus, or a name."""

    function: str
    arguments: tuple[Node, ...]


Node = Number | Name | Call

SIGNS = {"+": 1, "-": 1, "*": 2, "/": 2, "neg": 3, "**": 4}
"""Operators and how strongly each binds; equal operators associate to the left, powers to the right."""
ANGLES = ("sin", "cos", "tan")
INVERSES = ("asin", "acos", "atan")
ARGUMENTS = {"sqrt": (1, 1), "abs": (1, 1), "min": (2, 20), "max": (2, 20), **dict.fromkeys(ANGLES + INVERSES, (1, 1))}
"""Functions with their minimum and maximum number of arguments."""
_ATOM = 9


class Algebra(Protocol[T]):
    """A meaning of formulas, such as values, units, ranges or text."""

    def number(self, number: Number) -> T:
        """Return the meaning of a number."""
        ...

    def name(self, name: str) -> T:
        """Return the meaning of a name."""
        ...

    def call(self, function: str, arguments: list[T]) -> T:
        """Return the meaning of a function, from the meanings of its arguments."""
        ...


def evaluate_in_algebra(node: Node, algebra: Algebra[T]) -> T:
    """Return the meaning of a formula in an algebra."""
    if isinstance(node, Number):
        return algebra.number(node)
    if isinstance(node, Name):
        return algebra.name(node.name)
    return algebra.call(node.function, [evaluate_in_algebra(item, algebra) for item in node.arguments])


def names_in(node: Node) -> tuple[str, ...]:
    """Return the names in a formula without repetition, in order of appearance."""

    def occurrences(node: Node) -> Iterator[str]:
        if isinstance(node, Name):
            yield node.name
        for item in node.arguments if isinstance(node, Call) else ():
            yield from occurrences(item)

    return tuple(dict.fromkeys(occurrences(node)))


class Text:
    """An algebra of texts with few brackets, each with the binding strength of its outermost operator."""

    def number(self, number: Number) -> tuple[str, int]:
        """Return a number as text."""
        plain = not number.unit and not number.digits.startswith("-")
        return f"{number.digits} {number.unit}".rstrip(), _ATOM if plain else SIGNS["neg"]

    def name(self, name: str) -> tuple[str, int]:
        """Return a name."""
        return name, _ATOM

    def call(self, function: str, arguments: list[tuple[str, int]]) -> tuple[str, int]:
        """Return a function as text."""
        if function not in SIGNS:
            return f"{function}({', '.join(text for text, _ in arguments)})", _ATOM
        strength = SIGNS[function]
        if function == "neg":
            return f"-{_bracketed_text(arguments[0], strength)}", strength
        left, right = arguments
        if function == "**":
            return f"{_bracketed_text(left, strength + 1)}**{_bracketed_text(right, strength)}", strength
        return f"{_bracketed_text(left, strength)} {function} {_bracketed_text(right, strength + 1)}", strength


def _bracketed_text(part: tuple[str, int], least: int) -> str:
    text, strength = part
    return text if strength >= least else f"({text})"


def formula_text(node: Node) -> str:
    """Return a formula as text, identical for formulas that differ only in spaces and redundant brackets."""
    return evaluate_in_algebra(node, Text())[0]


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

    def plus_multiple_of(self, addend: Linear, times: Fraction = Fraction(1)) -> Linear:
        """Return the sum with a multiple of another linear formula."""
        factors = dict(self.factors)
        for name, factor in addend.factors:
            factors[name] = factors.get(name, Fraction(0)) + times * factor
        nonzero = tuple((name, factor) for name, factor in factors.items() if factor)
        return Linear(nonzero, self.constant + times * addend.constant)

    def multiplied_by(self, factor: Fraction) -> Linear:
        """Return a multiple."""
        return Linear((), Fraction(0)).plus_multiple_of(self, factor) if factor else Linear((), Fraction(0))


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
            return first.multiplied_by(Fraction(-1))
        if function in ("+", "-"):
            return first.plus_multiple_of(last, Fraction(1 if function == "+" else -1))
        if function == "*" and not (first.factors and last.factors):
            return first.multiplied_by(last.constant) if not last.factors else last.multiplied_by(first.constant)
        if function == "/" and not last.factors and last.constant:
            return first.multiplied_by(1 / last.constant)
        if function == "abs" and first == Linear((("offset", Fraction(1)),), Fraction(0)):
            return Linear(((SIZE, Fraction(1)),), Fraction(0))
        return None


def linear_form_of_node(node: Node, definitions: Mapping[str, Linear | None]) -> Linear | None:
    """Return a formula as linear in the names that it contains; None if it is not linear.

    definitions: linear formulas by name; `linear_form_of_unknown` gives those for dimensions and variables.
    """
    return evaluate_in_algebra(node, _LinearAlgebra(definitions))


def linear_form_of_unknown(name: str) -> Linear:
    """Return a dimension or a variable as a linear formula."""
    return Linear(((name, Fraction(1)),), Fraction(0))


Slope = Callable[[Array, Array], Array]
UNARY: dict[str, tuple[Callable[[Array], Array], Slope]] = {
    "neg": (np.negative, lambda x, y: np.full_like(x, -1.0)),
    "sqrt": (np.sqrt, lambda x, y: 0.5 / y),
    "abs": (np.abs, lambda x, y: np.where(x < 0.0, -1.0, 1.0)),
    "sin": (np.sin, lambda x, y: np.cos(x)),
    "cos": (np.cos, lambda x, y: -np.sin(x)),
    "tan": (np.tan, lambda x, y: 1.0 + y * y),
    "asin": (np.arcsin, lambda x, y: 1.0 / np.sqrt((1.0 - x) * (1.0 + x))),
    "acos": (np.arccos, lambda x, y: -1.0 / np.sqrt((1.0 - x) * (1.0 + x))),
    "atan": (np.arctan, lambda x, y: 1.0 / (1.0 + x * x)),
}
"""Functions of one argument x, with their derivative as a function of x and of the value y."""
Partials = tuple[Array, Array]
BINARY: dict[str, tuple[Callable[[Array, Array], Array], Callable[[Array, Array, Array], Partials]]] = {
    "+": (np.add, lambda a, b, y: (np.ones_like(a), np.ones_like(b))),
    "-": (np.subtract, lambda a, b, y: (np.ones_like(a), np.full_like(b, -1.0))),
    "*": (np.multiply, lambda a, b, y: (b, a)),
    "/": (lambda a, b: np.where(b == 0.0, np.nan, a / b), lambda a, b, y: (1.0 / b, -y / b)),
    "**": (
        lambda a, b: np.where((a == 0.0) & (b < 0.0), np.nan, np.power(a, b)),
        lambda a, b, y: (np.where(b == 0.0, 0.0, b * np.power(a, b - 1.0)), y * np.log(a)),
    ),
}
"""Operations on two arguments a and b, with both derivatives as functions of a, b and the value y.

Division by zero is undefined rather than infinite: min, max and atan would turn infinity into a number.
"""


@dataclass(frozen=True)
class Slopes:
    """An algebra of values (n,) and gradients (n, d); without gradients if the leaves have none.

    leaves: values of the names. n, d: shape of the zero gradients of plain numbers.
    """

    leaves: Mapping[str, Values]
    n: int
    d: int
    gradients: bool

    def number(self, number: Number) -> Values:
        """Return a number, the same for all designs."""
        return Values(np.full(self.n, number.si), np.zeros((self.n, self.d)) if self.gradients else None)

    def name(self, name: str) -> Values:
        """Return the values of a name."""
        return self.leaves[name]

    def call(self, function: str, arguments: list[Values]) -> Values:
        """Return a function of its arguments; at a kink, with the slope for the first active argument."""
        if function in ("min", "max"):
            return _minimum_or_maximum(function, arguments)
        argument_values = [item.values for item in arguments]
        values = (
            UNARY[function][0](argument_values[0])
            if function in UNARY
            else BINARY[function][0](argument_values[0], argument_values[1])
        )
        if not self.gradients:
            return Values(values, None)
        return Values(
            values,
            weighted_sum_of_gradients(
                partial_derivatives(function, argument_values, values), [item.gradients for item in arguments]
            ),
        )


def partial_derivatives(function: str, arguments: list[Array], values: Array) -> tuple[Array, ...]:
    """Return the derivatives of a smooth function with respect to its arguments, each shaped like the arguments."""
    if function in UNARY:
        return (UNARY[function][1](arguments[0], values),)
    return BINARY[function][1](arguments[0], arguments[1], values)


def weighted_sum_of_gradients(slopes: tuple[Array, ...], gradients: list[Array | None]) -> Array:
    """Return the sum of gradients (..., d) weighted by slopes (...); a slope is ignored if its gradient is zero."""
    total: Array | None = None
    for slope, gradient in zip(slopes, gradients, strict=True):
        assert gradient is not None
        part = np.where(gradient == 0.0, 0.0, slope[..., None] * gradient)
        total = part if total is None else total + part
    assert total is not None
    return total


def _minimum_or_maximum(function: str, arguments: list[Values]) -> Values:
    stacked = np.stack([item.values for item in arguments])
    first = (np.argmin if function == "min" else np.argmax)(stacked, axis=0)  # NaN counts as active
    rows = np.arange(stacked.shape[1])
    slopes = [item.gradients for item in arguments if item.gradients is not None]
    return Values(stacked[first, rows], np.stack(slopes)[first, rows] if slopes else None)
