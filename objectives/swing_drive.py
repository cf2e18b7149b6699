"""Drive over a limited swing: force or torque, holding force or torque, power, work and efficiency."""

from functools import partial

from ..model.swing.swing_states import DRIVE, POWER
from .kinds import ENERGY, FORCE, RATIO, TORQUE
from .kinds import POWER as POWER_KIND
from .quantity import Group
from .swing_quantity import SwingIntegral, SwingPeak

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
