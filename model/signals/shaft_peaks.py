"""Peaks of a crankshaft's curve over its cycle, with exact derivatives; see `peak_search`."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from .peak_search import find_maxima
from .shaft import Shaft
from .shaft_segments import segments_of

NOTHING = 1e-12
"""If the total is below this fraction of the cylinders' individual magnitudes, it counts as zero: they cancel up to
rounding."""


def shaft_peaks(shaft: Shaft, *, limit: int, stroke: bool | None = None) -> tuple[Array, Array, Array]:
    """Return values, crank angles (n, kept) and derivatives for the highest local maxima of the curve's magnitude.

    stroke: whether only the outward stroke, or only the inward stroke, counts; None for both. The value is infinite
    where friction locks the design.
    """
    segments = segments_of(shaft.breaks, shaft.period)
    live = None if stroke is None else shaft.moves_outward(segments) == stroke
    maxima = find_maxima(shaft, segments, shaft.panels_per_turn, limit=limit, counted=live)
    nothing = np.isfinite(maxima.values) & (maxima.values <= NOTHING * maxima.size[:, None])
    values = np.where(nothing, 0.0, maxima.values)
    values[~shaft.unlocked_designs, 0] = np.inf
    return values, np.mod(maxima.places, shaft.period), np.where(nothing[:, :, None], 0.0, maxima.slopes)
