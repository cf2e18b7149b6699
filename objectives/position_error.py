"""Position error: how far tolerances move the slider, greatest over the cycle or over a part of the stroke."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .quantity import MILLIMETRE

POSITION_ERROR = CyclePeak(
    "position_error", "position_error_mm", "position error, worst case", MILLIMETRE, Signal.POSITION_ERROR
)
POSITION_ERROR_RSS = CyclePeak(
    "position_error_rss",
    "position_error_rss_mm",
    "position error, root sum square",
    MILLIMETRE,
    Signal.POSITION_ERROR_RSS,
)

POSITION_ERRORS = (POSITION_ERROR, POSITION_ERROR_RSS)
"""Quantities that come from tolerances: not defined without any, though the model gives them as zero."""
