"""Bounds of a quantity over all fully rotating designs within ranges of crank, rod and |offset|.

With a = |offset|, stroke and time ratio rise with r and a and fall with l; the transmission angle does the reverse:

    dS/dr = (l+r)/x_out + (l-r)/x_in > 0      dS/da = a/x_in - a/x_out > 0      dS/dl = (l+r)/x_out - (l-r)/x_in < 0
    b = asin(a/(l-r)) - asin(a/(l+r)), the excess angle, likewise term by term; cos(mu) = (r + a)/l.

So one extreme is at the shortest crank, the longest rod and the least offset. The other is at the opposite corner if
that rotates fully. Otherwise it is on the edge of rotation l = r + a, where S = 2 sqrt(l r), cos(b) = a / (2 r + a) and
mu = 0.
"""

from collections.abc import Callable
from dataclasses import dataclass

CLEAR = 1.0 + 1e-12
"""If a linkage is closer to locking than this, rounding errors decide."""


@dataclass(frozen=True)
class LengthRanges:
    """Ranges of crank r, rod l and |offset| a, m, that contain at least one fully rotating design."""

    r0: float
    r1: float
    l0: float
    l1: float
    a0: float
    a1: float

    @property
    def rotates_fully_throughout(self) -> bool:
        """Whether the corner closest to locking rotates fully."""
        return (self.r1 + self.a1) * CLEAR < self.l0

    @property
    def longest_rotating_crank(self) -> float:
        """The longest crank that still rotates fully, m."""
        return min(self.r1, self.l1 - self.a0)


@dataclass(frozen=True)
class KnownBounds:
    """Known bounds, SI."""

    lower: float
    upper: float

    def __call__(self, _: LengthRanges) -> tuple[float, float]:
        """Return them."""
        return self.lower, self.upper


@dataclass(frozen=True, kw_only=True)
class QuantityBounds:
    """Bounds of a quantity within ranges, SI, and the changes to the ranges that raise or lower it, in words."""

    compute: Callable[[LengthRanges], tuple[float, float]]
    to_raise: str
    to_lower: str
