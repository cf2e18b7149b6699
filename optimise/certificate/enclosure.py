"""Arithmetic that encloses a formula over a box of designs by a linear part and a bound on the remainder.

Over a box with coordinates d in [-1, 1]^k, a number that depends on the design has the form

    value(d) in centre + slopes . d + [-rest, rest]        wherever the formula is defined,

a Taylor model of first order (Makino and Berz, "Taylor models and other validated functional inclusion methods", Int.
J. Pure Appl. Math. 4(4), 2003). Its overestimate of the true range shrinks with the square of the box size. Each
operation is valid point by point, so a formula may be undefined elsewhere in the box.

The model's formulas are plain functions that accept any type with +, -, *, / and NumPy's sqrt and arcsin. They accept
an `Enclosure` as they accept a float, so the physics is not written twice.

Rounding: every operation adds `UNIT` times the magnitude of all operands to the rest, eight times the rounding error of
IEEE doubles; results are inflated by another `INFLATION` of their magnitude, for sines and other rounded numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numpy as np

from ...model.arrays import Array, Mask

UNIT = 2.0**-50
INFLATION = 1e-12


class Enclosure:
    """A number for each of n boxes, enclosed over the box.

    centre, rest: (n, ...). slopes: (k, n, ...). empty: where the formula is defined nowhere in the box; None for
    nowhere. If the rest is not finite, the number is unknown.
    """

    __slots__ = ("_radius", "_size", "centre", "empty", "rest", "slopes")

    def __init__(self, centre: Any, slopes: Any, rest: Any, empty: Mask | None = None) -> None:
        self.centre, self.slopes, self.rest, self.empty = centre, slopes, rest, empty
        self._radius: Array | None = None
        self._size: Array | None = None

    @property
    def radius(self) -> Array:
        """Greatest deviation of the number from its centre."""
        if self._radius is None:
            self._radius = np.abs(self.slopes).sum(axis=0) + self.rest
        return self._radius

    @property
    def greatest_magnitude(self) -> Array:
        """Upper bound on the absolute value."""
        if self._size is None:
            self._size = np.asarray(np.abs(self.centre) + self.radius)
        return self._size

    def least_and_greatest(self, low: Array | None = None, high: Array | None = None) -> tuple[Array, Array]:
        """Return the least and the greatest value, infinite where unknown.

        low, high: (k, n), the relevant part of [-1, 1]^k; all of it by default.
        """
        swing = np.abs(self.slopes).sum(axis=0)
        lowest, highest = -swing, swing
        if low is not None and high is not None:
            if self.centre.ndim > 1:
                low, high = low[..., None], high[..., None]
            at_low, at_high = self.slopes * low, self.slopes * high
            lowest, highest = np.minimum(at_low, at_high).sum(axis=0), np.maximum(at_low, at_high).sum(axis=0)
        margin = self.rest + INFLATION * self.greatest_magnitude
        least, greatest = self.centre + lowest - margin, self.centre + highest + margin
        is_finite = np.isfinite(least) & np.isfinite(greatest)
        return np.where(is_finite, least, -np.inf), np.where(is_finite, greatest, np.inf)

    def confine_to(self, low: Array, high: Array) -> Enclosure:
        """Return the number confined to low..high (n, ...): where it extends beyond them, only that interval counts."""
        clear = self.radius <= high - low
        if clear.all():
            return self
        confined = select_by_mask(clear, self, enclosure_of_ends(low, np.maximum(low, high), len(self.slopes)))
        confined.empty = self.empty
        return confined

    def magnitude(self) -> Enclosure:
        """Return the absolute value."""
        low, high = self.centre - self.radius, self.centre + self.radius
        sign = np.where(low >= 0.0, 1.0, -1.0)
        straddles_zero = (low < 0.0) & (high > 0.0)
        if not straddles_zero.any():
            return self._scaled(sign)
        # On [low, high] the absolute value lies between its chord and the chord minus the chord's height at zero.
        width = np.where(straddles_zero, high - low, 1.0)
        slope = np.where(straddles_zero, (high + low) / width, sign)
        height = np.where(straddles_zero, -2.0 * low * high / width, 0.0)
        chord = self._scaled(slope)
        return Enclosure(
            chord.centre + 0.5 * height,
            chord.slopes,
            chord.rest + 0.5 * height + UNIT * self.greatest_magnitude,
            self.empty,
        )

    def _scaled(self, factor: Any) -> Enclosure:
        weight = np.abs(factor)
        return Enclosure(
            self.centre * factor,
            self.slopes * factor,
            (self.rest + UNIT * self.greatest_magnitude) * weight,
            self.empty,
        )

    def __neg__(self) -> Enclosure:
        return Enclosure(-self.centre, -self.slopes, self.rest, self.empty)

    def __add__(self, other: Any) -> Enclosure:
        if isinstance(other, Enclosure):
            return Enclosure(
                self.centre + other.centre,
                self.slopes + other.slopes,
                self.rest + other.rest + UNIT * (self.greatest_magnitude + other.greatest_magnitude),
                _merge_empty(self.empty, other.empty),
            )
        centre = self.centre + other
        rest = self.rest + UNIT * (self.greatest_magnitude + np.abs(other))
        return Enclosure(centre, _broadcast_slopes(self.slopes, centre), rest, self.empty)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Enclosure:
        return cast(Enclosure, self + (-other))

    def __rsub__(self, other: Any) -> Enclosure:
        return cast(Enclosure, (-self) + other)

    def __mul__(self, other: Any) -> Enclosure:
        if other is self:
            return Enclosure._squared(self)
        if not isinstance(other, Enclosure):
            return self._scaled(other)
        a, b = self.centre, other.centre
        rest = np.abs(a) * other.rest + np.abs(b) * self.rest + self.radius * other.radius
        return Enclosure(
            a * b,
            a * other.slopes + b * self.slopes,
            rest + UNIT * (self.greatest_magnitude * other.greatest_magnitude),
            _merge_empty(self.empty, other.empty),
        )

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Enclosure:
        return self * other._inverted() if isinstance(other, Enclosure) else self._scaled(1.0 / other)

    def __rtruediv__(self, other: Any) -> Enclosure:
        return self._inverted()._scaled(other)

    def __pow__(self, exponent: int) -> Enclosure:
        if exponent != 2:
            raise TypeError(f"an enclosure may only be squared; got the exponent {exponent}")
        return self._squared()

    def _squared(self) -> Enclosure:
        """(c + t)^2 = c^2 + 2 c t + t^2 with t^2 in [0, radius^2]."""
        half = 0.5 * self.radius * self.radius
        rest = 2.0 * np.abs(self.centre) * self.rest + half + UNIT * self.greatest_magnitude**2
        return Enclosure(self.centre * self.centre + half, 2.0 * self.centre * self.slopes, rest, self.empty)

    def _inverted(self) -> Enclosure:
        """Return an enclosure of 1 / x.

        1 / (c + t) = 1 / c - t / c^2 + t^2 / (c^2 (c + t)); the last term is largest at the end nearest zero.
        """
        size, radius = np.abs(self.centre), self.radius
        clear = size > radius * (1.0 + INFLATION)
        inverse = 1.0 / np.where(clear, self.centre, np.nan)
        bend = (radius * inverse) ** 2 / (size - radius)
        square = inverse * inverse
        rest = self.rest * square + 0.5 * bend + UNIT * (np.abs(inverse) + radius * square + bend)
        return Enclosure(inverse + np.sign(inverse) * 0.5 * bend, -self.slopes * square, rest, self.empty)

    def _root(self) -> Enclosure:
        """Return an enclosure of the square root.

        With w^2 = c + t and q^2 = c: w = q + t / (2 q) - (q - w)^2 / (2 q); the last term is largest at the lower end.
        """
        radius = self.radius
        least, greatest = self.centre - radius, self.centre + radius
        clear = least > 0.0
        q = np.sqrt(np.where(clear, self.centre, 1.0))
        bend = (q - np.sqrt(np.where(clear, least, 1.0))) ** 2 / (2.0 * q)
        centre, slopes = q - 0.5 * bend, self.slopes * (0.5 / q)
        rest = self.rest * (0.5 / q) + 0.5 * bend + UNIT * (q + radius / q)
        if clear.all():
            return Enclosure(centre, slopes, rest, self.empty)
        # Where defined, the result lies between zero and the root of the greatest value.
        half = np.where(np.isfinite(greatest), 0.5 * np.sqrt(np.maximum(greatest, 0.0)) * (1.0 + INFLATION), np.nan)
        root = select_by_mask(clear, Enclosure(centre, slopes, rest), Enclosure(half, 0.0, half))
        root.empty = _merge_empty(self.empty, greatest < -INFLATION * np.abs(self.centre))
        return root

    def _arcsine(self) -> Enclosure:
        """Tangent at the centre; the second derivative x / (1 - x^2)^(3/2) grows with |x|."""
        largest = self.greatest_magnitude
        clear = largest < 1.0
        c, x = np.where(clear, self.centre, 0.0), np.where(clear, largest, 0.0)
        slope = 1.0 / np.sqrt(1.0 - c * c)
        bend = 0.5 * self.radius**2 * x / (1.0 - x * x) ** 1.5
        centre, slopes = np.arcsin(c), self.slopes * slope
        rest = self.rest * slope + bend * (1.0 + INFLATION) + 8.0 * UNIT * (1.0 + self.radius * slope)
        if clear.all():
            return Enclosure(centre, slopes, rest, self.empty)
        low = np.arcsin(np.clip(self.centre - self.radius, -1.0, 1.0))
        high = np.arcsin(np.clip(self.centre + self.radius, -1.0, 1.0))
        outside = np.abs(self.centre) - self.radius > 1.0 + INFLATION
        wide = Enclosure(0.5 * (low + high), 0.0, 0.5 * (high - low) + 8.0 * UNIT)
        arcsine = select_by_mask(clear, Enclosure(centre, slopes, rest), wide)
        arcsine.empty = _merge_empty(self.empty, outside)
        return arcsine

    def sin(self) -> Enclosure:
        """Return the sine: the tangent at the centre, and a bound of 1 on the second derivative.

        NumPy calls it in arrays.
        """
        sine, cosine = np.sin(self.centre), np.cos(self.centre)
        rest = self.rest * np.abs(cosine) + 0.5 * self.radius**2 * (1.0 + INFLATION)
        rest = rest + 8.0 * UNIT * (1.0 + self.greatest_magnitude)
        one = np.ones_like(sine)
        return Enclosure(sine, self.slopes * cosine, rest, self.empty).confine_to(-one, one)

    def cos(self) -> Enclosure:
        """Return the cosine, see `sin`."""
        return (self + 0.5 * np.pi).sin()

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        """Support NumPy functions that formulas call on enclosures, and operators with an array on the left."""
        if method != "__call__" or options or ufunc not in _FUNCTIONS:
            return NotImplemented
        return _FUNCTIONS[ufunc](*inputs)


_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.sqrt: Enclosure._root,
    np.arcsin: Enclosure._arcsine,
    np.sin: Enclosure.sin,
    np.cos: Enclosure.cos,
    np.negative: lambda a: -a,
    np.add: lambda a, b: a + b if isinstance(a, Enclosure) else b + a,
    np.subtract: lambda a, b: a - b if isinstance(a, Enclosure) else b.__rsub__(a),
    np.multiply: lambda a, b: a * b if isinstance(a, Enclosure) else b * a,
    np.true_divide: lambda a, b: a / b if isinstance(a, Enclosure) else b.__rtruediv__(a),
}


def enclosure_of_ends(low: Any, high: Any, k: int) -> Enclosure:
    """Return a number known only by its ends."""
    low, high = np.broadcast_arrays(np.asarray(low, dtype=np.float64), np.asarray(high, dtype=np.float64))
    rest = 0.5 * (high - low) + UNIT * (np.abs(low) + np.abs(high))
    return Enclosure(0.5 * (low + high), np.zeros((k, *low.shape)), rest)


def constant_like(value: Any, like: Enclosure) -> Enclosure:
    """Return a number that is the same for all designs in a box, with the shape of another one."""
    centre = np.broadcast_to(
        np.asarray(value, dtype=np.float64), np.broadcast_shapes(np.shape(value), like.centre.shape)
    )
    return Enclosure(centre, np.zeros((len(like.slopes), *centre.shape)), np.zeros(centre.shape))


def sign_of(value: Enclosure) -> Array:
    """Return a number's sign if it is constant over a box; otherwise NaN."""
    low, high = value.least_and_greatest()
    return np.where(low > 0.0, 1.0, np.where(high < 0.0, -1.0, np.nan))


