"""Position errors at the driven side over a limited swing."""

from functools import partial

from ..model.swing.swing_states import ERROR
from .kinds import ANGLE, LENGTH
from .position_error import POSITION_ERROR
from .quantity import Group
from .swing_quantity import SwingPeak

_error = partial(
    SwingPeak,
    state=ERROR,
    tolerated=True,
    group=Group.ACCURACY,
    source=POSITION_ERROR.source,
    picture="position error",
    about_tolerances=True,
)
SWING_ANGLE_ERROR = _error(
    name="swing_angle_error",
    title="crank angle error over the swing",
    short="crank angle error",
    kind=ANGLE,
    driver="slider",
    instead="swing_position_error",
    place=320,
    sentence=(
        "The greatest error of the crank angle over the swing if the slider drives, with links and actuator at their "
        "tolerances in the worst combination."
    ),
    formula="max over the swing of (sum of |dx/di| T_i + T_actuator) / |x'|, for i = crank, rod, offset",
    example="0.4 deg",
)
SWING_POSITION_ERROR = _error(
    name="swing_position_error",
    title="position error over the swing",
    kind=LENGTH,
    driver="crank",
    instead="swing_angle_error",
    place=321,
    sentence=(
        "The greatest error of the slider position over the swing if the crank drives, with crank, rod, offset and "
        "crank angle at their tolerances in the worst combination."
    ),
    formula="max over the swing of the sum of |dx/di| T_i, for i = crank, rod, offset, crank angle",
    example="0.3 mm",
)
