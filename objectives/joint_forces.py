"""Joint forces: the greatest reactions at crank pivot, crank pin, slider pin and guide over the cycle."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .quantity import NEWTON

PEAK_PIVOT_FORCE = CyclePeak("peak_pivot_force", "peak_pivot_force_N", "peak pivot force", NEWTON, Signal.PIVOT_FORCE)
PEAK_CRANK_PIN_FORCE = CyclePeak(
    "peak_crank_pin_force", "peak_crank_pin_force_N", "peak crank pin force", NEWTON, Signal.CRANK_PIN_FORCE
)
PEAK_SLIDER_PIN_FORCE = CyclePeak(
    "peak_slider_pin_force", "peak_slider_pin_force_N", "peak slider pin force", NEWTON, Signal.SLIDER_PIN_FORCE
)
PEAK_GUIDE_FORCE = CyclePeak("peak_guide_force", "peak_guide_force_N", "peak guide force", NEWTON, Signal.GUIDE_FORCE)
