"""Average torques: root mean square (what heats a motor) and mean (what the work costs) over the cycle."""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .kinds import TORQUE
from .needs import DRIVEN, WORK
from .peak_torque import PEAK_TORQUE
from .quantity import Group

_average = partial(
    CycleAverage,
    kind=TORQUE,
    signal=Signal.TORQUE,
    group=Group.DRIVE,
    picture="torque",
)
RMS_TORQUE = _average(
    name="rms_torque",
    title="RMS torque",
    which="rms",
    place=70,
    sentence="The root mean square of the drive torque over a turn, which is what warms up a motor.",
    advice="Compare it with the rated torque of the motor, and the peak torque with its greatest one.",
    formula="sqrt(mean of T^2 over the crank angle)",
    needs=(DRIVEN,),
    on_sheet=True,
)
MEAN_TORQUE = _average(
    name="mean_torque",
    which="mean",
    place=80,
    sentence="The average of the drive torque over a turn: what the load takes, and friction.",
    advice="Inertia and gravity need no torque on average, however high their peaks.",
    formula="mean of T over the crank angle",
    signed=True,
    needs=(DRIVEN, WORK),
    instead=f"{PEAK_TORQUE.name} or {RMS_TORQUE.name}",
    plain=True,
)
