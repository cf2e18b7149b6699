"""Results in a unit system: keys, values and sentences.

All stored data is metric. Conversion to inches happens only here, at the edge.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...model.errors import SlidercrankError
from ...objectives.kinds import System, column_key_in_system, metric_unit_in, name_unit_and_factor_of_key
from ..runs.result import Cell, Result, Row, StoredObjective

if TYPE_CHECKING:
    from ...optimise.problem.problem import Problem


def convert_row(row: Mapping[str, Any], system: System) -> Row:
    """Return a design with the keys and values of a unit system. `crank_mm` 50.8 is `crank_in` 2 in the inch system."""
    return convert_rows([dict(row)], system)[0]


def convert_rows(rows: Sequence[Row], system: System) -> list[Row]:
    """Return designs that share their keys, converted as by `convert_row`."""
    if system == "metric" or not rows:
        return list(rows)
    names = {key: column_key_in_system(key, system) for key in rows[0]}
    return [{names[key][0]: _scaled_items(value, names[key][1]) for key, value in row.items()} for row in rows]


def convert_record(record: Any, system: System) -> Any:
    """Return a JSON record with the keys and values of a unit system, at any depth.

    Numbers and lists of numbers are converted from the unit in their key, and the key gets the new unit.
    """
    if system == "metric":
        return record
    if isinstance(record, Mapping):
        keys = {key: column_key_in_system(key, system) for key in record}
        return {
            name: _scaled_items(convert_record(record[key], system), factor) for key, (name, factor) in keys.items()
        }
    return [convert_record(item, system) for item in record] if isinstance(record, list | tuple) else record


def convert_result(result: Result, system: System, problem: Problem | None = None) -> Result:
    """Return the result of a run in a unit system. The order of designs and all selections are unchanged.

    problem: problem of the run; recomputes the trade-offs at the knee, which are stored in metric units; if None,
    they are omitted.
    """
    if system == "metric":
        return result
    return replace(
        result,
        objectives=tuple(convert_objective(objective, system) for objective in result.objectives),
        designs=convert_rows(result.designs, system),
        violated=convert_record(result.violated, system),
        discrete=convert_record(result.discrete, system),
        trade_offs=[] if problem is None or not result.trade_offs else _knee_trade_offs(problem, result, system),
    )


def convert_objective(objective: StoredObjective, system: System) -> StoredObjective:
    """Return an objective in a unit system."""
    column, factor = column_key_in_system(objective.column, system)
    target = None if objective.target is None else objective.target * factor
    return replace(objective, column=column, unit=metric_unit_in(objective.unit, system)[0], target=target)


def _knee_trade_offs(problem: Problem, result: Result, system: System) -> list[str]:
    from .stored_designs import front_of_result, stored_design
    from .trade_offs import trade_offs_of

    if result.knee is None:
        return []
    try:
        design = stored_design(problem, result, result.knee + 1)
        return trade_offs_of(front_of_result(problem, result), result.knee, design, system)
    except SlidercrankError:  # they are omitted
        return []


def _scaled_items(value: Any, factor: float) -> Any:
    if isinstance(value, Mapping):  # a key without a unit, such as a vertex, has the unit of its record
        return {
            key: item if name_unit_and_factor_of_key(key)[1] else _scaled_items(item, factor)
            for key, item in value.items()
        }
    if isinstance(value, list):
        return [_scaled_items(item, factor) for item in value]
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return value * factor if number and factor != 1.0 else value


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
