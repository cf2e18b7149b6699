"""Limits as people read them and type them again: rounded so that asking for the number told is possible.

Told to the nearest digit, every other limit would lie beyond itself: 42.8078 deg of 42.80776 deg has no design.
"""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from typing import Literal

Side = Literal["down", "up"]
"""Side on which possible values lie: below the greatest value ("down") or above the least ("up")."""

DIGITS = 6
"""Significant digits of a limit: less than 1e-5 of it is given away, far below any tolerance of manufacture."""
_EXACT = 12
_ROUNDING = 1e-10
"""Relative: a value nearer than this to a shorter number is that number; a tenth of what counts as violated."""


def safe(value: float, side: Side, *, digits: int = DIGITS) -> str:
    """Return a limit in decimal digits, rounded to the side where all values are possible.

    value: in the unit that is shown, finite. A number of fewer digits within rounding is taken as it is: 240 for
    239.99999999999. Without exponent from 1e-4 to 1e9, so that it can be typed as it stands.
    """
    size = Decimal(repr(abs(float(value)) * _ROUNDING))
    rounded = Context(prec=digits, rounding=ROUND_FLOOR if side == "down" else ROUND_CEILING)
    return _number_text(rounded.plus(Decimal(repr(float(value))) + (size if side == "down" else -size)))


def exact(value: float) -> str:
    """Return a value that is possible alone, its neighbours not, in as many digits as rounding leaves of it."""
    return _number_text(Context(prec=_EXACT).plus(Decimal(repr(float(value)))))


def _number_text(number: Decimal) -> str:
    number = number.normalize()
    if number == 0:
        return "0"
    plain = -4 <= number.adjusted() < 9
    return f"{number:f}" if plain else f"{number:E}".replace("E", "e")
