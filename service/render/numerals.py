"""Numbers and units in the style of figures and reports."""

import math

from ...objectives.kinds import System, metric_unit_in, unit_text
from ..runs.result import Cell


def format_number(value: float, digits: int = 4, *, zeros: bool = False) -> str:
    """Return a number formatted for reading: significant digits as given, no exponent if avoidable, a real minus sign.

    zeros: whether to keep trailing zeros, so that numbers in a column have the same precision.
    """
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "–"
    text = f"{value:#.{digits}g}".rstrip(".") if zeros else f"{value:.{digits}g}"
    if "e" in text and 1e-5 < abs(value) < 1e7:
        text = f"{value:.0f}" if abs(value) >= 1.0 else f"{value:.{digits + 3}f}".rstrip("0")
    return ("0" if float(text) == 0.0 else text).replace("-", "−")


def format_on_scale(value: float, low: float, high: float, *, digits: int = 4) -> str:
    """Return a number as text for an axis from low to high; below a millionth of the range, as zero."""
    return format_number(0.0 if abs(value) < 1e-6 * abs(high - low) else value, digits)


def title_with_unit(title: str, symbol: str, target: float | None = None) -> str:
    """Return an axis title with its unit and the target, if any."""
    named = f"{title}, {unit_text(symbol)}" if symbol else title
    return named if target is None else f"{named} (target {f'{target:g} {unit_text(symbol)}'.rstrip()})"


def format_cell(cell: Cell) -> str:
    """Return a value formatted for reading, with five significant digits."""
    if cell is None:
        return "–"
    return cell if isinstance(cell, str) else format_number(cell, 5)


def format_length(millimetres: float, system: System, digits: int = 4) -> str:
    """Return a length, mm, formatted for reading in the unit of a unit system."""
    unit, factor = metric_unit_in("mm", system)
    return f"{format_number(millimetres * factor, digits)} {unit}"


def format_cell_with_unit(cell: Cell, unit: str) -> str:
    """Return a value with its unit, formatted for reading."""
    return f"{format_cell(cell)} {unit_text(unit)}".rstrip()
