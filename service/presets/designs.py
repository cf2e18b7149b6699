"""A design of each shipped job, near the knee of its front, to show its machine without solving it."""

from __future__ import annotations

from typing import NamedTuple


class Design(NamedTuple):
    """Lengths, mm, and the crank angles between which a crank swings, deg; None for full rotation."""

    crank_mm: float
    rod_mm: float
    offset_mm: float
    from_deg: float | None = None
    to_deg: float | None = None


DESIGNS = {
    "compressor": Design(29.81, 105.93, -11.43),
    "feeder": Design(37.62, 101.71, 31.78),
    "press": Design(26.8, 108.78, 47.02),
    "servo_press": Design(26.6, 175.54, 79.99),
    "sieve": Design(137.0, 556.3, 110.86),
    "support": Design(1360.0, 2426.8, -600.0, 11.16, 101.16),
}
