"""Limits for a user to read and enter again: rounded so that a design can meet the reported limit.

Rounded to nearest, every other limit would be unreachable: if 42.80776 deg is the limit, no design has 42.8078 deg.
"""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from typing import Literal

Side = Literal["down", "up"]
"""Side of the possible values: below a greatest value ("down") or above a least value ("up")."""

DIGITS = 6
"""Significant digits of a limit: rounding gives away less than 1e-5 of it, far below any manufacturing tolerance."""
_EXACT = 12
_ROUNDING = 1e-10
"""Relative: a value closer than this to a shorter number becomes that number; a tenth of what counts as violated."""


def round_to_safe_side(value: float, side: Side, *, digits: int = DIGITS) -> str:
    """Return a limit in decimal digits, rounded to the side of the possible values.

    value: finite, in the display unit. A shorter number within rounding is used instead: 240 for 239.99999999999. It
    has no exponent from 1e-4 to 1e9, so that it can be typed as shown.
    """
    size = Decimal(repr(abs(float(value)) * _ROUNDING))
    rounded = Context(prec=digits, rounding=ROUND_FLOOR if side == "down" else ROUND_CEILING)
    return _number_text(rounded.plus(Decimal(repr(float(value))) + (size if side == "down" else -size)))


def isolated_value_in_full_digits(value: float) -> str:
    """Return an isolated possible value, in all digits that rounding errors leave certain."""
    return _number_text(Context(prec=_EXACT).plus(Decimal(repr(float(value)))))


def _number_text(number: Decimal) -> str:
    number = number.normalize()
    if number == 0:
        return "0"
    plain = -4 <= number.adjusted() < 9
    return f"{number:f}" if plain else f"{number:E}".replace("E", "e")
