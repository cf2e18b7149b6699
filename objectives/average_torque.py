"""Average torques: root mean square (what heats a motor) and mean (what the work costs) over the cycle."""

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .kinds import TORQUE
from .needs import DRIVEN, WORK
from .peak_torque import PEAK_TORQUE
from .quantity import Group

_SECTION = "10. Motor and balance"

RMS_TORQUE = CycleAverage(
    name="rms_torque",
    title="RMS torque",
    kind=TORQUE,
    signal=Signal.TORQUE,
    which="rms",
    place=70,
    group=Group.DRIVE,
    sentence="The root mean square of the drive torque over a turn, which is what warms up a motor.",
    advice="Compare it with the rated torque of the motor, and the peak torque with its greatest one.",
    formula="sqrt(mean of T^2 over the crank angle)",
    section=_SECTION,
    picture="torque",
    needs=(DRIVEN,),
    on_sheet=True,
)
MEAN_TORQUE = CycleAverage(
    name="mean_torque",
    title="mean torque",
    kind=TORQUE,
    signal=Signal.TORQUE,
    which="mean",
    place=80,
    group=Group.DRIVE,
    sentence="The average of the drive torque over a turn: what the load takes, and friction.",
    advice="Inertia and gravity need no torque on average, however high their peaks.",
    formula="mean of T over the crank angle",
    section=_SECTION,
    picture="torque",
    signed=True,
    needs=(DRIVEN, WORK),
    instead=f"{PEAK_TORQUE.name} or {RMS_TORQUE.name}",
    plain=True,
)
