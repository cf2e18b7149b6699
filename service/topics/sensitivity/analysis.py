"""Sensitivity of every quantity to each dimension: numbers, text and figure."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rich.console import Console

from ....model.linkage.linkage import Linkage
from ....model.linkage.values import DIMENSIONS
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import System, shown_in
from ....objectives.registry import QUANTITIES
from ....objectives.tables.sensitivity import sensitivity
from ...runs.result import json_ready, rows_of
from ...text.tables import print_table, table
from ..peaks import row_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SAME = 1e-9  # relative: derivatives that differ by less are equal
_LEFT_OUT = ("inner_dead_centre_position", "outer_dead_centre_position")
"""Rows that the text leaves out, besides plain quantities: they follow from the dimensions at a glance."""


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return the table of `objectives.tables.sensitivity` for one linkage, ready for JSON: None where not defined.

    quantities: one entry each with quantity, title, unit, value, and for each dimension its derivative
    (<dimension>_per_mm), percent per percent (<dimension>_percent) and change for its tolerance
    (<dimension>_tolerance), in the unit of the entry; each once more with _below, for the side of smaller values.
    """
    return {"quantities": json_ready(rows_of(sensitivity(mechanism, row_of(linkage)[0]).to_dict("list")), gaps=True)}


def in_units(numbers: dict[str, Any], system: System) -> dict[str, Any]:
    """Return the numbers in a system of units: each entry in its unit there, derivatives per mm or per in."""
    per, length = shown_in("mm", system)

    def entry(row: dict[str, Any]) -> dict[str, Any]:
        unit, factor = shown_in(row["unit"], system)
        found: dict[str, Any] = {}
        for key, value in row.items():
            scale = factor / length if "_per_mm" in key else factor if "tolerance" in key or key == "value" else None
            found[key.replace("_per_mm", f"_per_{per}")] = value if scale is None or value is None else scale * value
        return found | {"unit": unit}

    return {"quantities": [entry(row) for row in numbers["quantities"]]}


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people: change of each quantity for one mm or in more, and in percent per percent."""
    per = "mm" if f"{DIMENSIONS[0]}_per_mm" in numbers["quantities"][0] else "in"
    console.print(f"Change of each quantity for 1 {per} more of a dimension (and in % for 1 % more)", style="bold")
    heads = [head for name in DIMENSIONS for head in (f">{name}", ">")]
    rows = table("quantity", ">value", "unit", *heads)
    kinks, plain = False, [*_LEFT_OUT, *(name for name, of in QUANTITIES.items() if of.plain)]
    for row in numbers["quantities"]:
        slopes = [row[f"{name}_per_{per}{side}"] for name in DIMENSIONS for side in ("", "_below")]
        if row["quantity"] in plain or row["value"] is None or (row["value"] == 0.0 and not any(slopes)):
            continue
        cells = []
        for name in DIMENSIONS:
            relative = _sides(row, f"{name}_percent", 3)
            cells += [_sides(row, f"{name}_per_{per}", 4), "" if relative == "-" else f"({relative} %)"]
            kinks = kinks or " / " in cells[-2]
        rows.add_row(row["title"], f"{row['value']:.5g}", row["unit"], *cells)
    print_table(console, rows)
    if kinks:
        console.print("a / b: at a kink, the derivative below and above the dimension", style="dim")


def _sides(row: dict[str, Any], key: str, digits: int) -> str:
    """Return a derivative as text: both where the quantity has a kink."""
    below, above = row[f"{key}_below"], row[key]
    if below is None or above is None or abs(above - below) <= _SAME * max(abs(above), abs(below)):
        return _signed(above, digits)
    return f"{_signed(below, digits)} / {_signed(above, digits)}"


def _signed(value: float | None, digits: int) -> str:
    if value is None or not math.isfinite(value):
        return "-"
    return "0" if value == 0.0 else f"{value:+.{digits}g}"


def figure(mechanism: Mechanism, linkage: Linkage) -> Figure:
    """Return the tornado figure: a bar for each quantity and dimension."""
    from .figure import tornado_figure, tornado_rows

    return tornado_figure(tornado_rows(mechanism, linkage))
