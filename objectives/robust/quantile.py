"""A quantile of a quantity over the tolerances: quasi-Monte Carlo with common random numbers.

Every design sees the same sample, scrambled Sobol points as deviations, so that the quantile is a smooth function of
the design and designs compare without noise (I. M. Sobol 1967; A. B. Owen, "Randomly permuted (t,m,s)-nets", 1995).

Within a tolerance box a quantity is a quadratic to a few parts in 10^9 of itself: it is evaluated exactly at the points
of a star, a full quadratic is put through them, and the sample is drawn from that. Not where the offset may be zero:
what depends on its size has a kink there, and every machine of the sample is evaluated. The quantile is the estimate of
Harrell and Davis ("A new distribution-free quantile estimator", Biometrika 69(3), 1982): a mean of all order statistics
with the weights of a beta distribution, hence without the kinks of a single one.

Of normal errors the quantile of the linear part is known, and serves as control variate: the sample gives only by how
much the quadratic part moves the quantile (P. Glasserman, "Monte Carlo Methods in Financial Engineering", 2003, ch.
4.1).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...model.tolerance.spreads import Shape, spread
from ..quantity import Array
from .points import star

_LEAST = 2.0**-40  # a scrambled point at zero would lie at minus infinity of a normal distribution


@lru_cache(maxsize=32)
def sample(columns: tuple[int, ...], shape: Shape, samples: int, seed: int) -> Array:
    """Return deviations (samples, 3) in units of the limits: scrambled Sobol points, spread; zero in other columns."""
    from scipy.stats import qmc

    # Sobol points fill evenly in powers of two only.
    power = (samples - 1).bit_length()
    points = qmc.Sobol(len(columns), scramble=True, rng=np.random.default_rng(seed)).random_base2(power)
    found = np.zeros((len(points), 3))
    found[:, list(columns)] = spread(shape).ppf(np.clip(points, _LEAST, 1.0 - _LEAST))
    found.setflags(write=False)
    return found


@lru_cache(maxsize=32)
def weights(share: float, samples: int) -> Array:
    """Return the weight of each order statistic, ascending, in the quantile of a share, (samples,)."""
    from scipy.special import betainc

    edges = np.linspace(0.0, 1.0, samples + 1)
    found = np.diff(betainc((samples + 1) * share, (samples + 1) * (1.0 - share), edges))
    found /= found.sum()
    found.setflags(write=False)
    return found


@lru_cache(maxsize=32)
def interpolation(columns: tuple[int, ...], shape: Shape, samples: int, seed: int) -> Array:
    """Return the matrix from values at the star to the sample: (points, samples)."""
    found = np.ascontiguousarray((_basis(sample(columns, shape, samples, seed), columns) @ _fit(columns)).T)
    found.setflags(write=False)
    return found


@lru_cache(maxsize=32)
def linear(columns: tuple[int, ...]) -> Array:
    """Return the matrix from values at the star to slopes along the uncertain dimensions: (d, points)."""
    found = np.asarray(_fit(columns)[1 : 1 + len(columns)])
    found.setflags(write=False)
    return found


def linear_quantile(coefficients: Array, share: float) -> tuple[Array, Array]:
    """Return the quantile (n,) of c . z, c (n, d), z normal with limits of three deviations, and its gradient by c."""
    from scipy.special import ndtri

    sigmas = float(ndtri(share)) / 3.0  # `spread` takes the limit as three deviations
    size = np.sqrt((coefficients**2).sum(axis=1))
    slope = coefficients / np.where(size > 0.0, size, 1.0)[:, None]
    return sigmas * size, sigmas * slope


def _fit(columns: tuple[int, ...]) -> Array:
    return np.asarray(np.linalg.pinv(_basis(star(list(columns)), columns)), dtype=np.float64)


def _basis(points: Array, columns: tuple[int, ...]) -> Array:
    """Return the monomials up to the second degree at points (q, 3), (q, m)."""
    one = np.ones(len(points))
    linear = [points[:, a] for a in columns]
    pairs = [points[:, a] * points[:, b] for i, a in enumerate(columns) for b in columns[i:]]
    return np.stack([one, *linear, *pairs], axis=1)
