"""Segments of many designs' cycles as flat lists, and the panels of these segments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array, IntArray
from ..dynamics.segments import angle_identifying_segment


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
