"""Paths of numbers in the tables of a job: `mechanism.slider.mass`, `load.1.force`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ...model.machine.loads.load import StrokePart
from ...model.machine.raw_numbers_of_designs import DRIVE, LEVER
from ...objectives.formula.formulas import ROOTS
from ...objectives.units import closest_word
from .crank_speed import SPEED_KEYS
from .value_types import Part


def with_value_at_path(job: Part | Mapping[str, Any], path: str, value: Any) -> dict[str, Any]:
    """Return a job, or its tables, with a value set at a path; parts along the path stay as read.

    Raises `LookupError` if the job states no number or text there.
    """
    root, *rest = path.split(".")
    if root not in ROOTS:
        raise LookupError(root)
    tables: dict[str, Any] = _replace_at(job, [root, *rest], value)
    return tables


def unknown_path_message(path: str, tables: Mapping[str, Any]) -> str:
    """Return the message for a path without a number, or for a crank speed under another key."""
    table, _, key = path.partition(".")
    entries = tables.get(table)
    speed_keys = (
        [speed_key for speed_key in SPEED_KEYS if speed_key in entries]
        if isinstance(entries, Mapping) and key in SPEED_KEYS
        else []
    )
    if table == "mechanism" and speed_keys:
        return (
            f"must name a number that the job gives; got {path}, but the job gives mechanism.{speed_keys[0]}; give "
            f"{key} in "
            f"[mechanism] in place of {speed_keys[0]}"
        )
    several = _not_one_value_message(path, tables)
    if several:
        return several
    is_known = path in LEVER or (table == "drive" and key in DRIVE)
    known_paths = [known_path for known_path, value in _walk_values(tables, "") if _is_settable_value(value)]
    near = None if is_known else closest_word(path, known_paths)
    hint = (
        f"did you mean {near}?"
        if near
        else f"give it in [{path.partition('.')[0]}] first, because single designs need it"
    )
    return f"must name a number that the job gives; got {path}; {hint}"


def _not_one_value_message(path: str, tables: Mapping[str, Any]) -> str:
    """Return the message for a path to a table, a list or a value in one; otherwise ""."""
    part, is_complete = _innermost_part(path, tables)
    if isinstance(part, list | tuple) and part and not any(isinstance(item, Mapping) for item in part):
        return (
            f"must name a single number; got {path}{',' if is_complete else ' from'} a list of {len(part)} values; the "
            "values in a list, such as the points of a table, cannot vary; solve a job for each list"
        )
    if is_complete and isinstance(part, Mapping):
        starts = set("+-.0123456789")  # of a number, or of a text that begins like one
        number = next((known for known, value in _walk_values(part, path) if str(value)[:1] in starts), None)
        named = f"; did you mean {number}?" if number else " without a number that can vary"
        return f"must name a number that the job gives; got {path}, a table{named}"
    return ""


def stated_values_of_part(part: Any) -> dict[str, Any]:
    """Return the values that a part of a job states, by key; nested parts stay as read."""
    return dict(part) if isinstance(part, Mapping) else {name: getattr(part, name) for name in part.model_fields_set}


def _innermost_part(path: str, tables: Mapping[str, Any]) -> tuple[Any, bool]:
    """Return the innermost part of a job along a path, and whether the path ends there."""
    part: Any = tables
    steps = path.split(".")
    for step in steps if steps[0] in ROOTS else ():
        inner = {str(n + 1): item for n, item in enumerate(part)} if isinstance(part, list | tuple) else part
        if not isinstance(inner, Mapping) or step not in inner:
            return part, False
        if not isinstance(part, Mapping) and not isinstance(inner[step], Mapping):
            return part, False
        part = inner[step]
    return part, steps[0] in ROOTS


def _replace_at(part: Any, steps: list[str], value: Any) -> Any:
    step, *rest = steps
    table: Any
    place: Any
    if isinstance(part, list | tuple):
        table, place = list(part), next((n for n in range(len(part)) if step == str(n + 1)), None)
        if place is None or not rest:
            raise LookupError(step)
    elif isinstance(part, Part | Mapping):
        table, place = stated_values_of_part(part), step
    else:
        raise LookupError(step)
    if rest:
        table[place] = _replace_at(table[place], rest, value)
    elif _is_settable_value(table[place]):
        table[place] = value
    else:
        raise LookupError(step)
    return table


def _is_settable_value(value: object) -> bool:
    return isinstance(value, int | float | str | StrokePart)


def _walk_values(data: Any, root: str) -> Iterator[tuple[str, Any]]:
    """Yield path and value of everything in a job that is not a table; list positions count from 1."""
    if isinstance(data, Mapping):
        for name, item in data.items():
            if root or name in ROOTS:
                yield from _walk_values(item, f"{root}.{name}" if root else str(name))
    elif isinstance(data, list | tuple):
        for place, item in enumerate(data):
            if isinstance(item, Mapping):
                yield from _walk_values(item, f"{root}.{place + 1}")
    else:
        yield root, data
