"""Time ratio and crank angle ratio: slower stroke to faster stroke, in time and in crank angle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..model.kinematics import geometry
from ..model.kinematics.closed_forms import ClosedForm
from ..model.machine.mechanism import Mechanism
from .bounds_over_ranges import LengthRanges, QuantityBounds
from .closed_form import ClosedFormQuantity
from .kinds import RATIO
from .machine_needs import ONE_TIMING
from .quantity import Array, Domain, Group, Pieces, Values
from .stroke_times import evaluate_stroke_times


def time_ratio_of_excess_angle(excess: float) -> float:
    """Return the crank angle ratio for an excess angle, rad: at constant speed, the time ratio."""
    return (math.pi + excess) / (math.pi - excess)


def _time_ratio_bounds(box: LengthRanges) -> tuple[float, float]:
    if box.turns:
        greatest = geometry.time_ratio(box.r1, box.l0, box.a1)
    else:
        r = box.crank
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
