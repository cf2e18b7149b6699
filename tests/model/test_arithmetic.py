"""The shared arithmetic: from Python, compiled, real, complex, over arrays."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numba import njit

from slidercrank.model.kernel.arithmetic import STEP, arcsine, arctangent, inverse, magnitude, root
from slidercrank.model.kernel.compiler import register_formulas

CASES: list[tuple[str, Callable[[Any], Any], float, float, float]] = [
    ("inverse", inverse, 0.3, 1.0 / 0.3, -1.0 / 0.09),
    ("inverse", inverse, -4.0, -0.25, -0.0625),
    ("root", root, 0.3, math.sqrt(0.3), 0.5 / math.sqrt(0.3)),
    ("arcsine", arcsine, 0.6, math.asin(0.6), 1.25),
    ("arcsine", arcsine, -0.6, -math.asin(0.6), 1.25),
    ("arcsine", arcsine, 0.0, 0.0, 1.0),
    ("arctangent", arctangent, -2.0, -math.atan(2.0), 0.2),
    ("magnitude", magnitude, 2.5, 2.5, 1.0),
    ("magnitude", magnitude, -2.5, 2.5, -1.0),
]


def compiled(function: Callable[[Any], Any]) -> Callable[[Any], Any]:
    register_formulas()

    @njit
    def call(z):  # type: ignore[no-untyped-def]
        return function(z)

    found: Callable[[Any], Any] = call
    return found


@pytest.mark.parametrize(("name", "function", "x", "value", "slope"), CASES)
def test_value_and_complex_step_derivative(
    name: str, function: Callable[[Any], Any], x: float, value: float, slope: float
) -> None:
    for call in (function, compiled(function)):
        z = call(complex(x, STEP))
        # A correctly rounded operation or two.
        assert call(x) == pytest.approx(value, rel=4e-16), name
        assert z.real == pytest.approx(value, rel=4e-16), name
        assert z.imag / STEP == pytest.approx(slope, rel=1e-15), name


def test_root_of_zero_has_a_derivative_of_zero_in_kernels() -> None:
    assert compiled(root)(complex(0.0, STEP)) == 0.0


def test_magnitude_runs_over_arrays() -> None:
    np.testing.assert_array_equal(magnitude(np.array([-1.0, 0.0, 2.0])), [1.0, 0.0, 2.0])
    np.testing.assert_array_equal(magnitude(np.array([-1.0 - 1j, 2.0 + 1j])), [1.0 + 1j, 2.0 + 1j])


def test_nan_stays_nan_in_kernels() -> None:
    for function in (inverse, root, arcsine, arctangent, magnitude):
        assert math.isnan(compiled(function)(math.nan))
