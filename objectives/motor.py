"""Loads on a motor besides its torque: maximum and mean power, maximum reflected inertia."""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_peak import CycleAverage, CyclePeak
from .kinds import INERTIA, POWER
from .machine_needs import DRIVEN, MASSES, SPEED, WORK
from .quantity import Group

_peak = partial(CyclePeak, group=Group.DRIVE, section="10. Motor and balance")

PEAK_POWER = _peak(
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
PEAK_REFLECTED_INERTIA = _peak(
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
