"""Peaks of a crankshaft's curve over its cycle, to machine precision, with exact derivatives.

Value and slope are sampled on panels between breakpoints, halved until they are followed. Between two samples where the
curve rises and falls again lies a local maximum, found as the root of the slope. A breakpoint is one too where the
curve has a kink or a jump. What is not exact is which of two maxima within one spacing is the higher.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask, Whole
from .panels import resolved_tail
from .shaft import Shaft
from .shaft_segments import Segments, panels, segments_of

NOTHING = 1e-12
"""Share of what cylinders do one by one below which the whole does nothing: they cancel but for rounding."""
_ROUGH = 1e-6  # what may be left of the last coefficients on a panel, of the curve's greatest size
_DEEPEST = 8  # halvings of a panel
_ITERATIONS = 80
_SETTLED = 1e-15
_STRAY = 1e-11  # relative difference below which the two sides of a breakpoint count as continuous
_SAME = 1e-7  # rad: a flat top is not located better
_NODES = np.concatenate([[0.0], 0.5 * (1.0 + np.polynomial.legendre.leggauss(16)[0]), [1.0]])


@dataclass(frozen=True)
class _Tops:
    """Local maxima: design, value, crank angle, segment; end: -1 or 1 on the breakpoint at its start or end."""

    row: Whole
    value: Array
    angle: Array
    segment: Whole
    end: Whole

    def at(self, places: Whole | Mask) -> _Tops:
        return _Tops(self.row[places], self.value[places], self.angle[places], self.segment[places], self.end[places])


def shaft_peaks(
    shaft: Shaft, count: int, *, kept: int, stroke: bool | None = None
) -> tuple[Array, Array, Array | None]:
    """Return values, crank angles (count, kept) and derivatives of the highest local maxima of the curve's size.

    stroke: whether the outward one alone counts, or the inward one; None for both. Where friction locks a design the
    value is infinite.
    """
    values, angles = np.full((count, kept), -np.inf), np.full((count, kept), np.nan)
    slopes = np.zeros((count, kept, shaft.numbers)) if shaft.gradients else None
    values[~shaft.drives, 0] = np.inf
    segments = segments_of(shaft.breaks, shaft.period)
    live = np.ones(len(segments.row), dtype=bool) if stroke is None else shaft.outward(segments) == stroke
    tops, best, size = _within(shaft, segments, live, count, kept)
    tops = _joined([tops, _at_breaks(shaft, segments, live)])
    tops = _ranked(_joined([tops, best.at(~np.isin(best.row, tops.row))]))
    first = np.searchsorted(tops.row, tops.row, side="left")
    rank = np.arange(len(tops.row)) - first
    tops, rank = tops.at(rank < kept), rank[rank < kept]
    values[tops.row, rank] = tops.value
    angles[tops.row, rank] = np.mod(tops.angle, shaft.period)
    nothing = values <= NOTHING * size[:, None]
    nothing &= np.isfinite(values)
    values[nothing] = 0.0
    if slopes is not None:
        slopes[tops.row, rank] = _slopes(shaft, segments, tops)
        slopes[nothing] = 0.0
    return values, angles, slopes


def sized(curve: Array) -> Array:
    """Return value and slope (..., 2) of the curve's size."""
    return np.asarray(np.where(curve[..., :1] < 0.0, -curve[..., :2], curve[..., :2]))


def _within(shaft: Shaft, segments: Segments, live: Mask, count: int, kept: int) -> tuple[_Tops, _Tops, Array]:
    """Return the maxima between breakpoints, the highest sample of each design, and the greatest size of the curve."""
    row, inside, low, width, segment = panels(segments, shaft.fineness)
    counts = live[segment]
    row, inside, low, width, segment = row[counts], inside[counts], low[counts], width[counts], segment[counts]
    size = np.zeros(count)
    done: list[tuple[Whole, Array, Array, Array, Whole]] = []
    for depth in range(_DEEPEST + 1):
        angle = low[:, None] + width[:, None] * _NODES
        found, sizes = shaft.at(row, inside, angle)
        np.maximum.at(size, row, sizes.max(axis=1, initial=0.0))
        left = resolved_tail(found[:, 1:-1, 0])
        rough = (left > _ROUGH * size[row]) & (depth < _DEEPEST)
        done.append((row[~rough], inside[~rough], angle[~rough], sized(found)[~rough], segment[~rough]))
        if not rough.any():
            break
        half = 0.5 * width[rough]
        row, inside, segment = (np.concatenate([part[rough]] * 2) for part in (row, inside, segment))
        low, width = np.concatenate([low[rough], low[rough] + half]), np.concatenate([half, half])
    row, inside, angle, found, segment = (np.concatenate(part) for part in zip(*done, strict=True))
    value, slope = found[..., 0], found[..., 1]
    place = value.argmax(axis=1)
    each = np.arange(len(row))
    none = np.zeros(len(row), dtype=np.int64)
    samples = _ranked(_Tops(row, value[each, place], angle[each, place], segment, none))
    best = samples.at(np.unique(samples.row, return_index=True)[1])
    highest = np.full(count, -np.inf)
    highest[best.row] = best.value
    panel, at = np.nonzero((slope[:, :-1] > 0.0) & (slope[:, 1:] <= 0.0))
    step = angle[panel, at + 1] - angle[panel, at]
    bound = np.minimum(value[panel, at] + step * slope[panel, at], value[panel, at + 1] - step * slope[panel, at + 1])
    if kept == 1:  # a curve that rises and falls again once lies below both tangents; some room for one that does not
        room = bound + 0.5 * (bound - np.maximum(value[panel, at], value[panel, at + 1]))
        near = room >= highest[row[panel]]
        panel, at = panel[near], at[near]
    a, b = angle[panel, at], angle[panel, at + 1]
    top, where = _refined(
        shaft, row[panel], inside[panel], a, b, slope[panel, at], slope[panel, at + 1], value[panel, at]
    )
    return _Tops(row[panel], top, where, segment[panel], none[panel]), best, size


