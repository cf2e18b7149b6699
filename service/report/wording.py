"""Numbers and units as a report writes them."""

from __future__ import annotations

import math

from ...objectives.kinds import unit_text
from ..figures.numerals import shown
from ..runs.result import Cell

__all__ = ["as_stored", "rounded", "unit_text", "with_unit"]


def rounded(cell: Cell) -> str:
    """Return a value for people, six digits of it."""
    if cell is None:
        return "–"
    return cell if isinstance(cell, str) else shown(cell, 6)


def as_stored(cell: Cell) -> str:
    """Return a value as CSV has it, every digit; nothing for what is not defined, and for words."""
    if cell is None or isinstance(cell, str) or math.isnan(cell):
        return ""
    return repr(cell)


def with_unit(cell: Cell, unit: str) -> str:
    """Return a value for people with its unit."""
    return f"{rounded(cell)} {unit_text(unit)}".rstrip()
