"""Loads in a job file, [[load]]: each is a table in the form that its kind of load declares. Several add up.

Points may be in a file: a table of forces, torques or pressures, recognised by their units.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from functools import cached_property, reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    create_model,
)

from ...model.errors import InputError, JobError
from ...model.machine.loads import load as model
from ...model.machine.loads.load import ANGLE_DATUM, CYCLE, Entry, Table
from ...model.machine.loads.registry import load_classes
from ...objectives.kinds import ANGLE, TIME, Kind
from ...objectives.units import quote
from . import value_types
from .crank_speed import stated_speed
from .curve_file import convert_time_to_angle, curve_of_table, first_cycle_and_turn_count, reduce_curve_points
from .mistake_messages import key_of_location
from .named_files import MOST_POINTS, SOURCE, Files, read_named_table, require_point_count, tables_in, unread_file_error
from .part_kinds import Kinds
from .value_types import Checked, optional_entry


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
        (_kind_of_entry(at), _kind_of_entry(value_entry)): table
        for table, at, value_entry in tables_of_loads_with_points()
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
        curve, turns = first_cycle_and_turn_count(curve, {"360 deg": 1, "720 deg": 2}.get(str(rest.get(CYCLE.name))))
        rest |= {CYCLE.name: "720 deg"} if turns == 2 else {}
    curve = reduce_curve_points(curve)
    require_point_count(len(curve.arguments), curve.name, 2)
    places, sizes = curve.argument_and_value_texts()
    return rest | {at: places, value_entry: sizes, SOURCE: curve.summary_text(file)}


def tables_of_loads_with_points() -> list[tuple[Table, Entry, Entry]]:
    """Return the tables of loads with points, each with its entries for the arguments and for the values."""
    every = [table for kind in load_classes() for table in kind.tables]
    pairs = [(table, [entry for entry in table.entries if entry.several]) for table in every]
    return [(table, pair[0], pair[1]) for table, pair in pairs if len(pair) == 2]


def _kind_of_entry(entry: Entry) -> Kind:
    """Return the kind of an entry's values."""
    marked: Any = getattr(value_types, str(entry.kind))
    kind: Kind = marked.__metadata__[0].kind
    return kind


def require_increasing(typed: Any, handler: ValidatorFunctionWrapHandler) -> tuple[float, ...]:
    """Return a table's points in SI; reject any point that is not above the previous one."""
    points: tuple[float, ...] = handler(typed)
    for n, (before, after) in enumerate(itertools.pairwise(points)):
        if after <= before:
            raise InputError(
                f"must increase; got {quote(typed[n + 1])} after {quote(typed[n])}; sort the table and remove "
                "repeated points"
            )
    return points


def require_nondecreasing(typed: Any, handler: ValidatorFunctionWrapHandler) -> tuple[float, ...]:
    """Return the points of a load's table in SI; raise an error if one decreases or repeats twice."""
    at: tuple[float, ...] = handler(typed)
    n = model.index_of_first_misplaced_point(at)
    if n is not None:
        raise InputError(model.order_rule_broken_at_point(n, at, quote(typed[n]), quote(typed[n - 1])))
    return at


class LoadPart(Checked[model.Load]):
    """A load."""

    def build(self) -> model.Load:
        """Return the load for the model."""
        return self.built_load

    @cached_property
    def built_load(self) -> model.Load:
        """The load for the model; building a long table takes a moment."""
        return super().build()


def _part_of_table(table: model.Table) -> type[LoadPart]:
    """Return the job-file table that a kind of load declares."""
    fields: dict[str, Any] = {entry.name: (_entry_type(entry), _entry_field(entry)) for entry in table.entries}
    if any(entry.several for entry in table.entries):
        fields[SOURCE] = (value_types.Source, value_types.summary_entry())
    part = create_model(table.name, __base__=LoadPart, __doc__=table.help, **fields)
    part.model_config["json_schema_extra"] = {
        "x-load": {"key": table.key, "title": table.title, "first": dict(table.initial), "motion": table.motion}
    }
    part.model_rebuild(force=True)
    part.makes = staticmethod(table.build)
    return part


def _entry_type(entry: model.Entry) -> Any:
    item_type: Any = getattr(value_types, entry.kind) if isinstance(entry.kind, str) else Literal[entry.kind]
    several: Any = tuple.__class_getitem__((item_type, ...)) if entry.several else item_type
    return Annotated[several, WrapValidator(require_nondecreasing)] if entry.increasing else several


def _entry_field(entry: model.Entry) -> Any:
    shape: Any = {"min_length": 2, "max_length": MOST_POINTS} if entry.several else {}
    default = ... if entry.default is None else entry.default
    words = isinstance(default, str)
    return optional_entry(entry.description, entry.example, default=default, validate_default=words, **shape)


def _load_file_part() -> type[LoadPart]:
    """Return a load whose points are in a file, with the possible entries of all tables."""
    entries: dict[str, list[model.Entry]] = {}
    for table, *_ in tables_of_loads_with_points():
        for entry in table.entries:
            if not entry.several:
                entries.setdefault(entry.name, []).append(entry)
    file = optional_entry(
        "a table beside the job file: forces, torques or pressures, recognised by their units", "trace.csv"
    )
    fields: dict[str, Any] = {"file": (Annotated[str, Field(max_length=200)], file)}
    for name, several in entries.items():
        kind: Any = reduce(or_, map(_entry_type, several)) | None
        fields[name] = (kind, optional_entry(several[0].description, several[0].example))
    part = create_model("FileLoad", __base__=LoadPart, __doc__="A load whose points are in a file.", **fields)
    part.makes = staticmethod(_raise_unread_file)
    return part


def _raise_unread_file(file: str, **_: object) -> model.Load:
    raise unread_file_error(file, "points")


PARTS = {table.key: _part_of_table(table) for kind in load_classes() for table in kind.tables} | {
    "file": _load_file_part()
}
"""Tables of loads by the key that identifies the kind, in the order of the tests."""


def _load_kinds_text() -> str:
    """Return the kinds of load for messages, each by its required keys."""
    required = [
        [entry.name for entry in table.entries if entry.default is None]
        for kind in load_classes()
        for table in kind.tables
    ]
    shapes = [f"{{ {', '.join(names)} }}" for names in [*required, ["file"]]]
    return f"{', '.join(shapes[:-1])} or {shapes[-1]}"


_SYNONYMS = {"resists": "opposes", "against": "opposes", "assists": "helps", "along": "helps"}
_KINDS = Kinds(PARTS, _load_kinds_text(), "give each its own [[load]]; loads add up", _SYNONYMS)

if TYPE_CHECKING:
    Load = LoadPart
else:
    Load = Annotated[
        reduce(or_, (Annotated[part, Tag(f"({key})")] for key, part in PARTS.items())),
        Discriminator(_KINDS.kind_tag),
        BeforeValidator(_KINDS.require_one_kind),
    ]
