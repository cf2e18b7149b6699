"""Peak torque: the greatest size of the drive torque over the cycle, or over one stroke."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .quantity import NEWTON_METRE

PEAK_TORQUE = CyclePeak("peak_torque", "peak_torque_Nm", "peak torque", NEWTON_METRE, Signal.TORQUE)
PEAK_TORQUE_OUTWARD = CyclePeak(
    "peak_torque_outward",
    "peak_torque_outward_Nm",
    "peak torque, outward stroke",
    NEWTON_METRE,
    Signal.TORQUE,
    "outward stroke",
)
PEAK_TORQUE_INWARD = CyclePeak(
    "peak_torque_inward",
    "peak_torque_inward_Nm",
    "peak torque, inward stroke",
    NEWTON_METRE,
    Signal.TORQUE,
    "inward stroke",
)
