"""Growth of the front while a search goes on: a volume that cannot fall."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array, distinct
from ..front.dominance import nondominated
from ..front.hypervolume import hypervolume, scaling

_MOST = {1: 1, 2: 5000, 3: 5000, 4: 1000, 5: 600}
"""Designs of which the volume is told, by objectives: it takes 2 ms of these, and ten times as long of some more."""
_OF_MANY = 200  # the same of six objectives; it takes 0.02 s
_ROOM = 0.1  # of the best value: the least side of the box, where the first front is a point or nearly one
_OF_TARGET = 0.01  # the same of a target: designs that meet it differ by rounding


class Growth:
    """Volume that the designs found so far dominate.

    It is measured from a corner that stays where it is, in boxes of a size that stays as it is: what designs dominate
    there only grows as more are found. Of very many designs some tell, evenly spread, and other ones every time; none
    of them is lost again, so the most that any of these parts dominated is a volume that is dominated still.

    box: ideal and span (m,); the corner lies 1.1 spans beyond the ideal. Without one it is that of the first designs,
    and the volume may exceed one box, as later designs may be better than the ideal of those. With one, volume beyond
    its ideal does not count. targets: (m,), of the objectives, zero where there is none. front: (n, m), the designs
    that told last, objectives as minimised.
    """

    def __init__(
        self, targets: Array, *, box: tuple[Array, Array] | None = None, max_designs: int | None = None
    ) -> None:
        """Begin without designs. max_designs: how many tell; as many as take a moment if None."""
        self.front: Array = np.zeros((0, len(targets)))
        self._targets = targets
        self._box = box
        self._within = box is not None
        self._most = max_designs or _MOST.get(len(targets), _OF_MANY)
        self._volume = 0.0

    def add(self, values: Array) -> float:
        """Take in feasible designs, objectives (n, m), and return the volume that all together dominate, in boxes."""
        values = np.concatenate([self.front, self._thin_out(values[np.isfinite(values).all(axis=1)])])
        if not len(values):
            return 0.0
        values = values[nondominated(values)]
        if self._box is None:
            ideal, span = scaling(values)
            self._box = ideal, np.maximum(span, np.maximum(_ROOM * np.abs(ideal), _OF_TARGET * np.abs(self._targets)))
        self.front = self._thin_out(values)
        self._volume = max(self._volume, hypervolume(self.front, *self._box, clip_at_ideal=self._within))
        return self._volume

    def _thin_out(self, values: Array) -> Array:
        return values[distinct(np.linspace(0, len(values) - 1, self._most).astype(int))] if len(values) else values
