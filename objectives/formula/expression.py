"""Formulas as trees of numbers in SI, names and functions; evaluating a tree in an algebra gives it a meaning."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol, TypeVar

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
