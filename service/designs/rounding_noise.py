"""Numbers of a design that rounding alone separates from zero."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ...objectives.column_keys import split_unit
from ..runs.result import Cell, Row

_NOISE = 1e-12
"""Relative to the greatest number in the same unit: sums over a cycle leave some 1e-16 of their terms each."""
_SLACK = "slack_"


def without_noise(row: Mapping[str, Cell]) -> Row:
    """Return a design with zero for numbers below the rounding of its others in the same unit.

    The mean torque of a machine without losses is such a sum of large terms, and so is a slack at its bound. Numbers
    without a unit have no common scale; of these, only slacks are compared, with their own quantity.
    """
    scales: dict[str, float] = {}
    for key, cell in row.items():
        if isinstance(cell, float) and math.isfinite(cell) and not key.startswith(_SLACK):
            unit = _scale_of(key)
            scales[unit] = max(scales.get(unit, 0.0), abs(cell))
    return {
        key: 0.0 if isinstance(cell, float) and 0.0 < abs(cell) < _NOISE * scales.get(_scale_of(key), 0.0) else cell
        for key, cell in row.items()
    }


def _scale_of(key: str) -> str:
    """Return the unit of a column; without one its name, which a slack shares with its quantity."""
    return split_unit(key)[1] or key.removeprefix(_SLACK)
