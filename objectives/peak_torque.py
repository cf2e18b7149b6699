"""Peak torque: the greatest size of the drive torque over the cycle, or over one stroke."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import TORQUE
from .needs import DRIVEN
from .quantity import Group

_TORQUE = "T = J alpha + J' omega^2 / 2 + V' - F x'"
_SECTION = "8. Dynamics"

PEAK_TORQUE = CyclePeak(
    name="peak_torque",
    title="peak torque",
    kind=TORQUE,
    signal=Signal.TORQUE,
    place=20,
    group=Group.DRIVE,
    sentence=(
        "The greatest torque that the drive must give within a turn, whichever way it acts, with all masses, "
        "loads, gravity and friction of the job."
    ),
    advice="It sizes motor and gear; at high speed inertia dominates it, at low speed the load.",
    formula=f"max |T|, {_TORQUE}: reflected inertia J, potential energy V, load F",
    section=_SECTION,
    picture="torque",
    needs=(DRIVEN,),
    offered=("requirement", "objective"),
    on_sheet=True,
)
PEAK_TORQUE_OUTWARD = CyclePeak(
    name="peak_torque_outward",
    title="peak torque, outward stroke",
    kind=TORQUE,
    signal=Signal.TORQUE,
    during="outward stroke",
    place=50,
    group=Group.DRIVE,
    sentence="The greatest torque of the drive while the slider moves outward, away from the crank pivot.",
    formula=f"max |T| over the outward stroke, {_TORQUE}",
    section=_SECTION,
    picture="torque",
    needs=(DRIVEN,),
    plain=True,
)
PEAK_TORQUE_INWARD = CyclePeak(
    name="peak_torque_inward",
    title="peak torque, inward stroke",
    kind=TORQUE,
    signal=Signal.TORQUE,
    during="inward stroke",
    place=60,
    group=Group.DRIVE,
    sentence="The greatest torque of the drive while the slider moves inward, towards the crank pivot.",
    formula=f"max |T| over the inward stroke, {_TORQUE}",
    section=_SECTION,
    picture="torque",
    needs=(DRIVEN,),
    plain=True,
)
