"""Crank angle reported for a maximum: among equal values, the first in the cycle, counted from zero.

Symmetric machines reach their maximum more than once. These values differ by rounding, so that different computations
would choose different angles.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array, IntArray

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


def angle_in_cycle(angle: float, period: float) -> float:
    """Return a crank angle wrapped into the cycle, rad; an angle that differs from zero by rounding is zero."""
    turned = angle % period
    return 0.0 if period - turned < _ZERO else turned
