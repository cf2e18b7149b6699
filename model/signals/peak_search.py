"""Peaks of a curve over the cycle for many designs, to machine precision, with exact derivatives.

The cycle is cut into segments on which the curve is smooth. Value and slope are sampled on panels in these segments,
halved until they resolve the curve. Between two samples where the curve first rises and then falls there is a local
maximum, found as the root of the slope. A breakpoint between segments is also a maximum if the curve peaks there in a
kink or a jump. The derivative of a maximum with respect to the design is the partial derivative at its place (envelope
theorem); a maximum at a breakpoint moves with it. Only the choice between two maxima within one spacing is not exact.

The motion defines the independent variable (place): the crank angle of a shaft, or the time of a swing.

Segments of many designs' cycles, and their panels, are flat lists.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..arrays import Array, IntArray, Mask
from ..dynamics.segments import angle_identifying_segment
from ..quadrature import NODES, Samples, last_coefficients_magnitude, resolve_panels
from .roots import find_roots


@dataclass(frozen=True)
class Segments:
    """Cycles of n designs between breakpoints: s segments ordered by design and place, with smooth curves.

    row: design. low, high: places (crank angle or time) of the ends. cut: breakpoint at its start. next_segment:
    following segment, -1 if there is none. unit: unit of place for counting panels.
    """

    row: IntArray
    low: Array
    high: Array
    cut: IntArray
    next_segment: IntArray
    unit: float = 1.0

    @property
    def probe(self) -> Array:
        """A place in each segment that identifies its strokes and pieces."""
        low: Any = self.low
        high: Any = self.high
        return np.asarray(angle_identifying_segment(low, high))

    def split_into_panels(self, fineness: Array) -> tuple[IntArray, Array, Array, Array, IntArray]:
        """Return design, a place inside, start, width and segment of panels, at least `fineness` (n,) per unit."""
        width = self.high - self.low
        count = np.maximum(1, np.ceil(width / self.unit * fineness[self.row])).astype(np.int64)
        segment = np.repeat(np.arange(len(width)), count)
        place = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
        panel_width = (width / count)[segment]
        return self.row[segment], self.probe[segment], self.low[segment] + place * panel_width, panel_width, segment


_ROUGH = 1e-6  # maximum of the last coefficients on a resolved panel, as a fraction of the curve's maximum
_DEEPEST = 8  # maximum halvings of a panel
_CONTINUOUS = 1e-11  # relative difference below which the curve is continuous at a breakpoint
_SAME = 1e-7  # a flat top cannot be located more accurately
_ON_EDGE = 1e-13
_NODES = np.concatenate([[0.0], NODES, [1.0]])


class Curve(Protocol):
    """A curve for many designs, smooth on each segment of their cycles."""

    @property
    def numbers(self) -> int:
        """Number of design variables for derivatives, 0 if there are none."""
        ...

    def evaluate(
        self, row: IntArray, probe: Array, place: Array, *, rate: Array | None = None, gradients: bool = False
    ) -> tuple[Array, Array]:
        """Return the curve (p, k, 2 + v) and its magnitudes (p, k) at places (p, k) in segments.

        row: (p,), the designs. Value, slope and, with `gradients`, derivatives with respect to the numbers; NaN where
        there is no curve. probe: (p,), a place within each segment. rate: (p, v), derivatives of the places with
        respect to the numbers.
        """
        ...

    def breakpoint_gradients(self, cuts: IntArray, probe: Array) -> Array:
        """Return the derivatives (c, v) of breakpoint places; probe: places in the segments that begin there."""
        ...


@dataclass(frozen=True)
class Maxima:
    """Local maxima for n designs, highest first: values (n, k), -inf beyond the last, and places (n, k), NaN there.

    slopes: (n, k, v), by the design's numbers. size: (n,), maximum magnitude of the sampled curve.
    """

    values: Array
    places: Array
    slopes: Array
    size: Array


@dataclass(frozen=True)
class _Tops:
    """Local maxima: design, value, place, segment.

    End: -1 or 1 if it is the breakpoint at the segment's start or end.
    """

    row: IntArray
    value: Array
    place: Array
    segment: IntArray
    end: IntArray

    def select(self, chosen: IntArray | Mask) -> _Tops:
        return _Tops(self.row[chosen], self.value[chosen], self.place[chosen], self.segment[chosen], self.end[chosen])


def find_maxima(
    curve: Curve, segments: Segments, fineness: Array, *, limit: int, counted: Mask | None = None, signed: bool = False
) -> Maxima:
    """Return the highest local maxima of a curve's magnitude, or of its value if `signed`, for n designs.

    fineness: (n,), initial panels per unit of the place. limit: maxima per design; a single one is found faster.
    counted: (s,), segments that count.
    """
    search = _Search(curve, segments, np.ones(len(segments.row), bool) if counted is None else counted, signed)
    count = len(fineness)
    tops, best, size = search.inner_maxima(fineness, limit)
    tops = _join_maxima([tops, search.breakpoint_maxima()])
    tops = _rank_maxima(_join_maxima([tops, best.select(~np.isin(best.row, tops.row))]))
    rank = np.arange(len(tops.row)) - np.searchsorted(tops.row, tops.row, side="left")
    tops, rank = tops.select(rank < limit), rank[rank < limit]
    values, places = np.full((count, limit), -np.inf), np.full((count, limit), np.nan)
    slopes = np.zeros((count, limit, curve.numbers))
    values[tops.row, rank], places[tops.row, rank] = tops.value, tops.place
    if curve.numbers:
        slopes[tops.row, rank] = search.maxima_slopes(tops)
    return Maxima(values, places, slopes, size)


@dataclass(frozen=True)
class _Search:
    """A curve on segments; only live segments count. signed: whether its value counts instead of its magnitude."""

    curve: Curve
    segments: Segments
    counted: Mask
    signed: bool

    def negated_where_magnitude_counts(self, curve: Array) -> Array:
        """Return the curve (..., c) with derivatives, negated where its magnitude counts and its value is negative."""
        return curve if self.signed else np.asarray(np.where(curve[..., :1] < 0.0, -curve, curve))

    def inner_maxima(self, fineness: Array, limit: int) -> tuple[_Tops, _Tops, Array]:
        """Return the maxima between breakpoints, each design's highest sample, and the curve's maximum magnitude."""
        row, probe, low, width, segment = self.segments.split_into_panels(fineness)
        counts = self.counted[segment]
        row, probe, low, width, segment = row[counts], probe[counts], low[counts], width[counts], segment[counts]
        size = np.zeros(len(fineness))

        def sample(low: Array, width: Array, row: IntArray, probe: Array, segment: IntArray) -> Samples:
            place = low[:, None] + width[:, None] * _NODES
            curve, sizes = self.curve.evaluate(row, probe, place)
            np.maximum.at(size, row, sizes.max(axis=1, initial=0.0))
            rough: Mask = last_coefficients_magnitude(curve[:, 1:-1, 0]) > _ROUGH * size[row]
            return rough, [place, self.negated_where_magnitude_counts(curve)]

        panels = resolve_panels(sample, low, width, row, probe, segment, deepest=_DEEPEST)
        _, _, row, probe, segment, place, curve = panels
        value, slope = np.where(np.isnan(curve[..., 0]), -np.inf, curve[..., 0]), curve[..., 1]
        greatest, rows = value.argmax(axis=1), np.arange(len(row))
        zeros = np.zeros(len(row), dtype=np.int64)
        samples = _rank_maxima(_Tops(row, value[rows, greatest], place[rows, greatest], segment, zeros))
        best = samples.select(np.unique(samples.row, return_index=True)[1])
        highest = np.full(len(fineness), -np.inf)
        highest[best.row] = best.value
        panel, at = np.nonzero((slope[:, :-1] > 0.0) & (slope[:, 1:] <= 0.0))
        step = place[panel, at + 1] - place[panel, at]
        bound = np.minimum(
            value[panel, at] + step * slope[panel, at], value[panel, at + 1] - step * slope[panel, at + 1]
        )
        if (
            limit == 1
        ):  # a curve that rises and falls only once lies below both tangents; the margin is for other curves
            bound_with_margin = bound + 0.5 * (bound - np.maximum(value[panel, at], value[panel, at + 1]))
            near = bound_with_margin >= highest[row[panel]]
            panel, at = panel[near], at[near]
        begin = place[panel, at], slope[panel, at], value[panel, at]
        end = place[panel, at + 1], slope[panel, at + 1]
        top, top_places = self.maxima_in_brackets(row[panel], probe[panel], begin, end)
        # At a kink, rounding may give the slope from the other side: a root that close to a breakpoint moves with it.
        panel_segment = segment[panel]
        from_low, from_high = (
            top_places - self.segments.low[panel_segment],
            self.segments.high[panel_segment] - top_places,
        )
        edge = np.where(from_low < _ON_EDGE, -1, np.where(from_high < _ON_EDGE, 1, 0))
        return _Tops(row[panel], top, top_places, panel_segment, edge), best, size

    def maxima_in_brackets(
        self, row: IntArray, probe: Array, begin: tuple[Array, Array, Array], end: tuple[Array, Array]
    ) -> tuple[Array, Array]:
        """Return value and place of the maxima in brackets: roots of the slope.

        begin, end: place and slope at both ends of the brackets; at the beginning, the value as well.
        """
        place, rise, value = begin[0], begin[1], begin[2].copy()

        def slope(brackets: IntArray, trial: Array) -> Array:
            evaluated = self.curve.evaluate(row[brackets], probe[brackets], trial[:, None])[0][:, 0, :2]
            curve = self.negated_where_magnitude_counts(evaluated)
            value[brackets] = curve[:, 0]
            return np.asarray(curve[:, 1])

        return value, find_roots(slope, (place, rise), end)

    def breakpoint_maxima(self) -> _Tops:
        """Return the breakpoints that are maxima: kinks, jumps, and ends at which the curve stops."""
        segments, live = self.segments, self.counted
        n = len(live)
        edge = np.full((n + 1, 2, 2), -np.inf)  # the last one belongs to no segment
        ends = np.stack([segments.low[live], segments.high[live]], axis=1)
        edge[:-1][live] = self.negated_where_magnitude_counts(
            self.curve.evaluate(segments.row[live], segments.probe[live], ends)[0][..., :2]
        )
        first = np.setdiff1d(np.arange(n), segments.next_segment)
        before, following = np.append(np.arange(n), np.full(len(first), -1)), np.append(segments.next_segment, first)
        left, falls_not = edge[before, 1, 0], edge[before, 1, 1] >= 0.0
        right, rises_not = edge[following, 0, 0], edge[following, 0, 1] <= 0.0
        tolerance = _CONTINUOUS * np.fmax(*(np.abs(np.where(np.isfinite(side), side, 0.0)) for side in (left, right)))
        from_left = np.isfinite(left) & ~(left < right - tolerance) & falls_not
        of_left = from_left & (~(left <= right + tolerance) | rises_not)
        of_right = ~from_left & np.isfinite(right) & ~(right <= left + tolerance) & rises_not
        before, following = before[of_left], following[of_right]
        return _join_maxima(
            [
                _Tops(
                    segments.row[before], left[of_left], segments.high[before], before, np.ones(len(before), np.int64)
                ),
                _Tops(
                    segments.row[following],
                    right[of_right],
                    segments.low[following],
                    following,
                    -np.ones(len(following), np.int64),
                ),
            ]
        )

    def maxima_slopes(self, tops: _Tops) -> Array:
        """Return the derivatives (t, v) of maxima by the design: at their places, and as breakpoints move."""
        segments, rate = self.segments, np.zeros((len(tops.row), self.curve.numbers))
        begins = np.where(tops.end > 0, segments.next_segment[tops.segment], tops.segment)
        moves = np.flatnonzero((tops.end != 0) & (begins >= 0))
        at = begins[moves]
        rate[moves] = self.curve.breakpoint_gradients(segments.cut[at], segments.probe[at])
        probe, place = segments.probe[tops.segment], tops.place[:, None]
        curve = self.negated_where_magnitude_counts(
            self.curve.evaluate(tops.row, probe, place, rate=rate, gradients=True)[0][:, 0]
        )
        return np.asarray(curve[:, 2:])


def _rank_maxima(tops: _Tops) -> _Tops:
    """Return maxima by design, highest first; only the first of several at one place."""
    tops = tops.select(np.lexsort((-tops.value, tops.place, tops.row)))
    again = (tops.row[1:] == tops.row[:-1]) & (np.abs(np.diff(tops.place)) < _SAME) & (np.diff(tops.segment) == 0)
    tops = tops.select(np.concatenate([[True], ~again]) if len(tops.row) else np.zeros(0, dtype=bool))
    return tops.select(np.lexsort((tops.place, -tops.value, tops.row)))


def _join_maxima(parts: list[_Tops]) -> _Tops:
    columns = zip(*((p.row, p.value, p.place, p.segment, p.end) for p in parts), strict=True)
    return _Tops(*(np.concatenate(column) for column in columns))
