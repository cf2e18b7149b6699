"""The crank angle that a greatest value is named at: of equal ones the first of the cycle, counted from zero.

Symmetric machines reach their greatest value more than once. Those values differ by rounding, which would choose
another angle in each computation.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Whole

EQUAL = 1e-9
"""Share by which equal peaks may differ: peaks are exact to some 1e-13, sums that nearly cancel to less."""
_ZERO = 1e-7  # rad: a flat top is not located better, so that one this much before zero is at zero
_APART = 1e-3  # rad: what is nearer to a peak than this, and as high, is the same peak


def first_of_equal(values: Array, angles: Array, period: float) -> Whole:
    """Return the places (...) of the first of the greatest values (..., k), by crank angle, rad, from zero.

    Of values of which none is finite it is 0.
    """
    top = values.max(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        equal = values >= top - EQUAL * np.abs(top)
        turned = np.where(equal, np.mod(angles + _ZERO, period), np.inf)
        off = turned - turned.min(axis=-1, keepdims=True)
        same = equal & (np.abs(off - period * np.round(off / period)) <= _APART)
    return np.asarray(np.argmax(np.where(same, values, -np.inf), axis=-1))


def named_angle(angle: float, period: float) -> float:
    """Return a crank angle within the cycle, rad; one that is zero but for rounding is zero."""
    turned = angle % period
    return 0.0 if period - turned < _ZERO else turned
