"""Roots of many functions in brackets, by secants with Illinois weights (Dowell and Jarratt, BIT 11, 1971)."""

from collections.abc import Callable

import numpy as np

from ..arrays import Array, IntArray

_ITERATIONS = 80
_CONVERGED = 1e-15


def find_roots(
    function: Callable[[IntArray, Array], Array], begin: tuple[Array, Array], end: tuple[Array, Array]
) -> Array:
    """Return the places in brackets, (n,), where functions fall through zero.

    function: takes the brackets (m,) and a place in each (m,), and returns the values there (m,). begin, end: place and
    value, (n,), at both ends of the brackets; the value is positive at the beginning and not positive at the end.
    """
    (a, rise), (b, fall) = ((place.copy(), value.copy()) for place, value in (begin, end))
    root = a.copy()
    active, side = np.arange(len(a)), np.zeros(len(a), dtype=np.int64)
    for _ in range(_ITERATIONS):
        if not len(active):
            break
        i = active
        trial = a[i] + (b[i] - a[i]) * (rise[i] / (rise[i] - fall[i]))
        middle = 0.5 * (a[i] + b[i])
        trial = np.where((trial > a[i]) & (trial < b[i]), trial, middle)
        value = function(i, trial)
        moved = np.abs(trial - root[i])
        root[i] = trial
        is_before = value > 0.0
        fall[i] = np.where(is_before & (side[i] == 1), 0.5 * fall[i], fall[i])
        rise[i] = np.where(~is_before & (side[i] == -1), 0.5 * rise[i], rise[i])
        a[i], rise[i] = np.where(is_before, trial, a[i]), np.where(is_before, value, rise[i])
        b[i], fall[i] = np.where(is_before, b[i], trial), np.where(is_before, fall[i], value)
        side[i] = np.where(is_before, 1, -1)
        active = i[(value != 0.0) & (moved > _CONVERGED) & (b[i] - a[i] > 2.0 * _CONVERGED)]
    return root
