"""Bounds of formulas against the formulas' values at random points of the ranges, and linear formulas exactly."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.formula.expression import (
    ARGUMENTS,
    Call,
    Name,
    Node,
    Number,
    linear_form_of_node,
    linear_form_of_unknown,
)
from slidercrank.objectives.formula.ranges import FormulaBounds, Interval

BOX = {"a": (0.5, 2.0), "b": (-1.5, 0.75), "c": (-3.0, -0.25), "d": (0.0, 1.0)}
LENGTHS = {"crank": (0.1, 0.2), "rod": (0.5, 0.6), "offset": (-0.1, 0.1)}
RANGES = FormulaBounds({name: Interval(*ends) for name, ends in (BOX | LENGTHS).items()}, {}, {})
SIGNS: dict[str, Callable[..., float]] = {
    "neg": lambda x: -x,
    "+": lambda x, y: x + y,
    "-": lambda x, y: x - y,
    "*": lambda x, y: x * y,
    "/": lambda x, y: x / y,
}
NAMED: dict[str, Callable[..., float]] = {"abs": abs, "min": min, "max": max}
MATHS = ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan")
MEANING = {**SIGNS, **NAMED, **{name: getattr(math, name) for name in MATHS}}


def value(node: Node, at: dict[str, float]) -> float:
    """Return a formula's value; `ValueError` where it is not defined."""
    if isinstance(node, Number):
        return node.si
    if isinstance(node, Name):
        return at[node.name]
    given = [value(item, at) for item in node.arguments]
    if node.function == "**":
        found = given[0] ** given[1]
        if isinstance(found, complex):
            raise ValueError("a root of a negative number")
        return float(found)
    return float(MEANING[node.function](*given))


def random_node(random: np.random.Generator, depth: int) -> Node:
    """Return a random formula of the names in `BOX`."""
    if depth == 0 or random.random() < 0.15:
        if random.random() < 0.75:
            return Name(str(random.choice([*BOX])))
        number = float(random.choice([-2.0, -0.5, 0.25, 1.0, 3.0]))
        return Number(number, str(number))
    function = str(random.choice([*MEANING, "**"]))
    if function == "**":
        exponent = float(random.choice([-2.0, -1.0, 0.5, 2.0, 3.0]))
        return Call(function, (random_node(random, depth - 1), Number(exponent, str(exponent))))
    count = ARGUMENTS.get(function, (1, 1) if function == "neg" else (2, 2))[0]
    return Call(function, tuple(random_node(random, depth - 1) for _ in range(count)))


def test_no_value_of_a_random_formula_is_beyond_its_bounds() -> None:
    random = np.random.default_rng(61)
    points = [dict(zip(BOX, corner, strict=True)) for corner in itertools.product(*BOX.values())]
    points += [{name: float(random.uniform(*ends)) for name, ends in BOX.items()} for _ in range(40)]
    taken = 0
    while taken < 600:
        node = random_node(random, 3)
        try:
            found = RANGES.bounds_of_formula(node)
        except InputError:
            continue
        for at in points:
            try:
                held = value(node, at)
            except (ValueError, ZeroDivisionError, OverflowError):
                continue
            room = 1e-12 * (1.0 + abs(held))
            assert found.lower - room <= held <= found.upper + room, (node, at)
            assert held != 0.0 or found.spans_zero, (node, at)
        taken += 1


@pytest.mark.parametrize("function", sorted([*MEANING, "**"]))
def test_bounds_of_one_function_are_reached(function: str) -> None:
    """Of names that stand once, bounds are the least and the greatest value.

    Of two names at corners; of one to the spacing of 20,000 points, of which a root makes 1 %.
    """
    for names in itertools.permutations(BOX, 1 if function == "**" else ARGUMENTS.get(function, (2, 2))[0]):
        if function == "neg":
            names = names[:1]
        exponent = (Number(3.0, "3"),) if function == "**" else ()
        node = Call(function, (*(Name(name) for name in names), *exponent))
        try:
            found = RANGES.bounds_of_formula(node)
        except InputError:
            continue
        held = []
        for point in itertools.product(
            *(np.linspace(*BOX[name], 5 if len(names) > 1 else 20_001).tolist() for name in names)
        ):
            try:
                held.append(value(node, dict(zip(names, point, strict=True))))
            except (ValueError, ZeroDivisionError):
                continue
        if math.isfinite(found.upper - found.lower) and not (function == "**" and BOX[names[0]][0] < 0.0):
            assert found.lower == pytest.approx(min(held), abs=0.02)
            assert found.upper == pytest.approx(max(held), abs=0.02)


def test_linear_formulas_have_exactly_the_values_of_what_they_stand_for() -> None:
    """In fractions; which formulas are linear follows from their second differences."""
    random = np.random.default_rng(62)
    names = ("a", "b")
    taken = 0

    def node_of(depth: int) -> tuple[Node, Callable[[Fraction, Fraction], Fraction]]:
        if depth == 0:
            if random.random() < 0.5:
                place = int(random.integers(2))
                return Name(names[place]), lambda a, b: (a, b)[place]
            number = Fraction(int(random.integers(-8, 9)), 4) or Fraction(1)
            return Number(float(number), str(float(number))), lambda a, b: number
        (one, first), (other, second) = node_of(depth - 1), node_of(depth - 1)
        function = str(random.choice(["neg", "+", "-", "*", "/"]))
        if function == "neg":
            return Call("neg", (one,)), lambda a, b: -first(a, b)
        return Call(function, (one, other)), {
            "+": lambda a, b: first(a, b) + second(a, b),
            "-": lambda a, b: first(a, b) - second(a, b),
            "*": lambda a, b: first(a, b) * second(a, b),
            "/": lambda a, b: first(a, b) / second(a, b),
        }[function]

    while taken < 200:
        node, exact = node_of(3)
        found = linear_form_of_node(node, {name: linear_form_of_unknown(name) for name in names})
        if found is None or not found.factors:
            continue
        factors = dict(found.factors)
        for a, b in itertools.product((Fraction(1, 3), Fraction(-7, 5), Fraction(2)), repeat=2):
            assert exact(a, b) == factors.get("a", 0) * a + factors.get("b", 0) * b + found.constant, node
        taken += 1


def test_even_powers_are_never_negative_and_odd_ones_may_be() -> None:
    assert RANGES.bounds_of_formula(Call("**", (Name("b"), Number(2.0, "2")))).lower == 0.0
    assert RANGES.bounds_of_formula(Call("**", (Name("b"), Number(3.0, "3")))).lower <= BOX["b"][0] ** 3
