"""Options that select one design of a stored run: `--design`, `--knee`, `--topsis`, `--lexicographic`."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...model.errors import InputError
from ...objectives.kinds import RATIO
from ..runs.result import Result, StoredObjective
from .selection import plain_number

if TYPE_CHECKING:
    from ...model.arrays import Array

_TOPSIS = '"peak_torque=2, transmission_angle=1"'
_LEXICOGRAPHIC = '"peak_torque: 5 %, transmission_angle"'


def require_single_choice(design: int, result: Result, *, has_other_choice: bool) -> None:
    """Raise `InputError` for a number that the run does not have, or one combined with another selection option."""
    if has_other_choice:
        raise InputError("a design must be chosen in one way; got its number and another way; keep one of them")
    if not 1 <= design <= len(result.designs):
        count = len(result.designs)
        raise InputError(f"the run has designs 1 to {count}; got {design}; name one of them")


def chosen_row(
    result: Result, rows: Sequence[int], *, knee: bool, topsis: str | None, lexicographic: str | None
) -> int | None:
    """Return the index of the row that the options select, or None if there is no such option.

    Raises `InputError` for two selection options.
    """
    from ...optimise.front import choose_design

    ways = [
        name
        for name, option in (("knee", knee), ("topsis", topsis), ("lexicographic", lexicographic))
        if option not in (None, False)
    ]
    if len(ways) > 1:
        raise InputError(f"a design must be chosen in one way; got {' and '.join(ways)}; keep one of them")
    if not ways:
        return None
    weights = None if topsis is None else _parse_weights(topsis, result.objectives)
    order = None if lexicographic is None else _parse_lexicographic_order(lexicographic, result.objectives)
    if not rows:
        return None
    values, sizes = minimised_values(result)[list(rows)], target_magnitudes(result)
    if weights is not None:
        return rows[choose_design.topsis(values, weights, size=sizes)]
    if order is not None:
        return rows[choose_design.lexicographic(values, order, size=sizes)]
    return rows[choose_design.knee_row(values, size=sizes)]


def minimised_values(result: Result) -> Array:
    """Return the objectives (n, m) of a stored run, all minimised, in display units."""
    import numpy as np

    values = [[objective.minimised_value(row) for objective in result.objectives] for row in result.designs]
    return np.array(values, dtype=np.float64).reshape(len(result.designs), len(result.objectives))


def target_magnitudes(result: Result) -> list[float]:
    """Return the targets of objectives, in display units, or 0: the scale for rounding errors in their distances."""
    return [abs(objective.target or 0.0) for objective in result.objectives]


def _parse_weights(text: str, objectives: Sequence[StoredObjective]) -> list[float]:
    """Return a weight for each objective, zero for omitted ones."""
    weights = dict.fromkeys(range(len(objectives)), 0.0)
    named: set[int] = set()
    for part in _comma_separated_parts(text, _TOPSIS):
        name, equals, value = part.partition("=")
        column = _position_of_objective(name, objectives)
        weight = plain_number(value)
        if not equals or weight is None or not math.isfinite(weight) or weight < 0.0 or column in named:
            raise InputError(
                f"a weight must be OBJECTIVE=NUMBER, zero or more, each objective once; got {part!r}; write it like "
                f"{_TOPSIS}"
            )
        named.add(column)
        weights[column] = weight
    return list(weights.values())


def _parse_lexicographic_order(text: str, objectives: Sequence[StoredObjective]) -> list[tuple[int, float, float]]:
    """Return objectives in order: column, absolute tolerance (display unit) and tolerance relative to the range."""
    order = []
    for part in _comma_separated_parts(text, _LEXICOGRAPHIC):
        name, colon, value = part.partition(":")
        column = _position_of_objective(name, objectives)
        absolute, share = (
            _absolute_and_relative_tolerance(part, value.strip(), objectives[column]) if colon else (0.0, 0.0)
        )
        order.append((column, absolute, share))
    return order


def _absolute_and_relative_tolerance(part: str, value: str, objective: StoredObjective) -> tuple[float, float]:
    from ...objectives.units import kind_of_any_unit, to_si, value_of_one_si_unit_in

    try:
        if value.endswith("%"):
            return 0.0, to_si(value[:-1], RATIO, sign="zero or more") / 100.0
        kind = kind_of_any_unit(objective.unit)
        if kind.unit and plain_number(value) is not None:
            raise InputError(f"must be {kind.name} with its unit, or a percentage of the range; got {value}")
        return to_si(value, kind, sign="zero or more", plain=False) * value_of_one_si_unit_in(objective.unit), 0.0
    except InputError as error:
        raise InputError(f"the tolerance in {part!r} {error}; write it like {_LEXICOGRAPHIC}") from None


def _comma_separated_parts(text: str, example: str) -> list[str]:
    parts = [part.strip() for part in re.split(r",(?![^()]*\))", text)]  # except commas within min and max
    if not all(parts):
        raise InputError(f"objectives must be separated by single commas; got {text!r}; write it like {example}")
    return parts


def _position_of_objective(name: str, objectives: Sequence[StoredObjective]) -> int:
    """Return the position of an objective by its name or its column."""
    name = name.strip()
    for column, objective in enumerate(objectives):
        if name == objective.column or "".join(name.split()) == "".join(objective.quantity.split()):
            return column
    names = ", ".join(objective.quantity for objective in objectives)
    raise InputError(f"a design must be chosen by the objectives of its run: {names}; got {name!r}; name one of them")
