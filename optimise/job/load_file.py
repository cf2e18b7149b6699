"""Loads with points in a file: a table of forces, torques or pressures, recognised by their units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...model.errors import InputError, JobError
from ...model.machine.loads.load import ANGLE_DATUM, CYCLE, Entry, Table
from ...model.machine.loads.registry import load_classes
from ...objectives.kinds import ANGLE, TIME, Kind
from ...objectives.units import quote
from . import value_types
from .curve_file import convert_time_to_angle, curve_of_table, first_cycle, reduce_curve_points
from .mistake_messages import key_of_location
from .named_files import SOURCE, Files, read_named_table, require_point_count
from .raw_tables import tables_in
from .stated_speed import stated_speed


def names_of_load_files(data: Mapping[str, Any]) -> list[str]:
    """Return the files that a job's loads name."""
    return [part["file"] for part in tables_in(data, "load") if isinstance(part.get("file"), str)]


def with_load_points(data: Mapping[str, Any], files: Files) -> dict[str, Any]:
    """Return a job with each load's file replaced by its points. Raises `InputError`."""
    job = dict(data)
    if names_of_load_files(data):
        job["load"] = [_load_with_points(part, place, files, data) for place, part in enumerate(job["load"])]
    return job


def _load_with_points(part: Any, place: int, files: Files, data: Mapping[str, Any]) -> Any:
    file = part.get("file") if isinstance(part, Mapping) else None
    tables = {
        (_kind_of_entry(at), _kind_of_entry(value_entry)): table for table, at, value_entry in load_tables_with_points()
    }
    if not isinstance(file, str):
        return part
    name = key_of_location(["load", place, "file"])
    allowed_keys = [
        "file",
        *dict.fromkeys(one.name for table in tables.values() for one in table.entries if not one.several),
    ]
    for key in part:
        if key not in allowed_keys:
            raise JobError(
                f"{key_of_location(['load', place, key])}: a load with file must not have this key; got "
                f"{quote(part[key])}; "
                f"possible here: {', '.join(allowed_keys)}"
            )
    argument_kinds = (*dict.fromkeys(at for at, _ in tables), TIME)
    curve = curve_of_table(
        read_named_table(files, name, file),
        argument_kinds,
        tuple(dict.fromkeys(value_entry for _, value_entry in tables)),
    )
    load_table = tables.get(
        (ANGLE if curve.argument_head.kind is TIME else curve.argument_head.kind, curve.value_head.kind)
    )
    if load_table is None:
        raise InputError(
            f"{curve.name} must be a table of a load; got {quote(curve.value_head.text)} over "
            f"{quote(curve.argument_head.text)}; give torques over the crank angle"
        )
    at, value_entry = (entry.name for entry in load_table.entries if entry.several)
    rest = {key: value for key, value in part.items() if key != "file"}
    if curve.argument_head.kind is TIME:
        signed = (
            ANGLE_DATUM in load_table.entries and rest.get(ANGLE_DATUM.name, ANGLE_DATUM.default) == ANGLE_DATUM.default
        )
        speed = stated_speed(data, curve.name)
        curve = convert_time_to_angle(curve, speed if signed else abs(speed))
    if curve.argument_head.kind is ANGLE:
        curve, turns = first_cycle(curve, {"360 deg": 1, "720 deg": 2}.get(str(rest.get(CYCLE.name))))
        rest |= {CYCLE.name: "720 deg"} if turns == 2 else {}
    curve = reduce_curve_points(curve)
    require_point_count(len(curve.arguments), curve.name, 2)
    places, sizes = curve.texts()
    return rest | {at: places, value_entry: sizes, SOURCE: curve.source(file)}


def load_tables_with_points() -> list[tuple[Table, Entry, Entry]]:
    """Return the tables of loads with points, each with its entries for the arguments and for the values."""
    every = [table for kind in load_classes() for table in kind.tables]
    pairs = [(table, [entry for entry in table.entries if entry.several]) for table in every]
    return [(table, pair[0], pair[1]) for table, pair in pairs if len(pair) == 2]


def _kind_of_entry(entry: Entry) -> Kind:
    """Return the kind of an entry's values."""
    marked: Any = getattr(value_types, str(entry.kind))
    kind: Kind = marked.__metadata__[0].kind
    return kind
