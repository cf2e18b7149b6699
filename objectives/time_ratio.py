"""Time ratio: how much longer the slower stroke takes than the faster one, at constant crank speed."""

from __future__ import annotations

import math

from ..model.kinematics import geometry
from ..model.kinematics.closed_forms import ClosedForm
from .closed_form import ClosedFormQuantity
from .kinds import RATIO
from .quantity import Domain, Group
from .reach import Ranges, Reach


def ratio_of(excess: float) -> float:
    """Return the time ratio of an excess angle, rad."""
    return (math.pi + excess) / (math.pi - excess)


def _within(box: Ranges) -> tuple[float, float]:
    if box.turns:
        greatest = geometry.time_ratio(box.r1, box.l0, box.a1)
    else:
        r = box.crank
        a = max(box.a0, box.l0 - r)
        greatest = ratio_of(math.acos(a / (2.0 * r + a))) if box.a1 else 1.0
    return float(geometry.time_ratio(box.r0, box.l1, box.a0)), float(greatest)


TIME_RATIO = ClosedFormQuantity(
    name="time_ratio",
    kind=RATIO,
    forms=(ClosedForm.TIME_RATIO,),
    rises=(True, False, True),
    place=10,
    group=Group.MOTION,
    sentence=(
        "The time ratio says how many times longer the slower stroke takes than the faster one while the crank "
        "turns steadily: 1 without offset, more for a quick return."
    ),
    advice="Which stroke is the slow one follows from the sign of the offset and from the direction of rotation.",
    formula="Q = (180 deg + |b|) / (180 deg - |b|) with the excess angle b = arcsin(e/(l-r)) - arcsin(e/(l+r))",
    picture="time ratio",
    example=1.2,
    better="high",
    domain=Domain(
        lower=1.0,
        open=False,
        rule="the time ratio is the slower stroke over the faster, so 1 or more",
        remedy="give the inverse (constraints.slow_stroke says which stroke is the slow one)",
    ),
    # A drive's speed varies by about one percent itself, and without offset neither stroke is slow.
    floor=1.01,
    in_line=1.0,
    reach=Reach(
        bounds=_within,
        more="raise the upper end of crank or of offset",
        less="lower the lower end of offset",
    ),
    offered=("motion", "objective"),
)
