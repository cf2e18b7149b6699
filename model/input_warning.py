"""Warnings about inputs in Python, in the name of the user's line."""

from __future__ import annotations

import inspect
import warnings

from .errors import InputWarning

LONGEST = 10.0
"""m. A longer link whose length has no unit was probably meant in mm."""
_OURS = __name__.partition(".")[0]
_MAKERS = ("dataclasses", "copy")
"""Modules of Python that create objects again on behalf of callers."""


def warn_user(sentence: str, *, through_callers: bool = False) -> None:
    """Warn with `InputWarning` at the line that calls the caller's module, if that line is a user's.

    There is no warning if this software itself calls: its numbers come from values with units, or have already been
    checked. through_callers: whether its modules may only pass on what the user's line states.
    """
    frame, modules = inspect.currentframe(), list[str]()
    while frame is not None:
        modules.append(frame.f_globals.get("__name__", ""))
        frame = frame.f_back
    passed = {*modules[:2], *_MAKERS}
    if through_callers:
        passed |= {name for name in modules if name.partition(".")[0] == _OURS}
    level, module = next(((n, name) for n, name in enumerate(modules, 1) if name not in passed), (1, _OURS))
    if module.partition(".")[0] != _OURS:
        warnings.warn(sentence, InputWarning, stacklevel=level)


def both_readings(name: str, number: float, unit: str, usual: str, factor: float) -> str:
    """Return a number in SI as read, and as probably meant in a usual unit.

    unit: SI unit. usual: usual unit for such values. factor: one SI unit in the usual unit.

    >>> both_readings("crank", 40.0, "m", "mm", 1e3)
    'crank 40 is 40 m = 40000 mm; write 0.04 for 40 mm'
    """
    return (
        f"{name} {number:g} is {number:g} {unit} = {factor * number:.6g} {usual}; write {number / factor:g} for "
        f"{number:g} {usual}"
    )
