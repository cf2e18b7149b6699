"""Means and mean squares of a crankshaft's curve over its cycle, with exact derivatives: Gauss on resolved panels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask
from .panels import resolved_tail
from .shaft import Shaft
from .shaft_peaks import NOTHING
from .shaft_segments import Segments, panels, segments_of

_RESOLVED = 1e-12  # what may be left of the last coefficients on a panel, of the curve's greatest size
_DEEPEST = 24
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_NODES, _WEIGHTS = 0.5 * (1.0 + _NODES), 0.5 * _WEIGHTS


@dataclass(frozen=True)
class Means:
    """Mean and mean square (n,) over the crank angle, and their derivatives (n, v) or None.

    NaN where friction locks a design. nothing: (n,), whether cylinders cancel but for rounding.
    """

    mean: Array
    square: Array
    mean_gradients: Array | None
    square_gradients: Array | None
    nothing: Mask


def shaft_means(shaft: Shaft, count: int) -> Means:
    """Return the means of n designs."""
    segments = segments_of(shaft.breaks, shaft.period)
    row, inside, low, width, _ = panels(segments, shaft.fineness)
    mean, square, size = np.zeros(count), np.zeros(count), np.zeros(count)
    by_mean, by_square = (np.zeros((count, shaft.numbers)) for _ in range(2))
    for depth in range(_DEEPEST + 1):
        angle = low[:, None] + width[:, None] * _NODES
        found, sizes = shaft.at(row, inside, angle)
        np.maximum.at(size, row, sizes.max(axis=1, initial=0.0))
        left = resolved_tail(found[:, :, 0])
        rough = (left * np.minimum(1.0, width) > _RESOLVED * size[row]) & (depth < _DEEPEST)
        ready = ~rough
        value, weight = found[ready, :, 0], width[ready, None] * _WEIGHTS / shaft.period
        np.add.at(mean, row[ready], (weight * value).sum(axis=1))
        np.add.at(square, row[ready], (weight * value**2).sum(axis=1))
        if shaft.gradients:
            slope = shaft.at(row[ready], inside[ready], angle[ready], wanted=True)[0][:, :, 2:]
            np.add.at(by_mean, row[ready], np.einsum("pk,pkv->pv", weight, slope))
            np.add.at(by_square, row[ready], np.einsum("pk,pkv->pv", 2.0 * weight * value, slope))
        if not rough.any():
            break
        half = 0.5 * width[rough]
        row, inside = (np.concatenate([part[rough]] * 2) for part in (row, inside))
        low, width = np.concatenate([low[rough], low[rough] + half]), np.concatenate([half, half])
    if shaft.gradients:
        _add_jumps(shaft, segments, by_mean, by_square)
    mean[~shaft.drives] = square[~shaft.drives] = np.nan
    nothing = np.sqrt(square) <= NOTHING * size
    return Means(mean, square, by_mean if shaft.gradients else None, by_square if shaft.gradients else None, nothing)


def _add_jumps(shaft: Shaft, segments: Segments, by_mean: Array, by_square: Array) -> None:
    """Add what breakpoints that move give where the curve jumps there."""
    ends = np.stack([segments.low, segments.high], axis=1)
    edge = shaft.at(segments.row, segments.inside, ends)[0][:, :, 0]
    rate = shaft.rates(segments.cut, segments.inside)
    before = np.empty(len(edge))
    before[segments.after] = edge[:, 1]
    jump, squares = (before - edge[:, 0]) / shaft.period, (before**2 - edge[:, 0] ** 2) / shaft.period
    np.add.at(by_mean, segments.row, jump[:, None] * rate)
    np.add.at(by_square, segments.row, squares[:, None] * rate)
