"""Drive torque over the cycle: peak, also over one stroke, root mean square, mean, fluctuation; other loads on a motor.

The root mean square over time heats a motor. The mean over the crank angle is work per angle. The fluctuation is the
root mean square deviation from the mean, over the crank angle. Other
loads on a motor are its maximum and mean power, and the maximum reflected inertia.
"""

from functools import partial

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.signals.averages import torque_averages
from ..model.signals.signals import Signal
from .cycle_peak import CycleAverage, CyclePeak
from .kinds import INERTIA, POWER, TORQUE
from .machine_needs import DRIVEN, MASSES, ONE_CYLINDER, SPEED, WORK
from .quantity import Array, Group, Quantity, Values

_TORQUE = "T = J alpha + J' omega^2 / 2 + V' - F x'"
_peak = partial(
    CyclePeak,
    kind=TORQUE,
    signal=Signal.TORQUE,
    group=Group.DRIVE,
    section="8. Dynamics",
    picture="torque",
)
PEAK_TORQUE = _peak(
    name="peak_torque",
    place=20,
    sentence=(
        "The greatest torque of the drive within a turn, in either direction, with all masses, loads, gravity and "
        "friction of the job. The torques of several cylinders on one crankshaft add up."
    ),
    advice="It determines the size of motor and gear. At high speed inertia dominates, at low speed the load.",
    formula=f"max |T|, {_TORQUE}: reflected inertia J, potential energy V, load F",
    needs=(DRIVEN,),
    offered=("requirement", "objective"),
    on_datasheet=True,
)
PEAK_TORQUE_OUTWARD = _peak(
    name="peak_torque_outward",
    title="peak torque, outward stroke",
    during="outward stroke",
    place=50,
    sentence="The greatest torque of the drive while the slider moves outward, away from the crank pivot.",
    formula=f"max |T| over the outward stroke, {_TORQUE}",
    needs=(DRIVEN, ONE_CYLINDER),
    instead=PEAK_TORQUE.name,
    plain=True,
)
PEAK_TORQUE_INWARD = _peak(
    name="peak_torque_inward",
    title="peak torque, inward stroke",
    during="inward stroke",
    place=60,
    sentence="The greatest torque of the drive while the slider moves inward, towards the crank pivot.",
    formula=f"max |T| over the inward stroke, {_TORQUE}",
    needs=(DRIVEN, ONE_CYLINDER),
    instead=PEAK_TORQUE.name,
    plain=True,
)


_average = partial(
    CycleAverage,
    kind=TORQUE,
    signal=Signal.TORQUE,
    group=Group.DRIVE,
    picture="torque",
)
RMS_TORQUE = _average(
    name="rms_torque",
    title="RMS torque over time",
    short="RMS torque",
    statistic="rms",
    place=70,
    sentence=(
        "The root mean square of the drive torque over the time of a cycle, which determines the heating of a motor."
    ),
    advice="Compare it with the rated torque of the motor, and the peak torque with its greatest torque.",
    formula="sqrt(mean of T^2 over time), dt = d theta / omega",
    needs=(DRIVEN,),
    on_datasheet=True,
)
MEAN_TORQUE = _average(
    name="mean_torque",
    title="mean torque over the crank angle",
    short="mean torque",
    statistic="mean",
    place=80,
    sentence="The mean drive torque over the crank angle: the work on load and friction per radian.",
    advice="Inertia and gravity need no torque on average, however high their peaks.",
    formula="mean of T over the crank angle",
    signed=True,
    needs=(DRIVEN, WORK),
    instead=f"{PEAK_TORQUE.name} or {RMS_TORQUE.name}",
    plain=True,
)


_ROUNDING = 4e-15


class TorqueFluctuation(Quantity):
    """sqrt(rms^2 - mean^2) of the drive torque, both over the crank angle.

    Infinite where friction locks the linkage.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        averages = torque_averages(mechanism, dimensions, gradients=gradients)
        locks = np.isinf(averages.rms_over_angle)
        mean, rms = np.where(locks, 0.0, averages.mean), np.where(locks, 1.0, averages.rms_over_angle)
        difference = rms - np.abs(mean)
        difference = np.where(difference > _ROUNDING * rms, difference, 0.0)  # for a constant torque
        values = np.sqrt(difference * (rms + np.abs(mean)))
        slopes = None
        if averages.mean_gradients is not None and averages.rms_over_angle_gradients is not None:
            per = np.where(values > 0.0, 1.0 / np.where(values > 0.0, values, 1.0), 0.0)
            slopes = (rms * per)[:, None] * averages.rms_over_angle_gradients
            slopes = slopes - (mean * per)[:, None] * averages.mean_gradients
            slopes = np.where(locks[:, None], 0.0, slopes)
        return Values(np.where(locks, np.inf, values), slopes)


TORQUE_FLUCTUATION = TorqueFluctuation(
    name="torque_fluctuation",
    title="torque fluctuation over the crank angle",
    short="torque fluctuation",
    kind=TORQUE,
    place=85,
    group=Group.DRIVE,
    sentence="The root mean square over the crank angle of the drive torque's deviation from its mean.",
    advice="A flywheel evens it out. At constant speed it equals the RMS torque if a turn needs no work.",
    formula="sqrt(mean of (T - mean of T)^2 over the crank angle)",
    section="10. Motor and balance",
    picture="torque",
    needs=(DRIVEN,),
    plain=True,
)


_motor_peak = partial(CyclePeak, group=Group.DRIVE, section="10. Motor and balance")

PEAK_POWER = _motor_peak(
    name="peak_power",
    kind=POWER,
    signal=Signal.POWER,
    place=210,
    sentence="The greatest power that passes between drive and crank within a turn, driving or braking.",
    formula="max |T omega|",
    picture="power",
    needs=(SPEED, DRIVEN),
)
MEAN_POWER = CycleAverage(
    name="mean_power",
    title="mean power over time",
    short="mean power",
    kind=POWER,
    signal=Signal.TORQUE,
    statistic="mean",
    times_speed=True,
    place=220,
    group=Group.DRIVE,
    sentence="The mean drive power over time: the energy that the machine consumes per cycle, divided by the cycle "
    "time.",
    formula="mean of T omega over time: integral of T d theta over a cycle / cycle time",
    picture="power",
    signed=True,
    needs=(SPEED, DRIVEN, WORK),
    instead=PEAK_POWER.name,
)
PEAK_REFLECTED_INERTIA = _motor_peak(
    name="peak_reflected_inertia",
    title="greatest reflected inertia",
    kind=INERTIA,
    signal=Signal.REFLECTED_INERTIA,
    place=230,
    sentence=(
        "The greatest moment of inertia of the linkage as seen by the drive at the crank, including rod and slider."
    ),
    advice="To compare it with the inertia of a motor, divide it by the square of the gear ratio.",
    formula="max J, where J omega^2 / 2 is the kinetic energy of all links",
    picture="inertia",
    needs=(MASSES,),
)
