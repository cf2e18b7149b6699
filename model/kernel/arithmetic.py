"""Arithmetic that evaluates the same formula with reals, complex numbers and NumPy arrays.

A physical formula is written once, as a plain Python function marked `analytic`. Called from Python, it broadcasts like
any NumPy expression; called from a compiled kernel, it is compiled into that kernel (`compiler`). The imaginary part
of the formula at `x + i h`, with `h = STEP = 1e-30`, divided by `h` is the derivative. This is exact to rounding,
because no close numbers are subtracted (Squire and Trapp, SIAM Review 40(1), 1998, pp. 110-112).

The functions at the end keep only the first power of the imaginary part. With `h = 1e-30` the dropped second power
(1e-60) is far below rounding. Without the branches in the general complex functions, the compiler turns loops over
designs into vector instructions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

Function = TypeVar("Function", bound=Callable[..., Any])

STEP = 1e-30
"""Imaginary step for complex-step derivatives."""


FORMULAS: list[Callable[..., Any]] = []
"""Functions marked `analytic`."""


def analytic(formula: Function) -> Function:
    """Mark a formula that runs on floats, complex numbers and arrays in Python, and inline in compiled kernels."""
    FORMULAS.append(formula)
    return formula


def inverse(z: Any) -> Any:
    """Return 1 / z."""
    return 1.0 / z


def root(z: Any) -> Any:
    """Return the square root of z; its derivative at exactly zero is defined as zero."""
    return np.sqrt(z)


def power(base: Any, exponent: Any) -> Any:
    """Return a positive base raised to an exponent."""
    return base**exponent


def arcsine(z: Any) -> Any:
    """Return the angle in [-pi/2, pi/2], rad, whose sine is z."""
    return np.arcsin(z)


def arctangent(z: Any) -> Any:
    """Return the angle in [-pi/2, pi/2], rad, whose tangent is z."""
    return np.arctan(z)


def magnitude(z: Any) -> Any:
    """Return z or -z, whichever has a nonnegative real part: |z|, with its derivative away from zero.

    An object that represents more than one number (an enclosure over a box) provides its own `magnitude`.
    """
    if hasattr(z, "magnitude"):
        return z.magnitude()
    return np.where(np.real(z) < 0.0, -z, z)[()]
