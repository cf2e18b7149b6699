"""Sensitivity of every quantity to each dimension: numbers, text and figure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from ....model.linkage.dimensions import DIMENSIONS
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import DISPLAYED_KINDS, LENGTH, RATIO, Kind, System, display_unit, metric_unit_in
from ....objectives.registry import QUANTITIES
from ....objectives.tables.sensitivity import sensitivity
from ...render.blocks import Block, Table, Text, Unit, Value, column, heading, note, words
from ...runs.result import json_ready, rows_of_columns
from ..peaks import lengths_row
from ..record_types import Keys, Note, Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SLOPES = ("per_mm", "percent", "tolerance")
_Slope = Annotated[float | None, Note("null where the quantity has none")]
_Change = Annotated[
    dict[str, Any],
    Keys(
        "Change",
        "Changes in a quantity: per mm of a dimension, in percent per percent, and for its tolerance. If a kink makes "
        "the change towards smaller dimensions differ, a second value gives it.",
        {
            "quantity": str,
            "title": str,
            "unit": str,
            "value": Annotated[float | None, Note("null where it is not defined, and where it is infinite")],
            **{f"{of}_{slope}{side}": _Slope for of in DIMENSIONS for slope in _SLOPES for side in ("", "_below")},
        },
    ),
]


class Sensitivity(Record):
    """Change of every quantity with each dimension."""

    quantities: list[_Change]


_SAME = 1e-9  # relative difference below which derivatives are equal
_LEFT_OUT = ("inner_dead_centre_position", "outer_dead_centre_position")
"""Rows omitted from the text, besides plain quantities: they follow directly from the dimensions."""


def numbers(mechanism: Mechanism, linkage: Linkage) -> Sensitivity:
    """Return the table of `objectives.tables.sensitivity` for one linkage, ready for JSON: None if undefined.

    quantities: one entry each with quantity, title, unit, value, and for each dimension its derivative
    (<dimension>_per_mm), percent per percent (<dimension>_percent) and change for its tolerance
    (<dimension>_tolerance), in the unit of the entry; again with _below for the derivative towards smaller values.
    """
    return {
        "quantities": json_ready(
            rows_of_columns(sensitivity(mechanism, lengths_row(linkage)[0]).to_dict("list")), gaps=True
        )
    }


def in_units(numbers: Sensitivity, system: System) -> dict[str, Any]:
    """Return the numbers in a unit system: each entry in its unit there, derivatives per mm or per in."""
    per, length = metric_unit_in("mm", system)

    def entry(row: dict[str, Any]) -> dict[str, Any]:
        unit, factor = metric_unit_in(row["unit"], system)
        converted: dict[str, Any] = {}
        for key, value in row.items():
            scale = factor / length if "_per_mm" in key else factor if "tolerance" in key or key == "value" else None
            converted[key.replace("_per_mm", f"_per_{per}")] = (
                value if scale is None or value is None else scale * value
            )
        return converted | {"unit": unit}

    return {"quantities": [entry(row) for row in numbers["quantities"]]}


def blocks(numbers: Sensitivity) -> list[Block]:
    """Return in human-readable form: changes per mm or inch, in percent per percent, and for the tolerances."""
    rows: list[tuple[Text, ...]] = []
    tolerance_rows: list[tuple[Text, ...]] = []
    kinks, plain = False, [*_LEFT_OUT, *(name for name, quantity in QUANTITIES.items() if quantity.plain)]
    for row in numbers["quantities"]:
        slopes = [row[f"{name}_per_mm{side}"] for name in DIMENSIONS for side in ("", "_below")]
        if row["quantity"] in plain or row["value"] is None or (row["value"] == 0.0 and not any(slopes)):
            continue
        kind = next((kind for kind in DISPLAYED_KINDS if kind.metric.symbol == row["unit"]), RATIO)
        cells: list[Text] = []
        for name in DIMENSIONS:
            slope = _derivative_text(row, f"{name}_per_mm", _kind_per_length(kind), 4)
            percent = words("({percent} %)", percent=_derivative_text(row, f"{name}_percent", RATIO, 3))
            cells += [slope, "" if row[f"{name}_percent"] is None else percent]
            kinks = kinks or isinstance(slope, tuple)
        value = Value(row["value"] / kind.metric.factor, kind, 5)
        rows.append((row["title"], value, Unit(kind), *cells))
        if any(row[f"{name}_tolerance"] for name in DIMENSIONS):
            changes = (_derivative_text(row, f"{name}_tolerance", kind, 4) for name in DIMENSIONS)
            tolerance_rows.append((row["title"], *changes, Unit(kind)))
    heads = [head for name in DIMENSIONS for head in (column(name), column())]
    columns = column("quantity", left=True), column("value"), column("unit", left=True), *heads
    title = "Change of each quantity if a dimension grows by 1 {unit} (and in % if it grows by 1 %)"
    result_blocks: list[Block] = [heading(title, unit=Unit(LENGTH)), Table(columns, tuple(rows))]
    if tolerance_rows:
        columns = column("quantity", left=True), *map(column, DIMENSIONS), column("unit", left=True)
        result_blocks += [
            heading("Change of each quantity for the tolerance of a dimension"),
            Table(columns, tuple(tolerance_rows)),
        ]
    return (
        [*result_blocks, note("a / b: at a kink, the derivative below and above the dimension")]
        if kinks
        else result_blocks
    )


def _kind_per_length(kind: Kind) -> Kind:
    """Return the kind of a derivative with respect to a dimension, without a unit: the heading states the step."""
    inch = kind.display_unit("inch").factor / LENGTH.display_unit("inch").factor
    return replace(
        kind, metric=display_unit("", kind.metric.factor / LENGTH.metric.factor), inch=display_unit("", inch)
    )


def _derivative_text(row: dict[str, Any], key: str, kind: Kind, digits: int) -> Text:
    """Return a derivative as text; at a kink of the quantity, both one-sided derivatives."""

    def value(number: float | None) -> Value:
        return Value(
            None if number is None else number / kind.metric.factor, kind, digits, sign=True, bare=True, missing="-"
        )

    lower, upper = row[f"{key}_below"], row[key]
    if lower is None or upper is None or abs(upper - lower) <= _SAME * max(abs(upper), abs(lower)):
        return value(upper)
    return words("{below} / {above}", below=value(lower), above=value(upper))


def figure(mechanism: Mechanism, linkage: Linkage) -> Callable[[System], Figure]:
    """Return the tornado figure: a bar for each quantity and dimension."""
    from .figure import tornado_figure, tornado_rows

    return partial(tornado_figure, tornado_rows(mechanism, linkage))
