"""Test whether computed numbers are all the same."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...model.arrays import Array, Mask

SAME = 1e-9
"""Relative spread of what counts as one number.

A quantity that the rules hold at a value comes out of the search with a spread of one or a few last bits (2e-16 each),
amplified by what it is computed from, and constraints count as met to 1e-9. A spread that a drawing shows is a million
times greater.
"""


def is_constant(values: ArrayLike, *, size: ArrayLike = 0.0) -> Mask:
    """Return whether the numbers of each column are equal to rounding: () or (m,) of values (n,) or (n, m).

    The spread is compared with the greatest magnitude, or with `size` if that is greater: the target, for a distance
    from it. NaN and infinity do not count; a column without numbers is constant. Zero needs a size, having no scale.
    """
    return np.asarray(column_ranges(values, size=size) == 0.0)


def column_ranges(values: ArrayLike, *, size: ArrayLike = 0.0) -> Array:
    """Return the range of each column of values, as `is_constant` takes them; exactly 0 where it is constant."""
    values = np.ascontiguousarray(np.moveaxis(np.asarray(values, dtype=np.float64), 0, -1))  # ten times faster
    finite = np.where(np.isfinite(values), values, np.nan)
    low = np.fmin.reduce(finite, axis=-1, initial=np.inf)
    high = np.fmax.reduce(finite, axis=-1, initial=-np.inf)
    tolerance = SAME * np.maximum(np.maximum(np.abs(low), np.abs(high)), size)
    return np.where(high - low <= tolerance, 0.0, high - low)