def _refined(
    shaft: Shaft, row: Whole, inside: Array, a: Array, b: Array, rise: Array, fall: Array, value: Array
) -> tuple[Array, Array]:
    """Return value and angle of the maxima in brackets: roots of the slope by secants of Illinois."""
    a, b, rise, fall = (part.copy() for part in (a, b, rise, fall))
    value, at = value.copy(), a.copy()
    active, side = np.arange(len(row)), np.zeros(len(row), dtype=np.int64)
    for _ in range(_ITERATIONS):
        if not len(active):
            break
        i = active
        trial = a[i] + (b[i] - a[i]) * (rise[i] / (rise[i] - fall[i]))
        middle = 0.5 * (a[i] + b[i])
        trial = np.where((trial > a[i]) & (trial < b[i]), trial, middle)
        found = sized(shaft.at(row[i], inside[i], trial[:, None])[0][:, 0])
        moved = np.abs(trial - at[i])
        value[i], at[i], slope = found[:, 0], trial, found[:, 1]
        up = slope > 0.0
        fall[i] = np.where(up & (side[i] == 1), 0.5 * fall[i], fall[i])
        rise[i] = np.where(~up & (side[i] == -1), 0.5 * rise[i], rise[i])
        a[i], rise[i] = np.where(up, trial, a[i]), np.where(up, slope, rise[i])
        b[i], fall[i] = np.where(up, b[i], trial), np.where(up, fall[i], slope)
        side[i] = np.where(up, 1, -1)
        still = (slope != 0.0) & (moved > _SETTLED) & (b[i] - a[i] > 2.0 * _SETTLED)
        active = i[still]
    return value, at


def _at_breaks(shaft: Shaft, segments: Segments, live: Mask) -> _Tops:
    """Return the breakpoints that are maxima: kinks and jumps."""
    ends = np.stack([segments.low, segments.high], axis=1)
    edge = np.full((len(ends), 2, 2), -1.0)
    edge[live] = sized(shaft.at(segments.row[live], segments.inside[live], ends[live])[0])
    after = segments.after
    left, falls_not = np.where(live, edge[:, 1, 0], -1.0), edge[:, 1, 1] >= 0.0
    right, rises_not = np.where(live[after], edge[after, 0, 0], -1.0), edge[after, 0, 1] <= 0.0
    stray = _STRAY * np.maximum(left, right)
    from_left = live & (left >= right - stray) & falls_not
    of_left = from_left & ((left > right + stray) | rises_not)
    of_right = ~from_left & live[after] & (right > left + stray) & rises_not
    before, behind = np.flatnonzero(of_left), after[of_right]
    return _joined(
        [
            _Tops(segments.row[before], left[before], segments.high[before], before, np.ones(len(before), np.int64)),
            _Tops(segments.row[behind], right[of_right], segments.low[behind], behind, -np.ones(len(behind), np.int64)),
        ]
    )


def _ranked(tops: _Tops) -> _Tops:
    """Return maxima by design, highest first; of those at one angle the first."""
    tops = tops.at(np.lexsort((-tops.value, tops.angle, tops.row)))
    again = (tops.row[1:] == tops.row[:-1]) & (np.abs(np.diff(tops.angle)) < _SAME) & (np.diff(tops.segment) == 0)
    tops = tops.at(np.concatenate([[True], ~again]) if len(tops.row) else np.zeros(0, dtype=bool))
    return tops.at(np.lexsort((tops.angle, -tops.value, tops.row)))


def _slopes(shaft: Shaft, segments: Segments, tops: _Tops) -> Array:
    """Return the derivatives (t, v) of maxima by the design: at their angles, and as breakpoints move."""
    inside, rate = segments.inside[tops.segment], np.zeros((len(tops.row), shaft.numbers))
    kinks = np.flatnonzero(tops.end)
    at = np.where(tops.end[kinks] > 0, segments.after[tops.segment[kinks]], tops.segment[kinks])
    rate[kinks] = shaft.rates(segments.cut[at], segments.inside[at])
    found = shaft.at(tops.row, inside, tops.angle[:, None], rate=rate, wanted=True)[0][:, 0]
    return np.asarray(np.where(found[:, :1] < 0.0, -found[:, 2:], found[:, 2:]))


def _joined(parts: list[_Tops]) -> _Tops:
    columns = zip(*((p.row, p.value, p.angle, p.segment, p.end) for p in parts), strict=True)
    return _Tops(*(np.concatenate(column) for column in columns))
