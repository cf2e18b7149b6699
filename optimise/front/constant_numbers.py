"""Test whether computed numbers are all equal."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...model.arrays import Array, Mask

SAME = 1e-9
"""Relative spread within which numbers count as equal.

A quantity that the requirements hold at a value leaves the search with a spread of a few last bits (2e-16 each),
amplified by its inputs. Constraints count as met to 1e-9. A spread that is visible in a drawing is a million times
greater.
"""


def is_constant(values: ArrayLike, *, size: ArrayLike = 0.0) -> Mask:
    """Return whether each column's numbers agree to within rounding: () or (m,) for values (n,) or (n, m).

    The spread is compared with the greatest magnitude, or with `size` if that is greater: the target, if the numbers
    are distances from one. NaN and infinity are ignored; a column without numbers is constant. Zero needs a size
    because it has no scale.
    """
    return np.asarray(column_ranges(values, size=size) == 0.0)


def column_ranges(values: ArrayLike, *, size: ArrayLike = 0.0) -> Array:
    """Return the range of each column of values as for `is_constant`; exactly 0 for a constant column."""
    values = np.ascontiguousarray(np.moveaxis(np.asarray(values, dtype=np.float64), 0, -1))  # ten times faster
    finite = np.where(np.isfinite(values), values, np.nan)
    low = np.fmin.reduce(finite, axis=-1, initial=np.inf)
    high = np.fmax.reduce(finite, axis=-1, initial=-np.inf)
    tolerance = SAME * np.maximum(np.maximum(np.abs(low), np.abs(high)), size)
    return np.where(high - low <= tolerance, 0.0, high - low)
