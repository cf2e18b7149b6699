"""Numbers whose text keeps their value, for text in which another unit is to take the place of theirs."""

from __future__ import annotations

import math
import re
from typing import Any

_MARK = "\ue000"  # of private use: no text has it
_FORMAT = re.compile(r"(\+?)(?:\.(\d+))?g")
_USUAL = 6  # digits of "g"
TAG = rf"(?:{_MARK}[^{_MARK}]*{_MARK})?"
"""Pattern of what may follow the digits of a number: the format that it is to have."""
_TAGGED = re.compile(rf"([-+]?[\d.]+(?:e[-+]?\d+)?){_MARK}([^{_MARK}]*){_MARK}")


class Exact(float):
    """A number whose text has all its digits, and how many of them are to be told."""

    def __format__(self, form: str) -> str:
        found = _FORMAT.fullmatch(form)
        if found is None or not math.isfinite(self):
            return float.__format__(self, form)
        return f"{'+' if found[1] and self >= 0.0 else ''}{float(self)!r}{_MARK}{form}{_MARK}"

    def __neg__(self) -> Exact:
        return Exact(-float(self))

    def __abs__(self) -> Exact:
        return Exact(abs(float(self)))

    def __add__(self, other: float) -> Exact:
        return Exact(float(self) + other)

    def __mul__(self, other: float) -> Exact:
        return Exact(float(self) * other)

    def __truediv__(self, other: float) -> Exact:
        return Exact(float(self) / other)

    __radd__, __rmul__ = __add__, __mul__


def exact(numbers: Any) -> Any:
    """Return numbers, and those in lists and dictionaries, as `Exact` ones."""
    if isinstance(numbers, dict):
        return {name: exact(value) for name, value in numbers.items()}
    if isinstance(numbers, (list, tuple)):
        return type(numbers)(map(exact, numbers))
    return Exact(numbers) if isinstance(numbers, float) else numbers


def changed(text: str, factor: float, least: int) -> str:
    """Return the text of an exact number times a factor, with its digits but at least so many; "" for another text."""
    found = _TAGGED.fullmatch(text)
    if found is None:
        return ""
    form = _FORMAT.fullmatch(found[2])
    assert form is not None
    return f"{float(found[1]) * factor:{form[1]}.{max(int(form[2] or _USUAL), least)}g}"


def plain(text: str) -> str:
    """Return a text whose exact numbers have the digits that are to be told."""
    return _TAGGED.sub(lambda found: format(float(found[1]), found[2]), text)
