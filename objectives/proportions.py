"""Proportions of the linkage: stroke, rod to offset, rod to crank, footprint; and the envelope of the moving links.

The envelope is the length and height of the space that crank and rod sweep, widths included.

A link is a bar with semicircular ends about its pin centres; without a section, it is its centre line. Crank pivot and
crank pin stay within r of the pivot; the slider pin moves along its line between the dead centres. A bar reaches
farthest at one of its ends. With the half widths h_c and h_r, their maximum h, and the outer dead centre x_out:

    length = (r + h) + max(x_out + h_r, r + h_c)        height = (r + h) + max(r + h, |e| + h_r)

since x_out > r, x_in > 0. Slider, guide, pins and counterweight are ignored here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..model.kernel.arithmetic import magnitude
from ..model.kinematics import geometry
from ..model.kinematics.closed_forms import ClosedForm
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from .bounds_over_ranges import LengthRanges, QuantityBounds
from .closed_form import ClosedFormQuantity, GreatestOfFormulas
from .kinds import AREA, LENGTH, RATIO
from .quantity import Domain, Formula, Group

_ABOVE_ONE = Domain(
    lower=1.0,
    idle=True,
    rule="the rod exceeds crank + |offset| for full rotation, so this must be above 1",
    remedy="raise it",
)


def _stroke_bounds(box: LengthRanges) -> tuple[float, float]:
    r = box.crank
    greatest = geometry.stroke(box.r1, box.l0, box.a1) if box.turns else 2.0 * math.sqrt(r * min(box.l1, r + box.a1))
    return float(geometry.stroke(box.r0, box.l1, box.a0)), float(greatest)


STROKE = ClosedFormQuantity(
    name="stroke",
    kind=LENGTH,
    forms=(ClosedForm.STROKE,),
    rises=(True, False, True),
    place=100,
    group=Group.MOTION,
    sentence="The stroke is the distance between the slider's two dead centres.",
    advice="It equals twice the crank only without an offset.",
    formula="S = sqrt((l+r)^2 - e^2) - sqrt((l-r)^2 - e^2)",
    picture="stroke",
    better="",
    example="280 mm",
    bounds=QuantityBounds(
        compute=_stroke_bounds,
        to_raise="a longer crank or a larger |offset|",
        to_lower="a shorter crank (a stroke is never shorter than 2 crank)",
    ),
    offered=("motion",),
)
ROD_TO_OFFSET = ClosedFormQuantity(
    name="rod_to_offset",
    kind=RATIO,
    forms=(ClosedForm.ROD_TO_OFFSET,),
    rises=(True, True, False),
    place=110,
    group=Group.PROPORTIONS,
    sentence="The length of the rod divided by the size of the offset: a rule such as rod = 3.2 offset.",
    advice="A fixed value removes one free dimension; the search meets it exactly.",
    formula="l / |e|, infinite without offset",
    picture="offset",
    better="high",
    domain=_ABOVE_ONE,
    in_line=math.inf,
    bounds=QuantityBounds(
        compute=lambda box: (
            max(box.l0 / box.a1, 1.0) if box.a1 else math.inf,
            box.l1 / box.a0 if box.a0 else math.inf,
        ),
        to_raise="a longer rod or a smaller |offset|",
        to_lower="a shorter rod or a larger |offset|",
    ),
    offered=("proportions",),
    plain=True,
    turning=False,
)
ROD_TO_CRANK = ClosedFormQuantity(
    name="rod_to_crank",
    kind=RATIO,
    forms=(ClosedForm.ROD_TO_CRANK,),
    rises=(False, True, True),
    place=120,
    group=Group.PROPORTIONS,
    sentence="The length of the rod divided by that of the crank; the higher, the more evenly the slider moves.",
    formula="l / r",
    picture="rod",
    example=2.5,
    better="high",
    domain=_ABOVE_ONE,
    bounds=QuantityBounds(
        compute=lambda box: (max(box.l0 / box.r1, 1.0), box.l1 / box.r0),
        to_raise="a longer rod or a shorter crank",
        to_lower="a shorter rod or a longer crank",
    ),
    offered=("proportions",),
    plain=True,
    turning=False,
)
FOOTPRINT = ClosedFormQuantity(
    name="footprint",
    kind=AREA,
    forms=(ClosedForm.FOOTPRINT_OF_CRANK, ClosedForm.FOOTPRINT_OF_OFFSET),
    place=130,
    group=Group.PROPORTIONS,
    sentence="The footprint is the area of the rectangle that the pin centres need over a whole turn.",
    formula="(x_out + r) (r + max(r, |e|)) with x_out = sqrt((l+r)^2 - e^2)",
    picture="footprint",
    offered=("objective",),
)


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
