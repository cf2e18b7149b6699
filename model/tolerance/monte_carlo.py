"""Monte Carlo simulation of the slider position: many machines, each with errors drawn at random.

Nothing is linearised: every machine's own slider position is compared with that of the nominal linkage. A machine keeps
its errors over the whole cycle, including those of the crank angle and the contact points in its pins.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.loads.load import require_word
from ..machine.mechanism import Mechanism
from .error_distributions import Draw, Spreads, angle_ranges_where_error_counts, limits_of_sources, source_influences

CHUNK = 1024
"""Machines per chunk: each chunk has its own random stream, so that runs of any length begin alike."""
_MOST = 100_000_000  # maximum number of stored errors: 0.8 GB


@dataclass(frozen=True)
class Simulation:
    """Errors of n simulated machines.

    crank_angle: (m,), rad. errors: (n, m), m: slider position minus the nominal position, along +x. greatest: (n,), m:
    maximum magnitude of the error over the part of the cycle that counts, at sampled angles. A machine whose linkage
    does not rotate fully has NaN throughout; `stuck` counts these machines.
    """

    crank_angle: Array
    errors: Array
    greatest: Array
    stuck: int


@dataclass(frozen=True)
class Summary:
    """Mean, standard deviation and percentiles of a sample; `percentiles` holds pairs of percent and value."""

    mean: float
    deviation: float
    percentiles: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Yield:
    """Fraction of machines within a limit, with its interval at the given confidence."""

    share: float
    low: float
    high: float
    count_within: int
    samples: int
    confidence: float


def simulate_machines_with_errors(
    mechanism: Mechanism,
    linkage: Linkage,
    crank_angle: ArrayLike = (),
    *,
    samples: int = 20_000,
    seed: int = 1,
    spreads: Spreads | None = None,
    angles: int = 128,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Simulation:
    """Return errors of `samples` machines at crank angles (m,), rad, and each machine's maximum over the cycle.

    angles: samples per turn for the maximum error, concentrated near locking. They miss at most (pi / angles)^2 / 2, a
    fraction 3e-4, of a smooth curve, less than the scatter of the simulation. progress: function called with the counts
    of finished and of all machines. cancelled: function called between chunks; if it returns true, the machines so far
    are returned. The same seed gives the same machines. Raises `InputError` for arguments that are out of range.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    spreads = Spreads() if spreads is None else spreads
    theta = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    _require_integer("samples", samples, least=1)
    _require_integer("seed", seed, least=0)
    if theta.ndim != 1 or not np.all(np.isfinite(theta)):
        raise InputError("crank angles must be a list of finite numbers, in rad")
    if samples * max(1, len(theta)) > _MOST:
        raise InputError(
            f"the number of samples times crank angles must be at most {_MOST:,}; got {samples:,} times "
            f"{len(theta):,}; reduce one"
        )
    limits, counted = (
        limits_of_sources(mechanism, linkage),
        np.concatenate(angle_ranges_where_error_counts(mechanism, linkage, count=angles)),
    )
    everywhere = np.concatenate([theta, counted])
    ideal = linkage.at(everywhere).slider_position
    errors, greatest = np.empty((samples, len(theta))), np.empty(samples)
    count = 0
    for chunk in range(-(-samples // CHUNK)):
        if cancelled is not None and cancelled():
            break
        random = np.random.default_rng([seed, chunk])
        rows = slice(count, min(count + CHUNK, samples))
        drawn = spreads.draw_errors(limits, CHUNK, random)
        off = _slider_positions(linkage, drawn, everywhere)[: rows.stop - rows.start] - ideal
        errors[rows] = off[:, : len(theta)]
        greatest[rows] = np.abs(off[:, len(theta) :]).max(axis=1)
        count = rows.stop
        if progress is not None:
            progress(count, samples)
    return Simulation(theta, errors[:count], greatest[:count], int(np.isnan(greatest[:count]).sum()))


def _require_integer(name: str, value: object, *, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise InputError(f"{name} must be a whole number of at least {least}; got {value!r}")


def _slider_positions(linkage: Linkage, drawn: Draw, angles: Array) -> Array:
    """Return the slider positions (n, m) of machines; NaN for machines that do not rotate fully."""
    r, l = (linkage.crank + drawn.crank)[:, None], (linkage.rod + drawn.rod)[:, None]
    e = (linkage.offset + drawn.offset)[:, None]
    x, y = drawn.pin_x[:, None], drawn.pin_y[:, None]
    sine, cosine = np.sin(drawn.crank_angle)[:, None], np.cos(drawn.crank_angle)[:, None]
    turned_sine = np.sin(angles) * cosine + np.cos(angles) * sine
    turned_cosine = np.cos(angles) * cosine - np.sin(angles) * sine
    l_sin = e - y - r * turned_sine
    turns = (r > 0.0) & (l > r + np.abs(e) + np.hypot(x, y))
    l_cos = np.sqrt(np.where(turns, l * l - l_sin * l_sin, np.nan))
    positions: Array = x + r * turned_cosine + linkage.sign * l_cos
    return positions


def summarise_sample(values: ArrayLike, *, percents: Sequence[float] = (0.135, 5.0, 50.0, 95.0, 99.865)) -> Summary:
    """Return mean, standard deviation and percentiles of a sample (n,), ignoring stuck machines (NaN).

    The percentiles 0.135 and 99.865 % are three standard deviations of a normal distribution. Raises `InputError` if
    fewer than two machines remain.
    """
    sample = np.asarray(values, dtype=np.float64)
    turning = sample[np.isfinite(sample)]
    if len(turning) < 2:
        raise InputError(f"a summary needs at least two machines that rotate fully; got {len(turning)}; simulate more")
    levels = np.percentile(turning, percents)
    pairs = tuple((float(percent), float(value)) for percent, value in zip(percents, levels, strict=True))
    return Summary(float(turning.mean()), float(turning.std(ddof=1)), pairs)


def yield_within(
    errors: ArrayLike, limit: float, *, confidence: float = 0.95, method: Literal["exact", "wilson"] = "exact"
) -> Yield:
    """Return the fraction of errors (n,) with magnitudes up to the limit, m, and its confidence interval.

    method: "exact" (Clopper and Pearson, Biometrika 26, 1934, pp. 404-413) or "wilson" (Wilson's score interval, JASA
    22, 1927, pp. 209-212), by `scipy.stats.binomtest`. A machine that is stuck (NaN) is not within the limit.
    """
    from scipy.stats import binomtest

    if not (math.isfinite(limit) and limit >= 0.0):
        raise InputError(f"the limit of the position error must be zero or more and finite; got {limit:g} m")
    if not 0.0 < confidence < 1.0:
        raise InputError(f"confidence must be between 0 and 1; got {confidence:g}; 0.95 is usual")
    require_word("method", method, Literal["exact", "wilson"])
    sizes = np.abs(np.asarray(errors, dtype=np.float64))
    if sizes.ndim != 1 or not len(sizes):
        raise InputError(f"errors must be a list with at least one number; got an array of shape {sizes.shape}")
    count = int(np.count_nonzero(sizes <= limit))
    interval = binomtest(count, len(sizes)).proportion_ci(confidence, method=method)
    return Yield(count / len(sizes), float(interval.low), float(interval.high), count, len(sizes), confidence)


def variance_contributions(
    mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike, *, spreads: Spreads | None = None
) -> Array:
    """Return the first-order variance that each source adds to the position error, (8, m), m^2, at angles (m,), rad."""
    linkage = require_single_rotating_linkage(mechanism, linkage)
    limits = limits_of_sources(mechanism, linkage)
    per_source: Array = (
        source_influences(mechanism, linkage, crank_angle) ** 2
        * ((Spreads() if spreads is None else spreads).variances_per_squared_limit * limits * limits)[:, None]
    )
    return per_source
