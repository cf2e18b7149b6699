"""Quadrature over a turn for curves with kinks: panels in the crowded angle, and a test whether one is resolved."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ..arrays import Array
from ..kernel.arithmetic import analytic

# Measured on rods 0.1 % longer than crank + offset (kappa 0.21), over random machines: 128 nodes and 12 panels of 16
# nodes leave an RMS torque off by 4e-9 and gradients by 7e-7; these 2e-14 and 2e-11. Below EVEN there are more.
PANELS = 24
EVEN = 0.21
DEEPEST = 24  # halvings of a panel
_TAIL = 3  # Legendre coefficients that show whether a panel is resolved ...
RESOLVED = 1e-12, 1e-10  # ... and their size then, relative to the greatest values of the curve and its derivatives
MOST_HALVINGS = 20_000  # panels halved for one design: beyond that, only rounding of the curves remains
ANGLE_ROUNDING = 1e-13  # rad, shift of a curve by rounding of angles and positions: halving does not reduce its effect
NOISE = 0.004  # rounding of a curve from the crank angle itself, in units of RESOLVED, times kappa^2


@analytic
def square_along(theta: Any, d: Any, gap: Any) -> Any:
    """Return l^2 cos^2(phi), m^2, exact to rounding however close to locking; gap: l - r - |e|, m, equally exact.

    l^2 - across^2 = (l - |across|) (l + |across|) loses its digits where the rod is nearly normal to the slider line.
    With psi the crank angle from there, -pi/2 for e >= 0, the factors are gap + 2 r sin^2(psi / 2) and gap + 2 |e| + 2
    r cos^2(psi / 2).
    """
    half = 0.5 * (theta - (0.5 if d.e < 0.0 else 1.5) * math.pi)
    s, c = math.sin(half), math.cos(half)
    return (gap + 2.0 * d.r * s * s) * (gap + 2.0 * abs(d.e) + 2.0 * d.r * c * c)


@analytic
def rough(values: Any, tail: Any, allowed: Any) -> bool:
    """Return whether the last Legendre coefficients of values at a panel's nodes exceed the tolerance."""
    for k in range(tail.shape[0]):
        coefficient = 0.0
        for i in range(tail.shape[1]):
            coefficient += tail[k, i] * values[i]
        if abs(coefficient) > allowed:
            return True
    return False


@analytic
def steepness(values: Any, width: Any) -> Any:
    """Return the range of the values on a panel divided by its width."""
    least = greatest = values[0]
    for i in range(values.shape[0]):
        least, greatest = min(least, values[i]), max(greatest, values[i])
    return (greatest - least) / width


@lru_cache(maxsize=1)
def panel_rule() -> tuple[Array, Array, Array]:
    """Return nodes and weights on [0, 1] of a panel, and the matrix for the last Legendre coefficients."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    orders = np.arange(16 - _TAIL, 16)
    basis = np.polynomial.legendre.legvander(nodes, 15)[:, orders]
    tail = (orders + 0.5)[:, None] * (weights[:, None] * basis).T
    return 0.5 * (nodes + 1.0), 0.5 * weights, np.ascontiguousarray(tail)


def gaps_of(crank: Array, rod: Array, offset: Array) -> Array:
    """Return l - r - |e|, exact to its own rounding: the first difference's error is added (Knuth's two-sum)."""
    first = rod - crank
    back = first - rod
    return np.asarray((first - np.abs(offset)) + ((rod - (first - back)) - (crank + back)))