def join_parts(left: Enclosure, right: Enclosure) -> Enclosure:
    """Return the parts (n, p) of two numbers side by side."""
    empty = None if left.empty is None or right.empty is None else left.empty & right.empty
    return Enclosure(
        np.concatenate([left.centre, right.centre], axis=1),
        np.concatenate([left.slopes, right.slopes], axis=2),
        np.concatenate([left.rest, right.rest], axis=1),
        empty,
    )


def free_unknown(low: Array, high: Array, column: int, k: int) -> Enclosure:
    """Return the free unknown that varies from low to high (n,) along axis `column` of k, shape (n, 1)."""
    slopes = np.zeros((k, len(low), 1))
    slopes[column, :, 0] = 0.5 * (high - low)
    size = np.abs(low) + np.abs(high)
    return Enclosure(0.5 * (low + high)[:, None], slopes, (UNIT * size)[:, None])


def select_by_mask(mask: Mask, chosen: Enclosure, alternative: Enclosure) -> Enclosure:
    """Return one number where the mask holds, the other elsewhere."""
    empty = None
    if chosen.empty is not None or alternative.empty is not None:
        empty = np.where(
            mask,
            False if chosen.empty is None else chosen.empty,
            False if alternative.empty is None else alternative.empty,
        )
    return Enclosure(
        np.where(mask, chosen.centre, alternative.centre),
        np.where(mask, chosen.slopes, alternative.slopes),
        np.where(mask, chosen.rest, alternative.rest),
        empty,
    )


def _merge_empty(first: Mask | None, second: Mask | None) -> Mask | None:
    if first is None or second is None:
        return first if second is None else second
    return first | second


def _broadcast_slopes(slopes: Array, centre: Array) -> Array:
    """Return slopes broadcast to the shape of a centre."""
    shape = (len(slopes), *np.shape(centre))
    return slopes if slopes.shape == shape else np.broadcast_to(slopes, shape)
