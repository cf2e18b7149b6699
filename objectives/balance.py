"""Balance: what the moving masses do to the frame, without gravity and load (`model.inertia`), over the cycle."""

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .cycle_peak import CyclePeak
from .quantity import NEWTON, NEWTON_METRE

PEAK_SHAKING_FORCE = CyclePeak(
    "peak_shaking_force", "peak_shaking_force_N", "peak shaking force", NEWTON, Signal.SHAKING_FORCE
)
RMS_SHAKING_FORCE = CycleAverage(
    "rms_shaking_force", "rms_shaking_force_N", "RMS shaking force", NEWTON, Signal.SHAKING_FORCE, "rms"
)
PEAK_SHAKING_MOMENT = CyclePeak(
    "peak_shaking_moment", "peak_shaking_moment_Nm", "peak shaking moment", NEWTON_METRE, Signal.SHAKING_MOMENT
)
RMS_SHAKING_MOMENT = CycleAverage(
    "rms_shaking_moment", "rms_shaking_moment_Nm", "RMS shaking moment", NEWTON_METRE, Signal.SHAKING_MOMENT, "rms"
)
