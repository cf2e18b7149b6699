"""Position errors of the driven side over a limited swing."""

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
        "How far the crank may stand off where the slider drives and the links and the actuator are off by their "
        "tolerances in the worst combination: the greatest value over the swing."
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
        "How far the slider may be off where the crank drives and crank, rod, offset and crank angle are off by their "
        "tolerances in the worst combination: the greatest value over the swing."
    ),
    formula="max over the swing of the sum of |dx/di| T_i, for i = crank, rod, offset, crank angle",
    example="0.3 mm",
)
