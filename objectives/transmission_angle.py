"""Transmission angle: the least angle between rod and the normal of the slider line over the cycle."""

from ..model.kinematics.closed_forms import ClosedForm
from .closed_form import ClosedFormQuantity
from .quantity import DEGREE

TRANSMISSION_ANGLE = ClosedFormQuantity(
    "transmission_angle",
    "least_transmission_angle_deg",
    "least transmission angle",
    DEGREE,
    (ClosedForm.TRANSMISSION_ANGLE,),
)
