"""Envelope of the moving links: length and height of the room that crank and rod sweep, their widths included.

A link is a bar with half-discs about its pin centres; one that is not given by its section is its centre line. Crank
pivot and crank pin stay within r of the pivot, the slider pin on its line between the dead centres, and a bar reaches
farthest at one of its ends. With h_c, h_r half the widths, h the greater of both, and x_out the outer dead centre:

    length = (r + h) + max(x_out + h_r, r + h_c)        height = (r + h) + max(r + h, |e| + h_r)

since x_out > r, x_in > 0. Slider, guide, pins and counterweight have no size here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..model.kernel.arithmetic import magnitude
from ..model.machine.mechanism import Mechanism
from ..model.machine.numbers import of_numbers
from ..model.machine.raw import Raw
from .kinds import LENGTH
from .proportions import FOOTPRINT
from .quantity import Array, Group, Pieces, Quantity, Values

Extent = Callable[[Any, Any, Any, Any, Any], Any]
"""A smooth extent, m, of crank, rod and size of the offset, and half the widths of crank and rod."""


@dataclass(frozen=True, kw_only=True)
class Envelope(Quantity):
    """The greatest of several extents."""

    extents: Sequence[Extent]

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values, slopes = self._all(mechanism, dimensions, gradients)
        first, rows = np.argmax(values, axis=1), np.arange(len(values))
        return Values(values[rows, first], None if slopes is None else slopes[rows, first])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return all extents; see `Quantity`."""
        values, slopes = self._all(mechanism, dimensions, True)
        assert slopes is not None
        return Pieces(values, slopes, np.tile(np.arange(values.shape[1], dtype=float), (len(values), 1)))

    def _all(self, mechanism: Mechanism, designs: Array, gradients: bool) -> tuple[Array, Array | None]:
        found = [
            of_numbers(mechanism, designs, partial(_of_machine, extent), gradients=gradients) for extent in self.extents
        ]
        slopes = [by for _, by in found if by is not None]
        return np.stack([value for value, _ in found], axis=1), np.stack(slopes, axis=1) if gradients else None


def _of_machine(extent: Extent, number: Callable[[int], Any]) -> Any:
    halves = 0.5 * number(Raw.CRANK_WIDTH), 0.5 * number(Raw.ROD_WIDTH)
    return extent(number(Raw.CRANK), number(Raw.ROD), magnitude(number(Raw.OFFSET)), *halves)


def _outer(r: Any, l: Any, e: Any) -> Any:
    return np.sqrt((l + r + e) * (l + r - e))


_envelope = partial(
    Envelope,
    kind=LENGTH,
    group=Group.PROPORTIONS,
    section="2. Closed forms",
    picture=FOOTPRINT.picture,
    advice="The footprint is of pin centres alone; without sections so is this.",
)
ENVELOPE_LENGTH = _envelope(
    name="envelope_length",
    place=132,
    sentence="How long the room is, along the slider line, that crank and rod sweep over a turn with their widths.",
    formula="(r + h) + max(x_out + h_r, r + h_c): half widths h_c and h_r, the greater one h",
    example="400 mm",
    extents=(
        lambda r, l, e, c, d: (r + d) + (_outer(r, l, e) + d),
        lambda r, l, e, c, d: (r + c) + (_outer(r, l, e) + d),
        lambda r, l, e, c, d: 2.0 * (r + c),
    ),
)
ENVELOPE_HEIGHT = _envelope(
    name="envelope_height",
    place=134,
    sentence="How high the room is, across the slider line, that crank and rod sweep over a turn with their widths.",
    formula="(r + h) + max(r + h, |e| + h_r): half widths h_c and h_r, the greater one h",
    example="200 mm",
    extents=(
        lambda r, l, e, c, d: 2.0 * (r + d),
        lambda r, l, e, c, d: 2.0 * (r + c),
        lambda r, l, e, c, d: (r + d) + (e + d),
        lambda r, l, e, c, d: (r + c) + (e + d),
    ),
)
