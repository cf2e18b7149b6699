"""Warnings about inputs in Python, attributed to the user's line."""

from __future__ import annotations

import inspect
import warnings

from .errors import InputWarning

LONGEST = 10.0
"""m. A longer link, given without a unit, was probably meant in mm."""
_OURS = __name__.partition(".")[0]
_MAKERS = ("dataclasses", "copy")
"""Python modules that create objects again on behalf of callers."""


def warn_user(sentence: str, *, through_callers: bool = False) -> None:
    """Issue an `InputWarning` at the line that calls the caller's module, if that line is in user code.

    No warning is issued if this software itself is the caller: its numbers come from values with units, or have already
    been checked. through_callers: whether to look past its modules, which may only pass on the user's values.
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


def reading_in_both_units(name: str, number: float, unit: str, usual: str, factor: float) -> str:
    """Return a number as read in SI, and as probably meant in a usual unit.

    unit: SI unit. usual: usual unit for such values. factor: one SI unit in the usual unit.

    >>> reading_in_both_units("crank", 40.0, "m", "mm", 1e3)
    'crank 40 is 40 m = 40000 mm; write 0.04 for 40 mm'
    """
    return (
        f"{name} {number:g} is {number:g} {unit} = {factor * number:.6g} {usual}; write {number / factor:g} for "
        f"{number:g} {usual}"
    )
