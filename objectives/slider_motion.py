"""Slider motion: greatest speed and acceleration over the cycle."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .quantity import METRE_PER_SECOND, METRE_PER_SECOND_SQUARED

PEAK_SLIDER_SPEED = CyclePeak(
    "peak_slider_speed", "peak_slider_speed_m_s", "peak slider speed", METRE_PER_SECOND, Signal.SLIDER_SPEED
)
PEAK_SLIDER_ACCELERATION = CyclePeak(
    "peak_slider_acceleration",
    "peak_slider_acceleration_m_s2",
    "peak slider acceleration",
    METRE_PER_SECOND_SQUARED,
    Signal.SLIDER_ACCELERATION,
)
