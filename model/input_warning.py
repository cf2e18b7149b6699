"""Warnings about inputs in Python, in the name of the user's line."""

from __future__ import annotations

import inspect
import warnings

from .errors import InputWarning

LONGEST = 10.0
"""m. A longer link whose length has no unit was probably meant in mm."""
_OURS = __name__.partition(".")[0]
_MAKERS = ("dataclasses", "copy")
"""Modules of Python that make objects anew for whoever calls them."""


def warn_user(sentence: str) -> None:
    """Warn by `InputWarning` in the name of the line that calls the caller's module, if that line is a user's.

    No warning where this software itself calls: its numbers come from values with units, or from where they have had
    their warning.
    """
    frame, modules = inspect.currentframe(), list[str]()
    while frame is not None:
        modules.append(frame.f_globals.get("__name__", ""))
        frame = frame.f_back
    passed = {*modules[:2], *_MAKERS}
    level, module = next(((n, name) for n, name in enumerate(modules, 1) if name not in passed), (1, _OURS))
    if module.partition(".")[0] != _OURS:
        warnings.warn(sentence, InputWarning, stacklevel=level)


def both_readings(name: str, number: float, unit: str, usual: str, factor: float) -> str:
    """Return a number in SI as it is read and as it was probably meant, in a usual unit.

    unit: SI. usual: the unit in which people have such values. factor: what one SI unit is in it.

    >>> both_readings("crank", 40.0, "m", "mm", 1e3)
    'crank 40 is 40 m = 40000 mm; write 0.04 for 40 mm'
    """
    return (
        f"{name} {number:g} is {number:g} {unit} = {factor * number:.6g} {usual}; write {number / factor:g} for "
        f"{number:g} {usual}"
    )
