"""Transmission angle: minimum angle between the rod and the normal of the slider line over the cycle."""

from __future__ import annotations

import numpy as np

from ..model.kinematics import geometry
from ..model.kinematics.closed_forms import ClosedForm
from .bounds_over_ranges import LengthRanges, QuantityBounds
from .closed_form import ClosedFormQuantity
from .kinds import ANGLE
from .quantity import Domain, Group


def _transmission_angle_bounds(box: LengthRanges) -> tuple[float, float]:
    flattest = geometry.least_transmission_angle(box.r1, box.l0, box.a1) if box.turns else 0.0
    return float(flattest), float(geometry.least_transmission_angle(box.r0, box.l1, box.a0))


TRANSMISSION_ANGLE = ClosedFormQuantity(
    name="transmission_angle",
    key="least_transmission_angle",
    title="least transmission angle",
    kind=ANGLE,
    forms=(ClosedForm.TRANSMISSION_ANGLE,),
    rises=(False, True, False),
    place=30,
    group=Group.PROPORTIONS,
    sentence=(
        "The transmission angle is the angle between the rod and the normal of the slider line; its least value "
        "over the turn says how well the rod pushes the slider along instead of against its guide."
    ),
    advice="90 deg is ideal; least values of 30 to 50 deg are usual. A longer rod raises it, offset lowers it.",
    formula="cos(mu_min) = (r + |e|) / l",
    picture="transmission angle",
    example="40 deg",
    better="high",
    domain=Domain.of_acute_angle("the least transmission angle must lie between 0 and 90 deg", "30 to 50 deg"),
    # Torque and error grow without bound towards locking.
    floor=float(np.radians(10.0)),
    bounds=QuantityBounds(
        compute=_transmission_angle_bounds,
        to_raise="a longer rod, a shorter crank or a smaller |offset|",
        to_lower="a shorter rod, a longer crank or a larger |offset|",
    ),
    offered=("requirement", "objective"),
)
