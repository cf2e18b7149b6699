"""Geometry of a limited swing: transmission angle at the driven side, slider travel, crank travel."""

import numpy as np

from .kinds import ANGLE, LENGTH
from .quantity import Domain, Group
from .swing_quantity import ClosedFormSwingQuantity

SWING_TRANSMISSION_ANGLE = ClosedFormSwingQuantity(
    name="swing_transmission_angle",
    title="least transmission angle of the swing",
    short="transmission angle",
    kind=ANGLE,
    measure="angle",
    place=300,
    group=Group.PROPORTIONS,
    sentence=(
        "The least transmission angle of the driven side over the swing: between rod and crank where the slider "
        "drives, zero at a dead point; between rod and the normal of the slider line where the crank drives."
    ),
    advice="The linkage keeps this margin from its dead points, or from opening. Forces grow without bound towards 0.",
    formula="min over the swing of asin|sin(theta - phi)|, or acos(|e - r sin(theta)| / l)",
    picture="transmission angle",
    example="30 deg",
    better="high",
    domain=Domain.of_acute_angle("the transmission angle of a swing must lie between 0 and 90 deg", "20 to 50 deg"),
    floor=float(np.radians(10.0)),
)
ACTUATOR_TRAVEL = ClosedFormSwingQuantity(
    name="actuator_travel",
    title="travel of the slider",
    kind=LENGTH,
    measure="travel",
    stated="slider",
    place=301,
    group=Group.MOTION,
    sentence="The distance of the slider between the two ends of the swing.",
    advice="An actuator on the slider must be able to travel this far.",
    formula="|x(end) - x(start)|",
    picture="speed",
    example="2 m",
)
SWING_ANGLE = ClosedFormSwingQuantity(
    name="swing_angle",
    title="angle of the swing",
    kind=ANGLE,
    measure="swing",
    stated="crank",
    place=302,
    group=Group.MOTION,
    sentence="The angle of the crank between the two ends of the swing.",
    advice="Where the two slider positions are stated, it follows from the lengths.",
    formula="|theta(end) - theta(start)|",
    picture="speed",
    example="90 deg",
)
