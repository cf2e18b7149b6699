"""Peak torque: maximum magnitude of the drive torque over the cycle, or over one stroke."""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import TORQUE
from .machine_needs import DRIVEN, ONE_CYLINDER
from .quantity import Group

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
