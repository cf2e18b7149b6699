"""Derivatives by central differences with Richardson extrapolation, for many designs at once (Ridders' method).

C. J. F. Ridders, Advances in Engineering Software 4(2), 1982, pp. 75-76: differences at steps that halve, extrapolated
to step zero in a triangular table; the entry that differs least from its two parents is taken. Which one it is follows
from the differences alone, so the derivative under test has no say in it.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Function = Callable[[Array, NDArray[np.int64]], Array]
"""Values (m,) of designs (m, k), each a displaced copy of the design whose index is given."""

LEVELS = 13
_AT_ONCE = 4  # extrapolations of one entry: more only amplify rounding


def steps_to_the_nearest_edge(designs: Array, *, kink_without_offset: bool) -> Array:
    """Return first steps (n, 3): half-way to locking, to a zero dimension and, if asked, to the kink at e = 0."""
    r, l, e = designs.T
    a = np.abs(e)
    room = np.minimum(l - r - a, np.minimum(r, l))
    offset = np.minimum(room, a) if kink_without_offset else room
    return 0.5 * np.stack([room, room, offset], axis=1)


def derivatives(function: Function, designs: Array, first: Array, *, one_sided: bool = False) -> tuple[Array, Array]:
    """Return gradients (n, k) of designs (n, k) and the method's own estimate of their error.

    first: (n, k), the greatest step. one_sided: forward differences, for a function that has a kink at the design.
    """
    n, k = designs.shape
    index = np.arange(n)
    found = np.empty((n, k))
    error = np.empty((n, k))
    for v in range(k):
        rows: list[Array] = []
        for level in range(LEVELS):
            h = first[:, v] * 0.5**level
            ahead, behind = designs.copy(), designs.copy()
            ahead[:, v] += h
            if not one_sided:
                behind[:, v] -= h
            rows.append((function(ahead, index) - function(behind, index)) / (ahead[:, v] - behind[:, v]))
        found[:, v], error[:, v] = _extrapolate(rows, 2.0 if one_sided else 4.0, one_sided)
    return found, error


def _extrapolate(rows: list[Array], ratio: float, every_power: bool) -> tuple[Array, Array]:
    best = rows[0].copy()
    error = np.full_like(best, np.inf)
    before = rows
    for order in range(1, _AT_ONCE + 1 + 2 * every_power):
        factor = ratio**order
        after = [(factor * fine - coarse) / (factor - 1.0) for coarse, fine in pairwise(before)]
        for value, coarse, fine in zip(after, before[:-1], before[1:], strict=True):
            estimate = np.maximum(np.abs(value - fine), np.abs(value - coarse))
            better = estimate < error
            best, error = np.where(better, value, best), np.where(better, estimate, error)
        before = after
    return best, error
