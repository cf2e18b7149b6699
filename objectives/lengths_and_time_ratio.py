"""Proportions: stroke, rod to offset, rod to crank, footprint, time ratio; and the envelope of the moving links.

The envelope is the length and height of the space that crank and rod sweep, widths included.

A link is a bar with semicircular ends about its pin centres; without a section, it is its centre line. Crank pivot and
crank pin stay within r of the pivot; the slider pin moves along its line between the dead centres. A bar reaches
farthest at one of its ends. With the half widths h_c and h_r, their maximum h, and the outer dead centre x_out:

    length = (r + h) + max(x_out + h_r, r + h_c)        height = (r + h) + max(r + h, |e| + h_r)

since x_out > r, x_in > 0. Slider, guide, pins and counterweight are ignored here.

Time ratio and crank angle ratio are slower stroke to faster stroke, in time and in crank angle.
"""

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
from .machine_needs import ONE_TIMING
from .quantity import Array, Domain, Formula, Group, Pieces, Values
from .stroke_times import evaluate_stroke_times

_ABOVE_ONE = Domain(
    lower=1.0,
    idle=True,
    rule="the rod exceeds crank + |offset| for full rotation, so this must be above 1",
    remedy="raise it",
)


def _stroke_bounds(box: LengthRanges) -> tuple[float, float]:
    r = box.longest_rotating_crank
    greatest = (
        geometry.stroke(box.r1, box.l0, box.a1)
        if box.rotates_fully_throughout
        else 2.0 * math.sqrt(r * min(box.l1, r + box.a1))
    )
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


def time_ratio_of_excess_angle(excess: float) -> float:
    """Return the crank angle ratio for an excess angle, rad: at constant speed, the time ratio."""
    return (math.pi + excess) / (math.pi - excess)


def _time_ratio_bounds(box: LengthRanges) -> tuple[float, float]:
    if box.rotates_fully_throughout:
        greatest = geometry.time_ratio(box.r1, box.l0, box.a1)
    else:
        r = box.longest_rotating_crank
        a = max(box.a0, box.l0 - r)
        greatest = time_ratio_of_excess_angle(math.acos(a / (2.0 * r + a))) if box.a1 else 1.0
    return float(geometry.time_ratio(box.r0, box.l1, box.a0)), float(greatest)


@dataclass(frozen=True, kw_only=True)
class TimeRatio(ClosedFormQuantity):
    """Time ratio: a closed form at constant speed; with a profile, the maximum of both stroke time ratios."""

    def closed_form_holds(self, mechanism: Mechanism) -> bool:
        """Return whether the machine rotates at constant speed."""
        return mechanism.speed_profile is None

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.closed_form_holds(mechanism):
            return super().evaluate(mechanism, dimensions, gradients=gradients)
        ratio, slopes = evaluate_stroke_times(mechanism, dimensions, lambda of: of.outward_to_inward_ratio, gradients)
        if slopes is not None:
            slopes = np.where((ratio >= 1.0 / ratio)[:, None], slopes, _derivatives_of_inverse(ratio, slopes))
        return Values(np.maximum(ratio, 1.0 / ratio), slopes)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the maximum of its two ratios; see `Quantity`."""
        if self.closed_form_holds(mechanism):
            return super().pieces(mechanism, dimensions)
        ratio, slopes = evaluate_stroke_times(mechanism, dimensions, lambda of: of.outward_to_inward_ratio, True)
        assert slopes is not None
        values = np.stack([ratio, 1.0 / ratio], axis=1)
        labels = np.broadcast_to(np.arange(2.0), values.shape)
        return Pieces(values, np.stack([slopes, _derivatives_of_inverse(ratio, slopes)], axis=1), labels)


def _derivatives_of_inverse(ratio: Array, slopes: Array) -> Array:
    """Return the derivatives of the inverse of a ratio."""
    return -slopes / np.square(ratio)[:, None]


_TIME_RATIO_BOUNDS = QuantityBounds(
    compute=_time_ratio_bounds,
    to_raise="a longer crank or a larger |offset|",
    to_lower="a smaller |offset|",
)
TIME_RATIO = TimeRatio(
    name="time_ratio",
    kind=RATIO,
    forms=(ClosedForm.TIME_RATIO,),
    rises=(True, False, True),
    place=10,
    group=Group.MOTION,
    sentence=(
        "The time ratio says how many times longer the slower stroke takes than the faster one. At constant speed it "
        "is 1 without offset, and more for a quick return."
    ),
    advice=(
        "At constant speed the sign of the offset and the direction of rotation decide which stroke is slow; a speed "
        "profile can change that and the ratio."
    ),
    formula=(
        "Q = (180 deg + |b|) / (180 deg - |b|) with the excess angle b = arcsin(e/(l-r)) - arcsin(e/(l+r)); with a "
        "speed profile, stroke times in place of crank angles"
    ),
    picture="time ratio",
    example=1.2,
    better="high",
    domain=Domain(
        lower=1.0,
        open=False,
        rule="the time ratio, the slower stroke over the faster, must be 1 or more",
        remedy="give the inverse (constraints.slow_stroke says which stroke is the slow one)",
    ),
    # A drive's own speed varies by about one percent; without offset neither stroke is slow.
    floor=1.01,
    in_line=1.0,
    needs=(ONE_TIMING,),
    bounds=_TIME_RATIO_BOUNDS,
    offered=("motion", "objective"),
)
CRANK_ANGLE_RATIO = ClosedFormQuantity(
    name="crank_angle_ratio",
    kind=RATIO,
    forms=(ClosedForm.TIME_RATIO,),
    rises=(True, False, True),
    place=101,
    group=Group.MOTION,
    sentence="The crank angle of the longer stroke divided by that of the shorter one.",
    advice="At constant speed it equals the time ratio. It depends on the linkage alone, not on the speed.",
    formula="(180 deg + |b|) / (180 deg - |b|) with the excess angle b = arcsin(e/(l-r)) - arcsin(e/(l+r))",
    picture="time ratio",
    example=1.2,
    better="high",
    domain=Domain(
        lower=1.0,
        open=False,
        rule="the crank angle ratio, the longer stroke over the shorter, must be 1 or more",
        remedy="give the inverse",
    ),
    in_line=1.0,
    bounds=_TIME_RATIO_BOUNDS,
    plain=True,
)
