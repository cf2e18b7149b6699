"""Curves over the crank angle as polynomials on panels: means, extremes and integrals to rounding.

On every panel, each curve is its polynomial of degree 15 through the Gauss-Legendre nodes. Panels are halved until the
last coefficients have died out, or are rounding errors of the crank angle on a steep curve. Extremes are at panel ends,
where one-sided limits count, or where the derivative of the polynomial is zero.

The crank angle of a maximum is, among equal values, the first in the cycle, counted from zero. Symmetric machines reach
their maximum more than once. These values differ by rounding, so that different computations would choose different
angles.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from ..arrays import Array, IntArray, Mask
from ..quadrature import (
    ANGLE_ROUNDING,
    DEGREE,
    FIT,
    MOST_HALVINGS,
    NODES,
    Samples,
    gauss_nodes_and_weights,
    last_coefficients_magnitude,
    resolve_panels,
)

EQUAL = 1e-9
"""Relative difference below which peaks count as equal: peaks are accurate to about 1e-13, sums that nearly cancel to
less."""
_ZERO = 1e-4
"""Angle before zero, rad, that still counts as zero.

Around an extreme f, values are equal by the rule above within sqrt(2 EQUAL |f / f''|): 4.5e-5 for a first harmonic,
1e-4 for one on a mean four times its magnitude. If that reaches zero, the first of the equal values is at zero. Rounded
to 0.01 deg, no angle then becomes the end of the cycle: half of 0.01 deg is 8.7e-5 rad.
"""
_SAME_ANGLE = 1e-3  # rad: an equally high point closer to a peak than this is the same peak


def index_of_first_maximum(values: Array, angles: Array, period: float) -> IntArray:
    """Return the indices (...) of the maxima of values (..., k); among equal values, the first by crank angle, rad.

    Angles count from zero. The index is 0 if no value is finite.
    """
    top = values.max(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        equal = values >= top - EQUAL * np.abs(top)
        turned = np.where(equal, np.mod(angles + _ZERO, period), np.inf)
        off = turned - turned.min(axis=-1, keepdims=True)
        same = equal & (np.abs(off - period * np.round(off / period)) <= _SAME_ANGLE)
    return np.asarray(np.argmax(np.where(same, values, -np.inf), axis=-1))


def wrap_into_cycle(angle: float, period: float) -> float:
    """Return a crank angle wrapped into the cycle, rad; an angle that differs from zero by rounding is zero."""
    turned = angle % period
    return 0.0 if period - turned < _ZERO else turned


Curves = Callable[[Array], Array]

_PRODUCT = 24  # number of nodes that integrate the product of three polynomials exactly
_RESOLVED = 1e-12  # remaining magnitude of the last coefficients on a resolved panel, relative to that of the curve
_SHORTEST = 1e-12  # rad
_PRODUCT_NODES, _PRODUCT_WEIGHTS = gauss_nodes_and_weights(_PRODUCT)
_AT_PRODUCT_NODES = legendre.legvander(2.0 * _PRODUCT_NODES - 1.0, DEGREE)


@dataclass(frozen=True)
class Extreme:
    """An extreme value of a curve and its crank angle, rad."""

    value: float
    angle: float


def larger_extreme(ends: tuple[Extreme, Extreme], period: float) -> Extreme:
    """Return the minimum or maximum, whichever has the larger magnitude; if equal, the first in the cycle."""
    sizes = np.abs([end.value for end in ends])
    first = ends[int(index_of_first_maximum(sizes, np.array([end.angle for end in ends]), period))]
    return Extreme(math.copysign(float(sizes.max()), first.value), first.angle)


@dataclass(frozen=True)
class Panels:
    """Curves on p panels. low, width: (p,), rad. coefficients: (p, 16, m), those of Legendre polynomials."""

    low: Array
    width: Array
    coefficients: Array

    def mean(self, curve: int, time: int | None = None) -> float:
        """Return the mean over the crank angle or over time. time: curve of the time per crank angle, in any unit."""
        if time is not None:
            return self._mean_product(self.coefficients[:, :, curve], self.coefficients[:, :, time]) / self.mean(time)
        return self.integral(curve) / float(np.sum(self.width))

    def mean_square(self, curve: int, *, subtract: float = 0.0, time: int | None = None) -> float:
        """Return the mean, as in `mean`, of the square of the curve minus a number."""
        c = self.coefficients[:, :, curve].copy()
        c[:, 0] -= subtract
        if time is None:
            return self._mean_product(c, c)
        values, weight = c @ _AT_PRODUCT_NODES.T, self.coefficients[:, :, time] @ _AT_PRODUCT_NODES.T
        integrals = (values**2 * weight) @ _PRODUCT_WEIGHTS
        return float(np.sum(self.width * integrals) / np.sum(self.width)) / self.mean(time)

    def _mean_product(self, first: Array, second: Array) -> float:
        """Return the mean over the crank angle of the product of two curves, given by coefficients (p, 16)."""
        products = np.sum(first * second / (2.0 * np.arange(DEGREE + 1) + 1.0), axis=1)
        return float(np.sum(self.width * products) / np.sum(self.width))

    def extremes(self, curve: int) -> tuple[Extreme, Extreme]:
        """Return the minimum and the maximum; among equal values the first (`index_of_first_maximum`)."""
        return self._greatest_value(self.coefficients[:, :, curve], -1.0), self._greatest_value(
            self.coefficients[:, :, curve], 1.0
        )

    def integral(self, curve: int) -> float:
        """Return the integral over the crank angle."""
        return float(np.sum(self.width * self.coefficients[:, 0, curve]))

    def integral_range(self, curve: int) -> float:
        """Return the range of the integral of the curve minus its mean; J for a torque."""
        c = self.coefficients[:, :, curve].copy()
        c[:, 0] -= self.mean(curve)
        integrals = np.array([legendre.legint(row, lbnd=-1) for row in c]) * (0.5 * self.width)[:, None]
        starts = np.concatenate([[0.0], np.cumsum(integrals.sum(axis=1))])
        values = [*starts]
        for start, row, integral in zip(starts, c, integrals, strict=False):
            values += [start + legendre.legval(x, integral) for x in _roots_in_panel(row)]
        return float(max(values) - min(values))

    def _greatest_value(self, coefficients: Array, sign: float) -> Extreme:
        c = sign * coefficients
        x = np.concatenate([[-1.0], 2.0 * NODES - 1.0, [1.0]])
        samples = legendre.legval(x, c.T)  # (p, 18)
        top, spread = samples.max(axis=1), np.ptp(samples, axis=1)
        panel, place = np.unravel_index(int(np.argmax(samples)), samples.shape)
        best, tops, places, rows = float(samples[panel, place]), [], [], []
        for i in np.flatnonzero(top + spread >= best):
            rate = legendre.legder(c[i])
            stationary, slopes = _roots_in_panel(rate), legendre.legval([-1.0, 1.0], rate)
            ends = [end for end, falls in ((-1.0, slopes[0] <= 0.0), (1.0, slopes[1] >= 0.0)) if falls]
            candidates = np.concatenate([stationary, ends])
            tops.append(legendre.legval(candidates, c[i]))
            places.append(candidates)
            rows.append(np.full(len(candidates), i))
        values, at, row = np.concatenate(tops), np.concatenate(places), np.concatenate(rows)
        angles = self.low[row] + 0.5 * (1.0 + at) * self.width[row]
        first = int(index_of_first_maximum(values, angles, float(np.sum(self.width))))
        return Extreme(sign * max(best, float(values.max())), float(angles[first]))


def resolve_curves(curves: Curves, ends: Array, reference_magnitudes: Array) -> Panels:
    """Return curves (m,) on panels between ascending ends, rad.

    curves: function of crank angles (n,) that returns (m, n), smooth between the ends. sizes: reference magnitudes (m,)
    below which values are negligible.
    """
    low, width = ends[:-1], np.diff(ends)
    low, width = low[width > _SHORTEST], width[width > _SHORTEST]

    def sample(low: Array, width: Array) -> Samples:
        angles = low[:, None] + width[:, None] * NODES
        values = curves(angles.ravel()).reshape(-1, *angles.shape)
        steep = ANGLE_ROUNDING * np.ptp(values, axis=2).T / width[:, None]
        rough: Mask = np.any(
            np.maximum(_RESOLVED * reference_magnitudes, steep) < last_coefficients_magnitude(values).T, axis=1
        )
        return rough, [np.einsum("ki,mpi->pkm", FIT, values)]

    lows, widths, coefficients = resolve_panels(sample, low, width, limit=len(low) + MOST_HALVINGS)
    order = np.argsort(lows, kind="stable")
    return Panels(lows[order], widths[order], coefficients[order])


def _roots_in_panel(coefficients: Array) -> Array:
    """Return the real roots within the panel."""
    size = np.abs(coefficients).max()
    if not size > 0.0:
        return np.zeros(0)
    trimmed = legendre.legtrim(coefficients, 1e-15 * size)
    roots = legendre.legroots(trimmed) if len(trimmed) > 1 else np.zeros(0)
    roots = roots[np.abs(roots.imag) < 1e-6].real
    return np.asarray(roots[np.abs(roots) <= 1.0])
