"""A front as a JSON file, written and read without losing a bit; the file does not contain its problem."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...model.arrays import Array, Mask
from ...model.errors import InputError
from ..problem.constraint_violation import minimised_objectives
from ..problem.problem import Problem
from .progress import DiscreteSearch, Progress

SAME = 1e-9
"""Relative spread within which numbers count as equal.

A quantity that the requirements hold at a value leaves the search with a spread of a few units in the last place (2e-16
each), amplified by its inputs. Constraints count as met to 1e-9. A spread that is visible in a drawing is a million
times greater.
"""


def is_constant(values: ArrayLike, *, size: ArrayLike = 0.0) -> Mask:
    """Return whether each column's numbers agree to within rounding: () or (m,) for values (n,) or (n, m).

    The spread is compared with the greatest magnitude, or with `size` if that is greater: the target, if the numbers
    are distances from one. NaN and infinity are ignored; a column without numbers is constant. Zero needs a size
    because it has no scale.
    """
    return np.asarray(column_ranges(values, size=size) == 0.0)


def column_ranges(values: ArrayLike, *, size: ArrayLike = 0.0) -> Array:
    """Return the range of each column of values as for `is_constant`; exactly 0 for a constant column."""
    values = np.ascontiguousarray(np.moveaxis(np.asarray(values, dtype=np.float64), 0, -1))  # ten times faster
    finite = np.where(np.isfinite(values), values, np.nan)
    low = np.fmin.reduce(finite, axis=-1, initial=np.inf)
    high = np.fmax.reduce(finite, axis=-1, initial=-np.inf)
    tolerance = SAME * np.maximum(np.maximum(np.abs(low), np.abs(high)), size)
    return np.where(high - low <= tolerance, 0.0, high - low)


_FORM = 1
_SAME = 1e-6
"""Relative difference of an objective between versions of this software and its libraries that is only rounding."""
_AS_THEY_ARE = ("status", "message", "hypervolume", "evaluations", "seconds", "seed", "versions")


def front_to_json(fields: Mapping[str, Any]) -> str:
    """Return a front as JSON fields: arrays in SI, columns in their units; "inf", "-inf", "nan" as text."""
    columns, dimensions, active = fields["columns"], fields["dimensions"], fields["active"]
    record = {
        "form": _FORM,
        "name": fields["problem"].name,
        "objectives": _objective_fields(fields["problem"]),
        "variables": dimensions.shape[1],
        **{name: fields[name] for name in _AS_THEY_ARE},
        "history": [asdict(progress) for progress in fields["history"]],
        "discrete": fields["discrete"] and asdict(fields["discrete"]),
        "words": [name for name, column in columns.items() if column.dtype.kind == "U"],
        "columns": {name: column.tolist() for name, column in columns.items()},
        "dimensions": dimensions.tolist(),
        "variants": list(fields["variants"]),
        "values": fields["values"].tolist(),
        "unknowns": [edges.shape[1] for edges in active],
        "goals": [[owner.tolist(), slopes.tolist()] for owner, slopes in fields["goals"]],
        "active": [edges.tolist() for edges in active],
    }
    return json.dumps(_with_text_for_non_finite(record), ensure_ascii=False, indent=1, allow_nan=False)


def write_front(fields: Mapping[str, Any], file: Path) -> None:
    """Write a front's fields to a file, completely or not at all. Raises `OSError`."""
    unfinished = file.with_name(f".{file.name}.part")
    unfinished.write_text(front_to_json(fields), encoding="utf-8")
    unfinished.replace(file)


def front_fields(file: Path, problem: Problem) -> dict[str, Any]:
    """Return the fields of a saved front, for `ParetoFront`.

    Raises `InputError` for a file that is not a saved front, or for a front of another problem.
    """
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
        fields = _front_fields(record, problem)
        objectives = record["objectives"]
    except OSError as error:
        raise InputError(f"{file} cannot be read: {error.strerror}; name a file that `save` wrote") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(
            f"{file} must be a front that `save` wrote; got another or a damaged file ({type(error).__name__}); solve "
            "its problem again"
        ) from None
    _require_same_objectives(fields, objectives, problem, file)
    return fields


def _front_fields(record: dict[str, Any], problem: Problem) -> dict[str, Any]:
    if record["form"] != _FORM:
        raise ValueError(f"form {record['form']}")
    words, count = set(record["words"]), len(record["values"])
    goals = zip(record["goals"], record["unknowns"], strict=True)
    active = zip(record["active"], record["unknowns"], strict=True)
    columns = {
        name: np.array(column, dtype=np.str_ if name in words else np.float64)
        for name, column in record["columns"].items()
    }
    if any(len(column) != count for column in (*columns.values(), record["dimensions"], record["unknowns"])):
        raise ValueError("columns of different lengths")
    return {
        "problem": problem,
        **{name: _number_from_json(record[name]) for name in _AS_THEY_ARE},
        "history": tuple(
            Progress(**{key: _number_from_json(value) for key, value in item.items()}) for item in record["history"]
        ),
        "discrete": None
        if record["discrete"] is None
        else DiscreteSearch(**record["discrete"] | {"continuous": tuple(map(float, record["discrete"]["continuous"]))}),
        "columns": columns,
        "dimensions": _array_of_rows(record["dimensions"], record["variables"]),
        "variants": tuple(record["variants"]),
        "values": _array_of_rows(record["values"], len(record["objectives"])),
        "goals": tuple(
            (np.array(owner, dtype=np.float64), _array_of_rows(slopes, free)) for (owner, slopes), free in goals
        ),
        "active": tuple(_array_of_rows(edges, free) for edges, free in active),
    }


def _require_same_objectives(fields: dict[str, Any], objectives: list[Any], problem: Problem, file: Path) -> None:
    """Raise `InputError` unless a problem has a front's objectives, with the values of its first design."""
    remedy = "load it with the problem that it was solved for"
    if objectives != _objective_fields(problem):
        saved, stated = (
            ", ".join(f"{sense} {name}" for name, sense, _ in items)
            for items in (objectives, _objective_fields(problem))
        )
        raise InputError(f"the objectives of {file} are {saved}; those of the problem are {stated}; {remedy}")
    if not len(fields["values"]):
        return
    try:
        part = problem.part(fields["variants"][0] if fields["variants"] else 0)
        values = minimised_objectives(part, part.evaluate(fields["dimensions"][:1]))[0]
    except InputError as error:
        raise InputError(f"{file} is the front of another problem: {error}; {remedy}") from None
    for (name, _, _), saved, value in zip(objectives, fields["values"][0], values, strict=True):
        if not (saved == value or abs(saved - value) <= _SAME * abs(saved)):
            raise InputError(
                f"{file} is the front of another problem: {name} of its first design is {abs(saved):.6g}, but "
                f"{abs(value):.6g} for this problem (SI); {remedy}"
            )


def _objective_fields(problem: Problem) -> list[list[Any]]:
    return [[objective.quantity, objective.sense, objective.target] for objective in problem.objectives]


def _array_of_rows(rows: list[Any], width: int) -> Array:
    return np.array(rows, dtype=np.float64).reshape(len(rows), width)


def _with_text_for_non_finite(value: Any) -> Any:
    """Return a value with text in place of numbers that JSON lacks."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, dict):
        return {key: _with_text_for_non_finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_with_text_for_non_finite(item) for item in value]
    return value


def _number_from_json(value: Any) -> Any:
    return float(value) if value in ("inf", "-inf", "nan") else value
