"""Breakpoints of many crankshafts as flat lists, and the segments between them."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IntArray
from ..machine.cylinders_and_turns import TURN
from .peak_search import Segments

FIXED, CONTACT, GEAR, SUPPLY = -1, -2, -3, -4
"""Codes of a breakpoint that no design moves, and of breakpoints where a sign changes: that of a guide force, of the
torque through the gear, and of the supply power."""
_SHORTEST = 1e-13  # rad: breakpoints closer than this count as one


@dataclass(frozen=True)
class Breaks:
    """Breakpoints, c in total: design, angle, cylinder, half, and kind, as in `segments.Cuts`.

    code: also `FIXED`, `CONTACT`, `GEAR` or `SUPPLY`.
    """

    row: IntArray
    angle: Array
    member: IntArray
    half: IntArray
    code: IntArray
    number: Array
    load: IntArray


def join_breaks(parts: list[Breaks]) -> Breaks:
    """Return the breakpoints of several lists as one."""
    columns = zip(*((p.row, p.angle, p.member, p.half, p.code, p.number, p.load) for p in parts), strict=True)
    return Breaks(*(np.concatenate(column) for column in columns))


def segments_between_breakpoints(breaks: Breaks, period: float) -> Segments:
    """Return the segments between breakpoints, omitting thin ones."""
    order = np.lexsort((breaks.angle, breaks.row))
    row, low = breaks.row[order], breaks.angle[order]
    first = np.searchsorted(row, row, side="left")
    last = np.searchsorted(row, row, side="right") - 1
    place = np.arange(len(row))
    high = np.where(place == last, low[first] + period, low[np.minimum(place + 1, len(row) - 1)])
    has_length = high - low >= _SHORTEST
    merged_breaks, merged_row = order[~has_length], row[~has_length]
    next_break = np.searchsorted(np.flatnonzero(has_length), np.flatnonzero(~has_length))
    row, low, high, cut = row[has_length], low[has_length], high[has_length], order[has_length]
    place = np.arange(len(row))
    ends = np.searchsorted(row, row, side="right") - 1
    begins = np.searchsorted(row, row, side="left")
    after = np.where(place == ends, begins, place + 1)
    # The ends of a thin segment count as one breakpoint, also around the cycle: designs move it if they move either
    # end.
    next_break = np.where(
        next_break > np.searchsorted(row, merged_row, side="right") - 1, np.searchsorted(row, merged_row), next_break
    )
    moves = (breaks.code[cut[next_break]] == FIXED) & (breaks.code[merged_breaks] != FIXED)
    cut[next_break[moves]] = merged_breaks[moves]
    return Segments(row, low, high, cut, after, TURN)
