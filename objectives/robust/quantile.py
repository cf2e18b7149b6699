"""Quantile of a quantity over the tolerances: quasi-Monte Carlo with common random numbers.

Every design sees the same sample: scrambled Sobol points as deviations. The quantile is therefore a smooth function of
the design, and designs compare without noise (I. M. Sobol 1967; A. B. Owen, "Randomly permuted (t,m,s)-nets", 1995).

Within a tolerance box, a quantity is quadratic to a relative accuracy of a few parts in 10^9. It is evaluated exactly
at the points of a star and fitted with a full quadratic, from which the sample is drawn. If the offset may be zero,
quantities that depend on its magnitude have a kink; every machine in the sample is then evaluated instead. The
estimator is that of Harrell and Davis ("A new distribution-free quantile estimator", Biometrika 69(3), 1982). It is a
mean of all order statistics with weights from a beta distribution, and so lacks the kinks of a single order statistic.

For normal errors the quantile of the linear part is known and serves as a control variate. The sample then only gives
the shift of the quantile due to the quadratic part (P. Glasserman, "Monte Carlo Methods in Financial Engineering",
2003, ch. 4.1).
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ...model.arrays import IntArray
from ...model.tolerance.error_distributions import Shape, error_distribution
from ..quantity import Array
from .worst_points import quadratic_fit_points

_FAINT = 1e-15  # smaller weights are rounding errors
_LEAST = 2.0**-40  # a scrambled point at zero would map to minus infinity in a normal distribution


@dataclass(frozen=True)
class Sample:
    """Sample of machines for a percentile, common to all designs.

    columns: columns of the uncertain dimensions. shape, samples, seed: distribution, number and seed of the deviations.
    share: fraction of machines below the percentile.
    """

    columns: tuple[int, ...]
    shape: Shape
    samples: int
    seed: int
    share: float

    @cached_property
    def deviations(self) -> Array:
        """Deviations (samples, 3) in units of the limits: scrambled Sobol points with the distribution.

        Zero in other columns.
        """
        from scipy.stats import qmc

        # Sobol points fill space evenly only in powers of two.
        power = (self.samples - 1).bit_length()
        points = qmc.Sobol(len(self.columns), scramble=True, rng=np.random.default_rng(self.seed)).random_base2(power)
        deviations = np.zeros((len(points), 3))
        deviations[:, list(self.columns)] = error_distribution(self.shape).ppf(np.clip(points, _LEAST, 1.0 - _LEAST))
        return deviations

    @cached_property
    def order_statistic_weights(self) -> Array:
        """Weight of each ascending order statistic in the quantile, (samples,)."""
        from scipy.special import betainc

        count = len(self.deviations)
        edges = np.linspace(0.0, 1.0, count + 1)
        weights = np.diff(betainc((count + 1) * self.share, (count + 1) * (1.0 - self.share), edges))
        return np.asarray(weights / weights.sum())

    @cached_property
    def interpolation_matrix(self) -> Array:
        """Matrix from values at the star to values at the sample: (points, samples)."""
        return np.ascontiguousarray((_monomials(self.deviations, self.columns) @ self._quadratic_fit_matrix).T)

    @cached_property
    def slope_matrix(self) -> Array:
        """Matrix from values at the star to slopes by the uncertain dimensions: (d, points)."""
        return self._quadratic_fit_matrix[1 : 1 + len(self.columns)]

    @cached_property
    def _quadratic_fit_matrix(self) -> Array:
        return np.asarray(
            np.linalg.pinv(_monomials(quadratic_fit_points(list(self.columns)), self.columns)), dtype=np.float64
        )

    def quantile_of_machines(self, machines: Array, slopes: Array) -> tuple[Array, Array]:
        """Return quantiles (n,) and gradients (n, width) from those of all machines, (n, s) and (n, s, width)."""
        order, rank = self._ranked_machines_and_weights(machines)
        quantile = _einsum_by_design("ns,s->n", np.take_along_axis(machines, order, axis=1), rank)
        slope = _einsum_by_design("s,nsd->nd", rank, np.take_along_axis(slopes, order[:, :, None], axis=1))
        return quantile, np.where(np.isfinite(quantile)[:, None], slope, 0.0)

    def quantile_from_star_points(self, values: Array, slopes: Array) -> tuple[Array, Array]:
        """Return quantiles (n,) and gradients (n, width) from pieces at the star, (n, q, p) and (n, q, p, width)."""
        absent = ~np.isfinite(values[:, 0])[:, :, None]
        drawn = _einsum_by_design(
            "npq,qs->nps", np.where(absent, 0.0, values.transpose(0, 2, 1)), self.interpolation_matrix
        )
        drawn = np.where(absent, -np.inf, drawn)
        piece = np.argmax(drawn, axis=1)
        machines = np.take_along_axis(drawn, piece[:, None], axis=1)[:, 0]
        order, rank = self._ranked_machines_and_weights(machines)
        quantile = _einsum_by_design("ns,s->n", np.take_along_axis(machines, order, axis=1), rank)
        ordered_pieces = np.take_along_axis(piece, order, axis=1)
        slope = np.zeros((len(values), slopes.shape[3]))
        weighed = self.interpolation_matrix.T[order]
        for p in range(values.shape[2]):
            share_of = _einsum_by_design("ns,nsq->nq", rank * (ordered_pieces == p), weighed)
            slope += _einsum_by_design("nq,nqd->nd", share_of, slopes[:, :, p])
        if self.shape != "normal":
            return quantile, slope
        rows = np.arange(len(values))
        top = np.argmax(values[:, 0], axis=1)
        control = _einsum_by_design("nq,dq->nd", values[rows, :, top], self.slope_matrix)
        deviations = self.deviations[:, list(self.columns)]
        order, rank = self._ranked_machines_and_weights(_einsum_by_design("nd,ds->ns", control, deviations.T))
        shift = _einsum_by_design("s,nsd->nd", rank, deviations[order])
        exact, exact_slope = linear_quantile(control, self.share)
        by_control = _einsum_by_design("nd,dq->nq", exact_slope - shift, self.slope_matrix)
        quantile = quantile + exact - _einsum_by_design("nd,nd->n", shift, control)
        return quantile, slope + _einsum_by_design("nq,nqd->nd", by_control, slopes[rows, :, top])

    def _ranked_machines_and_weights(self, machines: Array) -> tuple[IntArray, Array]:
        """Return the machines (n, s), in ascending order, that determine the quantile, and their weights (s,)."""
        first, last = np.flatnonzero(self.order_statistic_weights > _FAINT)[
            [0, -1]
        ]  # few of many: the others need no sorting
        tail = np.sort(np.argpartition(machines, (first, last), axis=1)[:, first : last + 1], axis=1)
        order = np.argsort(np.take_along_axis(machines, tail, axis=1), axis=1, kind="stable")
        return np.take_along_axis(tail, order, axis=1), self.order_statistic_weights[first : last + 1]


sample = lru_cache(maxsize=32)(Sample)
"""The sample for these columns, deviations and fraction, cached for the next designs."""


def linear_quantile(coefficients: Array, share: float) -> tuple[Array, Array]:
    """Return the quantile (n,) of c . z and its gradient by c (n, d); z is normal, its limits three deviations."""
    from scipy.special import ndtri

    sigmas = float(ndtri(share)) / 3.0  # `error_distribution` also takes the limit as three deviations
    size = np.sqrt((coefficients**2).sum(axis=1))
    slope = coefficients / np.where(size > 0.0, size, 1.0)[:, None]
    return sigmas * size, sigmas * slope


def _monomials(points: Array, columns: tuple[int, ...]) -> Array:
    """Return the monomials of degree two and lower at points (q, 3), (q, m)."""
    constant = np.ones(len(points))
    linear = [points[:, a] for a in columns]
    pairs = [points[:, a] * points[:, b] for i, a in enumerate(columns) for b in columns[i:]]
    return np.stack([constant, *linear, *pairs], axis=1)


def _einsum_by_design(sums: str, *factors: Array) -> Array:
    """Return sums of products that are identical to the last bit for a design, whatever other designs are present.

    BLAS sums in another order if the number of rows changes, einsum if the strides change.
    """
    return np.asarray(np.einsum(sums, *map(np.ascontiguousarray, factors), optimize=False))
