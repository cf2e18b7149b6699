"""Growth of the front during a search: a volume that cannot decrease."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array, sorted_unique
from ..front.dominance import nondominated
from ..front.hypervolume import hypervolume, ideal_and_range

_MOST = {1: 1, 2: 5000, 3: 5000, 4: 1000, 5: 600}
"""Designs whose volume is computed, by number of objectives: it takes 2 ms for these, and ten times as long for a few
more."""
_OF_MANY = 200  # the same for six objectives, which takes 0.02 s
_LEAST_SIDE = 0.1  # relative to the best value: minimum side of the box if the first front is nearly a point
_OF_TARGET = 0.01  # the same for a target, because designs that meet it differ by rounding


class FrontVolume:
    """Volume that the designs found so far dominate.

    It is measured from a fixed corner in boxes of fixed size, so it only grows as more designs are found. If there are
    very many designs, an evenly spread subset counts, a different one each time. No design is ever lost, so the
    greatest volume of any subset is still dominated.

    box: ideal and span (m,); the corner is 1.1 spans beyond the ideal. Without a box, that of the first designs counts,
    and the volume may exceed one box, because later designs may be better than their ideal. With a box, volume beyond
    its ideal does not count. targets: (m,), targets of the objectives, zero for none. front: (n, m), the subset counted
    last, objectives as minimised.
    """

    def __init__(
        self, targets: Array, *, box: tuple[Array, Array] | None = None, max_designs: int | None = None
    ) -> None:
        """Start without designs. max_designs: number of designs that count; by default, as many as are fast."""
        self.front: Array = np.zeros((0, len(targets)))
        self._targets = targets
        self._box = box
        self._within = box is not None
        self._most = max_designs or _MOST.get(len(targets), _OF_MANY)
        self._volume = 0.0

    def add(self, values: Array) -> float:
        """Add feasible designs, objectives (n, m), and return the volume that all designs dominate, in boxes."""
        values = np.concatenate([self.front, self._spread_sample(values[np.isfinite(values).all(axis=1)])])
        if not len(values):
            return 0.0
        values = values[nondominated(values)]
        if self._box is None:
            ideal, span = ideal_and_range(values)
            self._box = (
                ideal,
                np.maximum(span, np.maximum(_LEAST_SIDE * np.abs(ideal), _OF_TARGET * np.abs(self._targets))),
            )
        self.front = self._spread_sample(values)
        self._volume = max(self._volume, hypervolume(self.front, *self._box, clip_at_ideal=self._within))
        return self._volume

    def _spread_sample(self, values: Array) -> Array:
        return values[sorted_unique(np.linspace(0, len(values) - 1, self._most).astype(int))] if len(values) else values
