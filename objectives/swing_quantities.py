"""Quantities of a swing: greatest error, drive effort and power, transmission angle, and self-locking."""

from functools import partial

import numpy as np

from ..model.swing.swing_states import DRIVE, ERROR, POWER
from .kinds import ANGLE, ENERGY, FORCE, LENGTH, RATIO, TORQUE
from .kinds import POWER as POWER_KIND
from .motion_deviation import POSITION_ERROR
from .quantity import Domain, Group
from .swing_quantity import ClosedFormSwingQuantity, SwingIntegral, SwingLeast, SwingPeak

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


_peak = partial(SwingPeak, group=Group.DRIVE, picture="torque")

PEAK_ACTUATOR_FORCE = _peak(
    name="peak_actuator_force",
    kind=FORCE,
    state=DRIVE,
    driver="slider",
    instead="peak_actuator_torque",
    place=310,
    sentence="The greatest force that the actuator needs on the slider, on the forward or return stroke.",
    advice="It grows without bound towards a dead point.",
    formula="max over the swing of |P|",
    example="20 kN",
)
PEAK_ACTUATOR_TORQUE = _peak(
    name="peak_actuator_torque",
    kind=TORQUE,
    state=DRIVE,
    driver="crank",
    instead="peak_actuator_force",
    place=311,
    sentence="The greatest torque that the drive needs on the swinging crank, on the forward or return stroke.",
    formula="max over the swing of |T|",
)
HOLDING_FORCE = _peak(
    name="holding_force",
    kind=FORCE,
    state=None,
    driver="slider",
    instead="holding_torque",
    place=312,
    sentence="The greater force on the slider at the two ends of the swing, without inertia.",
    advice="With friction, this moves the linkage; a smaller one holds it.",
    formula="max of |P| at both ends, x' w and alpha towards 0",
    example="20 kN",
)
HOLDING_TORQUE = _peak(
    name="holding_torque",
    kind=TORQUE,
    state=None,
    driver="crank",
    instead="holding_force",
    place=313,
    sentence="The greater torque on the crank at the two ends of the swing, without inertia.",
    advice="With friction, this moves the linkage; a smaller one holds it.",
    formula="max of |T| at both ends, w and alpha towards 0",
)
HOLDING_FORCE_WITHOUT_FRICTION = _peak(
    name="holding_force_without_friction",
    title="holding force without friction",
    kind=FORCE,
    state=None,
    free=True,
    rubbing="holding_force",
    driver="slider",
    instead="holding_torque_without_friction",
    place=317,
    sentence="The greater of the two slider forces that balance the loads at the ends of the swing, without friction.",
    formula="max of |P| at both ends, mu = 0, x' w and alpha towards 0",
    example="20 kN",
)
HOLDING_TORQUE_WITHOUT_FRICTION = _peak(
    name="holding_torque_without_friction",
    title="holding torque without friction",
    kind=TORQUE,
    state=None,
    free=True,
    rubbing="holding_torque",
    driver="crank",
    instead="holding_force_without_friction",
    place=318,
    sentence="The greater of the two crank torques that balance the loads at the ends of the swing, without friction.",
    formula="max of |T| at both ends, mu = 0, w and alpha towards 0",
)
PEAK_ACTUATOR_POWER = _peak(
    name="peak_actuator_power",
    kind=POWER_KIND,
    state=POWER,
    timed=True,
    place=314,
    sentence="The greatest power of the drive over the swing, driving or braking.",
    formula="max over the swing of |P dx/dt|, or |T w|",
)
SWING_ENERGY = SwingIntegral(
    name="swing_energy",
    title="energy of the forward stroke",
    kind=ENERGY,
    integral="work",
    signed=True,
    group=Group.DRIVE,
    picture="power",
    place=315,
    sentence="The work of the drive on the forward stroke; negative if it has to brake.",
    formula="integral of P dx, or T dtheta, over the forward stroke",
)
SWING_EFFICIENCY = SwingIntegral(
    name="swing_efficiency",
    title="efficiency of the swing",
    kind=RATIO,
    integral="share",
    rubbing="1",
    group=Group.DRIVE,
    picture="power",
    place=316,
    sentence=(
        "The work that the swing needs without friction, divided by the work that it needs with friction: on the "
        "forward stroke, or on the return stroke if only that is driven. Inertia is ignored."
    ),
    formula="integral of P dx without friction / integral of P dx",
    example=0.8,
    better="high",
)


_least = partial(SwingLeast, signed=True, better="high", group=Group.DRIVE, picture="torque")
_ADVICE = "Below zero, the loads push and the drive holds back. A linkage above zero on both strokes is self-locking."

LEAST_FORCE_FORWARD = _least(
    name="least_force_forth",
    title="least actuator force, forward stroke",
    kind=FORCE,
    back=False,
    driver="slider",
    instead="least_torque_forth",
    place=322,
    sentence="The least force in the direction of motion that the actuator needs on a slow forward stroke.",
    advice=_ADVICE,
    formula="min over the forward stroke of P sgn(x' w)",
    example="0 N",
)
LEAST_FORCE_BACK = _least(
    name="least_force_back",
    title="least actuator force, return stroke",
    kind=FORCE,
    back=True,
    driver="slider",
    instead="least_torque_back",
    place=323,
    sentence="The least force in the direction of motion that the actuator needs on a slow return stroke.",
    advice=_ADVICE,
    formula="min over the return stroke of P sgn(x' w)",
    example="0 N",
)
LEAST_TORQUE_FORWARD = _least(
    name="least_torque_forth",
    title="least torque, forward stroke",
    kind=TORQUE,
    back=False,
    driver="crank",
    instead="least_force_forth",
    place=324,
    sentence="The least torque in the direction of motion that the crank needs on a slow forward stroke.",
    advice=_ADVICE,
    formula="min over the forward stroke of T sgn(w)",
    example="0 N m",
)
LEAST_TORQUE_BACK = _least(
    name="least_torque_back",
    title="least torque, return stroke",
    kind=TORQUE,
    back=True,
    driver="crank",
    instead="least_force_back",
    place=325,
    sentence="The least torque in the direction of motion that the crank needs on a slow return stroke.",
    advice=_ADVICE,
    formula="min over the return stroke of T sgn(w)",
    example="0 N m",
)
