"""Values of formulas with their derivatives: the chain rule, node by node."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ..quantity import Array, Values
from .expression import Number

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
