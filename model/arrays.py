"""Types of arrays by content: numbers, truth values, whole numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
IntArray = NDArray[np.int64]


def distinct(values: IntArray, axis: int | None = None) -> IntArray:
    """Return whole numbers, or rows of them along axis 0, each once, ascending.

    Like `np.unique`, which without counts first loads `numpy.ma`: a thirtieth of a command's time.
    """
    return np.unique(values, axis=axis, return_counts=True)[0]


def row_lengths(rows: Array) -> Array:
    """Return the Euclidean length (n,) of each row: bit for bit `np.linalg.norm`, but faster for few rows."""
    return np.asarray(np.sqrt(np.add.reduce(rows * rows, axis=1)))
