"""What sizes a motor beside its torque: greatest and mean power, greatest inertia that it feels."""

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .cycle_peak import CyclePeak
from .quantity import KILOGRAM_SQUARE_METRE, WATT

PEAK_POWER = CyclePeak("peak_power", "peak_power_W", "peak power", WATT, Signal.POWER)
MEAN_POWER = CycleAverage("mean_power", "mean_power_W", "mean power", WATT, Signal.TORQUE, "mean", times_speed=True)
PEAK_REFLECTED_INERTIA = CyclePeak(
    "peak_reflected_inertia",
    "peak_reflected_inertia_kg_m2",
    "greatest reflected inertia",
    KILOGRAM_SQUARE_METRE,
    Signal.REFLECTED_INERTIA,
)
