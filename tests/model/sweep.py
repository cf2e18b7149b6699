"""The greatest value of a curve over the cycle by brute force: a dense sweep, then nested finer ones."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Curve = Callable[[Array, Array], Array]
"""Values, zero or more, of designs (..., 1, 3) at crank angles (..., m)."""

ANGLES = 100_000
_CELLS = 4  # highest cells of the sweep that are searched further: the sweep may misjudge near-ties
_POINTS = 17
_THREADS = 2
_ROUNDS = 11  # each divides a cell by 8: 1e-4 rad to 1e-14


def greatest(curve: Curve, designs: Array, *, angles: int = ANGLES) -> Array:
    """Return the greatest value (n,) of |curve| over the cycle for designs (n, 3).

    The sweep alone is off by about (spacing / width of the peak)^2 / 2, near locking 1e-6; the nested sweeps shrink
    the spacing below rounding. A jump counts with the greater of its two limits.
    """
    spacing = 2.0 * math.pi / angles
    theta = spacing * np.arange(angles)
    cells = np.empty((len(designs), _CELLS))

    chunks = np.array_split(theta, max(1, angles // 8000))  # so that a formula's arrays stay in the cache
    starts = np.cumsum([0, *(len(chunk) for chunk in chunks)])

    def search(part: NDArray[np.int64]) -> None:
        f = np.empty(angles + 2)
        for n in part:
            for start, chunk in zip(starts, chunks, strict=False):
                np.abs(curve(designs[n, None, :], chunk), out=f[start + 1 : start + 1 + len(chunk)])
            f[0], f[-1] = f[-2], f[1]
            tops = np.flatnonzero((f[1:-1] >= f[:-2]) & (f[1:-1] >= f[2:]))
            best = tops[np.argsort(f[tops + 1])[-_CELLS:]]
            cells[n] = theta[np.resize(best[::-1], _CELLS)]

    with ThreadPoolExecutor(_THREADS) as pool:
        list(pool.map(search, np.array_split(np.arange(len(designs)), 4 * _THREADS)))
    half = spacing
    steps = np.linspace(-1.0, 1.0, _POINTS)
    value = np.zeros(len(designs))
    for _ in range(_ROUNDS):
        at = cells[..., None] + half * steps
        f = np.abs(curve(designs[:, None, None, :], at))
        best = np.argmax(f, axis=-1)
        cells = np.take_along_axis(at, best[..., None], axis=-1)[..., 0]
        value = np.maximum(value, f.max(axis=(1, 2)))
        half /= 8.0
    return value
