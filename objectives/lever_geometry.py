"""Lengths of a lever's cylinder over its swing, and the distance from dead points."""

from functools import partial

import numpy as np

from ..model.turning_cylinder.closed_forms import (
    cylinder_travel,
    dead_point_margin,
    extension_ratio,
    spare_extension,
    transmission_angle,
)
from .kinds import ANGLE, LENGTH, RATIO
from .lever_quantity import LeverForm
from .quantity import Domain, Group
from .swing_quantities import ACTUATOR_TRAVEL, SWING_TRANSMISSION_ANGLE

_form = partial(LeverForm, group=Group.MOTION, picture="cylinder")
_length = partial(_form, moved_by=("cylinder", "turning crank"))

LEVER_TRANSMISSION_ANGLE = _form(
    name="lever_transmission_angle",
    swing_counterpart=SWING_TRANSMISSION_ANGLE.name,
    title="least transmission angle of the lever",
    short="transmission angle",
    kind=ANGLE,
    forms=(lambda c, _: transmission_angle(c, c.start), lambda c, _: transmission_angle(c, c.end)),
    least=True,
    place=330,
    group=Group.PROPORTIONS,
    picture="transmission angle",
    sentence="The least angle between the lever and the line from pin to cylinder pivot, zero at a dead point.",
    advice="Forces of the cylinder grow without bound towards 0.",
    formula="min over the swing of asin(f |sin(psi)| / AB)",
    example="30 deg",
    better="high",
    domain=Domain.of_acute_angle("the transmission angle of a lever lies between 0 and 90 deg", "20 to 50 deg"),
    floor=float(np.radians(10.0)),
)
DEAD_POINT_MARGIN = _form(
    name="dead_point_margin",
    title="angle of the lever to its dead point",
    kind=ANGLE,
    forms=(lambda c, _: dead_point_margin(c, c.start), lambda c, _: dead_point_margin(c, c.end)),
    least=True,
    place=331,
    group=Group.PROPORTIONS,
    picture="transmission angle",
    sentence="The least angle between the lever and a dead point, where both pivots and the pin are in line.",
    formula="min over the swing of |psi|, |180 deg - |psi||",
    example="15 deg",
    better="high",
    domain=Domain.of_acute_angle("the angle to a dead point lies between 0 and 90 deg", "15 to 40 deg"),
)
LEAST_CYLINDER_LENGTH = _length(
    name="least_cylinder_length",
    kind=LENGTH,
    forms=(lambda c, _: c.cylinder_end_lengths[0], lambda c, _: c.cylinder_end_lengths[1]),
    least=True,
    place=332,
    sentence="The least length of the cylinder between its pins over the motion.",
    advice="The closed length of the cylinder must not exceed it.",
    formula="min over the motion of sqrt(r^2 + f^2 - 2 r f cos(psi) - e^2)",
    example="650 mm",
    better="",
)
GREATEST_CYLINDER_LENGTH = _length(
    name="greatest_cylinder_length",
    kind=LENGTH,
    forms=(lambda c, _: c.cylinder_end_lengths[0], lambda c, _: c.cylinder_end_lengths[1]),
    place=333,
    sentence="The greatest length of the cylinder between its pins over the motion.",
    advice="Closed length plus stroke of the cylinder must not be less.",
    formula="max over the motion of sqrt(r^2 + f^2 - 2 r f cos(psi) - e^2)",
    example="1080 mm",
    better="",
)
CYLINDER_TRAVEL = _length(
    name="cylinder_travel",
    swing_counterpart=ACTUATOR_TRAVEL.name,
    title="travel of the cylinder",
    kind=LENGTH,
    forms=(lambda c, _: cylinder_travel(c),),
    place=334,
    sentence="The difference of the cylinder's greatest and least length over the motion.",
    advice="The stroke of the cylinder must not be less.",
    formula="max L - min L",
    example="400 mm",
)
EXTENSION_RATIO = _length(
    name="extension_ratio",
    title="extension ratio of the cylinder",
    kind=RATIO,
    forms=(lambda c, _: extension_ratio(c),),
    place=335,
    sentence="The greatest length of the cylinder divided by its least.",
    advice="For a single-stage cylinder it is below 2, and about 1.6 if the end fittings are included.",
    formula="max L / min L",
    example=1.6,
    domain=Domain(
        lower=1.0, open=False, idle=True, rule="an extension ratio is 1 or more", remedy="1.3 to 1.7 are usual"
    ),
)
CYLINDER_LENGTH_MARGIN = _length(
    name="cylinder_length_margin",
    title="spare length of the cylinder",
    kind=LENGTH,
    forms=(
        lambda c, _: c.cylinder_end_lengths[0] - c.closed_length,
        lambda c, _: c.cylinder_end_lengths[1] - c.closed_length,
        lambda c, _: spare_extension(c, c.cylinder_end_lengths[0]),
        lambda c, _: spare_extension(c, c.cylinder_end_lengths[1]),
    ),
    least=True,
    known=("closed_length or dead_length",),
    place=336,
    sentence="The least distance that the motion keeps from the ends of the cylinder's stroke; negative if it goes "
    "beyond them.",
    advice="Unless a job sets another bound, it is at least 0.",
    formula="min(L_min - closed length, closed length + stroke - L_max), or L_min - dead length - travel",
    example="5 mm",
    better="high",
    signed=True,
    floor=0.0,
)
