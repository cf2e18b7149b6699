"""Average torques: root mean square over time, which heats a motor, and mean over the crank angle.

The mean over the crank angle is work per angle.
"""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .kinds import TORQUE
from .machine_needs import DRIVEN, WORK
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
