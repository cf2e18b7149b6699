"""Points spread evenly over a simplex or a grid, from which scalarisations take aim."""

from __future__ import annotations

import itertools
from math import comb

import numpy as np

from ..front.stationarity import Array


def simplex(objectives: int, least: int) -> Array:
    """Return at least `least` points (n, m) of the unit simplex, all sums of m shares of 1 / p.

    I. Das and J. E. Dennis, "Normal-boundary intersection: a new method for generating the Pareto surface in nonlinear
    multicriteria optimization problems", SIAM J. Optim. 8(3), 1998, sec. 4.
    """
    parts = 1
    while comb(parts + objectives - 1, objectives - 1) < least:
        parts += 1
    bars = itertools.combinations(range(parts + objectives - 1), objectives - 1)
    ends = np.array([(-1, *bar, parts + objectives - 1) for bar in bars])
    return np.asarray((np.diff(ends, axis=1) - 1) / parts)


def grid(lower: Array, upper: Array, parts: int) -> Array:
    """Return the (parts^m, m) points at the upper ends of equal intervals between bounds (m,) each."""
    steps = np.arange(1, parts + 1) / parts
    places = np.array(list(itertools.product(steps, repeat=len(lower))))
    return np.asarray(lower + places * (upper - lower))
