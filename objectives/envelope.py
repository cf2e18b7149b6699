"""Envelope of the moving links: length and height of the space that crank and rod sweep, widths included.

A link is a bar with semicircular ends about its pin centres; without a section, it is its centre line. Crank pivot and
crank pin stay within r of the pivot; the slider pin moves along its line between the dead centres. A bar reaches
farthest at one of its ends. With the half widths h_c and h_r, their maximum h, and the outer dead centre x_out:

    length = (r + h) + max(x_out + h_r, r + h_c)        height = (r + h) + max(r + h, |e| + h_r)

since x_out > r, x_in > 0. Slider, guide, pins and counterweight are ignored here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..model.kernel.arithmetic import magnitude
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from .greatest_of_formulas import GreatestOfFormulas
from .kinds import LENGTH
from .proportions import FOOTPRINT
from .quantity import Formula, Group

Extent = Callable[[Any, Any, Any, Any, Any], Any]
"""A smooth extent, m, as a function of crank, rod, |offset|, and half the widths of both links."""


@dataclass(frozen=True, kw_only=True)
class Envelope(GreatestOfFormulas):
    """Maximum of several extents."""

    extents: Sequence[Extent]

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return the extents; see `Quantity`."""
        return [partial(_extent_of_machine, extent) for extent in self.extents]


def _extent_of_machine(extent: Extent, number: Callable[[int], Any]) -> Any:
    halves = 0.5 * number(Raw.CRANK_WIDTH), 0.5 * number(Raw.ROD_WIDTH)
    return extent(number(Raw.CRANK), number(Raw.ROD), magnitude(number(Raw.OFFSET)), *halves)


def _outer_dead_centre(r: Any, l: Any, e: Any) -> Any:
    return np.sqrt((l + r + e) * (l + r - e))


_envelope = partial(
    Envelope,
    kind=LENGTH,
    group=Group.PROPORTIONS,
    section="2. Closed forms",
    picture=FOOTPRINT.picture,
    advice="The footprint covers only the pin centres; without sections, this quantity does the same.",
)
ENVELOPE_LENGTH = _envelope(
    name="envelope_length",
    place=132,
    sentence="Length along the slider line of the space that crank and rod sweep over a turn, including their widths.",
    formula="(r + h) + max(x_out + h_r, r + h_c): half widths h_c and h_r, the greater one h",
    example="400 mm",
    extents=(
        lambda r, l, e, c, d: (r + d) + (_outer_dead_centre(r, l, e) + d),
        lambda r, l, e, c, d: (r + c) + (_outer_dead_centre(r, l, e) + d),
        lambda r, l, e, c, d: 2.0 * (r + c),
    ),
)
ENVELOPE_HEIGHT = _envelope(
    name="envelope_height",
    place=134,
    sentence="Height across the slider line of the space that crank and rod sweep over a turn, including their widths.",
    formula="(r + h) + max(r + h, |e| + h_r): half widths h_c and h_r, the greater one h",
    example="200 mm",
    extents=(
        lambda r, l, e, c, d: 2.0 * (r + d),
        lambda r, l, e, c, d: 2.0 * (r + c),
        lambda r, l, e, c, d: (r + d) + (e + d),
        lambda r, l, e, c, d: (r + c) + (e + d),
    ),
)
