"""Deviation of measured curves from the computed curves of one design, and the best-fit shifts.

The shifts of the crank angle and of the value minimise the sum of squared residuals. The value shift has a closed form:
minus the mean residual. The angle shift is found on a grid over the whole cycle, of one turn or two, then by golden
sections around the lowest points. For this search alone, a large number of samples is first averaged in groups of
neighbouring crank angles.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.cylinders_and_turns import TURN, cycle_turns
from ...model.machine.mechanism import Mechanism
from ..kinds import Kind
from ..quantity import Array
from .curve_extremes import defined_curves, golden_section_maxima

_SHIFTS = 1440  # of the grid, per turn
_NODES = 2880  # samples per turn of the computed curve from which the grid interpolates
_GROUPS = 2048  # a group then spans 0.2 deg if samples are evenly spaced
_CANDIDATES = 6
_SECTIONS = 40  # to 1e-10 rad
_SAME_ANGLE = 1e-3  # rad: crank angles closer than this, such as those from rounded times, count as one
_CONSTANT = 1e-12  # relative to the maximum magnitude
_EQUAL = 1e-9  # relative: among shifts that fit within this of each other, the smaller one is reported


@dataclass(frozen=True)
class Fit:
    """Shifts that bring measured samples closest to the computed curve, by least squares; SI.

    crank_angle: shift added to the measured crank angles, rad, at most half a cycle. value: shift added to the measured
    values. rms: root mean square of the remaining deviation.
    """

    crank_angle: float
    value: float
    rms: float


@dataclass(frozen=True)
class Deviation:
    """Deviation, measured minus computed, of one curve; SI, NaN where friction leaves the curve undetermined.

    count: number of samples. rms: root mean square. largest: deviation of largest magnitude, with its sign.
    crank_angle, sample: its crank angle in the cycle, rad, and sample. fit: best shifts; None for samples at fewer than
    three crank angles, and for a curve that is constant or somewhere undetermined.
    """

    name: str
    title: str
    kind: Kind
    count: int
    rms: float
    mean: float
    largest: float
    crank_angle: float
    sample: float
    fit: Fit | None


def curve_deviations(
    mechanism: Mechanism, linkage: Linkage, crank_angle: Array, measured: Mapping[str, Array]
) -> list[Deviation]:
    """Return the deviations of measured curves from the computed curves of one fully rotating linkage.

    crank_angle: (n,), rad, in any order and over any number of turns. measured: (n,) by the name of a curve of
    `defined_curves`, SI; NaN where nothing was measured, but not everywhere. Raises the same errors as
    `defined_curves`.
    """
    period = TURN * cycle_turns(mechanism)
    theta = np.mod(crank_angle, period)
    computed = {curve.name: curve for curve in defined_curves(mechanism, linkage, theta)}
    nodes = np.linspace(0.0, period, _NODES * cycle_turns(mechanism) + 1)
    table = {curve.name: curve.values for curve in defined_curves(mechanism, linkage, nodes)}
    results = []
    for name, samples in measured.items():
        curve, measured_rows = computed[name], np.isfinite(samples)
        angles, values = theta[measured_rows], samples[measured_rows]
        off = values - curve.values[measured_rows]
        if np.isfinite(off).all():
            largest = int(np.argmax(np.abs(off)))
            numbers = (
                _rms(off),
                float(off.mean()),
                float(off[largest]),
                float(angles[largest]),
                float(values[largest]),
            )
            fit = _best_shifts(mechanism, linkage, name, angles, values, nodes, table[name])
        else:
            numbers, fit = (math.nan,) * 5, None
        results.append(Deviation(name, curve.title, curve.kind, len(values), *numbers, fit))
    return results


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values * values)))


def _best_shifts(
    mechanism: Mechanism, linkage: Linkage, name: str, angles: Array, values: Array, nodes: Array, table: Array
) -> Fit | None:
    """Return the best shifts. nodes, table: crank angles over the cycle and the computed curve at these angles."""
    period, shift_count = float(nodes[-1]), _SHIFTS * cycle_turns(mechanism)
    varies = float(np.ptp(table)) > _CONSTANT * float(np.abs(table).max())  # and is not NaN
    if not varies or not _has_three_angles(angles, period):
        return None
    theta, means, weights = _group_neighbours(angles, values)

    def computed(at: Array) -> Array:
        return next(c.values for c in defined_curves(mechanism, linkage, np.mod(at, period)) if c.name == name)

    def remaining_variance(curve: Array) -> Array:
        """Return the weighted variance of the residuals, for curves (k, groups)."""
        off = means - curve
        middle = off @ weights
        variance: Array = ((off - middle[:, None]) ** 2) @ weights
        return variance

    def at_shifts(shifts: Array) -> Array:
        every = theta[None, :] + shifts[:, None]
        return -remaining_variance(computed(every.ravel()).reshape(every.shape))

    step = period / shift_count
    grid: Array = step * np.arange(shift_count, dtype=np.float64)
    coarse = np.concatenate(
        [
            remaining_variance(np.interp(np.mod(theta + part[:, None], period), nodes, table))
            for part in np.split(grid, 8)
        ]
    )
    lowest = np.flatnonzero((coarse <= np.roll(coarse, 1)) & (coarse <= np.roll(coarse, -1)))
    lowest = lowest[np.argsort(coarse[lowest], kind="stable")][:_CANDIDATES]
    best, shifts = golden_section_maxima(at_shifts, grid[lowest] - step, grid[lowest] + step, _SECTIONS)
    # Also try no shift: it is as good as others if a curve is piecewise constant.
    best, shifts = np.append(best, at_shifts(np.zeros(1))), np.append(shifts, 0.0)
    shifts = 0.5 * period - np.mod(0.5 * period - shifts, period)  # at most half a cycle
    size = float(np.abs(means).max())
    good = np.flatnonzero(best >= best.max() * (1.0 + _EQUAL) - (_CONSTANT * size) ** 2)
    shift = float(shifts[good[np.argmin(np.abs(shifts[good]))]])
    off = values - computed(angles + shift)
    return Fit(shift, 0.0 - float(off.mean()), _rms(off - off.mean()))


def _has_three_angles(angles: Array, period: float) -> bool:
    """Return whether there are three distinct crank angles, one more than there are shifts."""
    ordered = np.sort(angles)
    for _ in range(2):
        first = ordered[0]
        ordered = ordered[(ordered >= first + _SAME_ANGLE) & (ordered <= angles.min() + period - _SAME_ANGLE)]
        if not len(ordered):
            return False
    return True


def _group_neighbours(angles: Array, values: Array) -> tuple[Array, Array, Array]:
    """Return mean crank angles and values for groups of neighbours, and their fractions of the samples."""
    order = np.argsort(angles, kind="stable")
    ends = np.unique(np.linspace(0, len(order), min(len(order), _GROUPS) + 1).astype(np.intp))
    counts = np.diff(ends)
    theta, means = (np.add.reduceat(samples[order], ends[:-1]) / counts for samples in (angles, values))
    return theta, means, counts / len(order)
