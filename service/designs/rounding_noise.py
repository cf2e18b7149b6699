"""Numbers of a design that differ from zero only by rounding."""

import math
from collections.abc import Mapping

from ...objectives.column_keys import name_unit_and_factor_of_key
from ..runs.result import Cell, Row

_NOISE = 1e-12
"""Relative to the largest number in the same unit: sums over a cycle leave about 1e-16 of each term."""
_SLACK = "slack_"


def row_without_noise(row: Mapping[str, Cell]) -> Row:
    """Return a design in which numbers below the rounding error of those in the same unit are zero.

    Examples are the mean torque of a lossless machine, which is a sum of large terms, and a slack at its bound.
    Dimensionless numbers have no common scale; of these, only slacks are compared, with their own quantity.
    """
    scales: dict[str, float] = {}
    for key, cell in row.items():
        if isinstance(cell, float) and math.isfinite(cell) and not key.startswith(_SLACK):
            unit = _unit_or_name(key)
            scales[unit] = max(scales.get(unit, 0.0), abs(cell))
    return {
        key: 0.0 if isinstance(cell, float) and 0.0 < abs(cell) < _NOISE * scales.get(_unit_or_name(key), 0.0) else cell
        for key, cell in row.items()
    }


def _unit_or_name(key: str) -> str:
    """Return the unit of a column; without a unit its name, which a slack shares with its quantity."""
    return name_unit_and_factor_of_key(key)[1] or key.removeprefix(_SLACK)
