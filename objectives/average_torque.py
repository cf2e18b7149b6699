"""Average torques: root mean square (what heats a motor) and mean (what the work costs) over the cycle."""

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .quantity import NEWTON_METRE

RMS_TORQUE = CycleAverage("rms_torque", "rms_torque_Nm", "RMS torque", NEWTON_METRE, Signal.TORQUE, "rms")
MEAN_TORQUE = CycleAverage("mean_torque", "mean_torque_Nm", "mean torque", NEWTON_METRE, Signal.TORQUE, "mean")
