"""Means, mean squares and peaks of a crankshaft's curve over its cycle, with exact derivatives.

Means are by Gauss quadrature; for peaks see `peak_search`.

In means over time, every crank angle has the weight 1 / p, where p is the speed profile. A panel is resolved if the
curve T is and, for the mean square over time, if T / sqrt(p) is, too.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IntArray, Mask
from ..machine.speed_profile import time_per_angle
from ..quadrature import NODES, WEIGHTS, Samples, last_coefficients_magnitude, resolve_panels
from .peak_search import Segments, find_maxima
from .shaft import Shaft
from .shaft_segments import segments_between_breakpoints

NOTHING = 1e-12
"""If the total is below this fraction of the cylinders' individual magnitudes, it counts as zero: they cancel up to
rounding."""


def shaft_peaks(shaft: Shaft, *, limit: int, stroke: bool | None = None) -> tuple[Array, Array, Array]:
    """Return values, crank angles (n, kept) and derivatives for the highest local maxima of the curve's magnitude.

    stroke: whether only the outward stroke, or only the inward stroke, counts; None for both. The value is infinite
    where friction locks the design.
    """
    segments = segments_between_breakpoints(shaft.all_breakpoints, shaft.period)
    live = None if stroke is None else shaft.moves_outward(segments) == stroke
    maxima = find_maxima(shaft, segments, shaft.panels_per_turn, limit=limit, counted=live)
    nothing = np.isfinite(maxima.values) & (maxima.values <= NOTHING * maxima.size[:, None])
    values = np.where(nothing, 0.0, maxima.values)
    values[~shaft.unlocked_designs, 0] = np.inf
    return values, np.mod(maxima.places, shaft.period), np.where(nothing[:, :, None], 0.0, maxima.slopes)


MEAN, SQUARE, SQUARE_OVER_TIME = range(3)
"""Rows of `Means`: mean and mean square over the crank angle, mean square over time."""
_RESOLVED = 1e-12  # maximum of the last coefficients on a resolved panel, relative to the curve's maximum


@dataclass(frozen=True)
class Means:
    """Means (3, n) in the rows above, and their derivatives (3, n, v) or None. NaN where friction locks the design.

    nothing: (n,), whether the cylinders cancel to within rounding.
    """

    values: Array
    gradients: Array | None
    nothing: Mask


def shaft_means(shaft: Shaft, count: int) -> Means:
    """Return the means of n designs."""
    segments = segments_between_breakpoints(shaft.all_breakpoints, shaft.period)
    rows = 2 if shaft.profile is None else 3
    sums, slopes, sizes = np.zeros((rows, count)), np.zeros((rows, count, shaft.numbers)), np.zeros((2, count))

    def sample(low: Array, width: Array, row: IntArray, probe: Array) -> Samples:
        angle = low[:, None] + width[:, None] * NODES
        curve, size = shaft.evaluate(row, probe, angle)
        value, time = curve[:, :, 0], _time_weight(shaft, angle)
        rough = _is_rough(value, size, sizes[0], row, width)
        if time is not None:
            rough |= _is_rough(np.sqrt(time) * value, np.sqrt(time) * size, sizes[1], row, width)
        return rough, [angle, value]

    row, probe, low, width, _ = segments.split_into_panels(shaft.panels_per_turn)
    _, width, row, probe, angle, value = resolve_panels(sample, low, width, row, probe)
    weight, time = width[:, None] * WEIGHTS / shaft.period, _time_weight(shaft, angle)
    weights = [weight] * 2 if time is None else [weight, weight, weight * time]
    for index, row_weights in enumerate(weights):
        np.add.at(sums[index], row, (row_weights * (value if index == MEAN else value**2)).sum(axis=1))
    if shaft.gradients:
        slope = shaft.evaluate(row, probe, angle, gradients=True)[0][:, :, 2:]
        for index, row_weights in enumerate(weights):
            rate = row_weights if index == MEAN else 2.0 * row_weights * value
            np.add.at(slopes[index], row, np.einsum("pk,pkv->pv", rate, slope))
    if shaft.gradients:
        _add_jumps_at_moving_breakpoints(shaft, segments, slopes)
    sums[:, ~shaft.unlocked_designs] = np.nan
    nothing = np.sqrt(sums[SQUARE]) <= NOTHING * sizes[0]
    mean_rows = [MEAN, SQUARE, SQUARE if rows == 2 else SQUARE_OVER_TIME]
    return Means(sums[mean_rows], slopes[mean_rows] if shaft.gradients else None, nothing)


def _time_weight(shaft: Shaft, angle: Array) -> Array | None:
    """Return the time per crank angle divided by its mean; None at constant speed."""
    return None if shaft.profile is None else time_per_angle(shaft.profile, angle)


def _is_rough(value: Array, size: Array, sizes: Array, row: IntArray, width: Array) -> Mask:
    """Return which panels (p,) are not resolved, from values and magnitudes (p, 16).

    Raises the maxima (n,) of the designs.
    """
    np.maximum.at(sizes, row, size.max(axis=1, initial=0.0))
    rough: Mask = last_coefficients_magnitude(value) * np.minimum(1.0, width) > _RESOLVED * sizes[row]
    return rough


def _add_jumps_at_moving_breakpoints(shaft: Shaft, segments: Segments, slopes: Array) -> None:
    """Add to derivatives (rows, n, v) the effect of moving breakpoints at which the curve jumps."""
    ends = np.stack([segments.low, segments.high], axis=1)
    edge = shaft.evaluate(segments.row, segments.probe, ends)[0][:, :, 0]
    rate = shaft.breakpoint_gradients(segments.cut, segments.probe)
    before = np.empty(len(edge))
    before[segments.next_segment] = edge[:, 1]
    jump, squares = (before - edge[:, 0]) / shaft.period, (before**2 - edge[:, 0] ** 2) / shaft.period
    time = _time_weight(shaft, segments.low)
    for index, weights in enumerate([jump, squares] if time is None else [jump, squares, squares * time]):
        np.add.at(slopes[index], segments.row, weights[:, None] * rate)
