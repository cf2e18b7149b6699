"""Derivatives by central differences with Richardson extrapolation, for many designs at once (Ridders' method).

C. J. F. Ridders, Advances in Engineering Software 4(2), 1982, pp. 75-76: differences at steps that halve, extrapolated
to step zero in a triangular table; the entry that differs least from its two parents is taken. Which one it is follows
from the differences alone, so the derivative under test has no say in it. No entry counts as better than the rounding
of its values over its step: at small steps, differences of a few last digits agree by chance.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Function = Callable[[Array, NDArray[np.int64]], Array]
"""Values (m,) of designs (m, k), each a displaced copy of the design whose index is given."""

LEVELS = 13
_AT_ONCE = 4  # extrapolations of one entry: more only amplify rounding
_LEAST = 3  # halvings, before two entries that agree by chance could pass for settled
_SETTLED = 1e-10  # of the derivative; the tests ask for 1e-7


def steps_to_the_nearest_edge(designs: Array, *, kink_without_offset: bool) -> Array:
    """Return first steps (n, 3): an eighth of the way to locking, to zero or to e = 0.

    Greater steps would be evaluated in vain: most designs settle at a hundredth of the way, from the steps before.
    """
    r, l, e = designs.T
    a = np.abs(e)
    room = np.minimum(l - r - a, np.minimum(r, l))
    offset = np.minimum(room, a) if kink_without_offset else room
    return 0.125 * np.stack([room, room, offset], axis=1)


def derivatives(function: Function, designs: Array, first: Array, *, one_sided: bool = False) -> tuple[Array, Array]:
    """Return gradients (n, k) of designs (n, k) and the method's own estimate of their error.

    first: (n, k), the greatest step. one_sided: forward differences, for a function that has a kink at the design.
    Steps of all columns are evaluated together. They halve until the estimate is far below what the tests ask.
    """
    ratio, powers = (2.0, _AT_ONCE + 2) if one_sided else (4.0, _AT_ONCE)
    row, column = (index.ravel() for index in np.indices(designs.shape))
    best, error = np.zeros(len(row)), np.full(len(row), np.inf)
    going = np.arange(len(row))
    coarse: list[Array] = []
    for level in range(LEVELS):
        ahead, behind = designs[row[going]], designs[row[going]]
        at = np.arange(len(going)), column[going]
        h = first[row[going], column[going]] * 0.5**level
        ahead[at] += h
        if not one_sided:
            behind[at] -= h
        values = function(np.concatenate([ahead, behind]), np.tile(row[going], 2))
        fine = [(values[: len(going)] - values[len(going) :]) / (ahead[at] - behind[at])]
        rounding = np.finfo(float).eps * np.abs(values[: len(going)]) / np.abs(ahead[at] - behind[at])
        if level == 0:
            best = fine[0].copy()
        for order, before in enumerate(coarse[:powers], start=1):
            value = (ratio**order * fine[-1] - before) / (ratio**order - 1.0)
            estimate = np.maximum(np.abs(value - fine[-1]), np.abs(value - before))
            estimate = np.maximum(estimate, np.where(np.isfinite(rounding), rounding, np.inf))
            better = estimate < error[going]
            best[going[better]], error[going[better]] = value[better], estimate[better]
            fine.append(value)
        unsettled = np.ones(len(going), dtype=bool) if level < _LEAST else error[going] > _SETTLED * np.abs(best[going])
        going, coarse = going[unsettled], [values[unsettled] for values in fine]
        if not len(going):
            break
    return best.reshape(designs.shape), error.reshape(designs.shape)
