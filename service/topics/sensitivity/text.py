"""Sensitivity of every quantity to each dimension, as a table."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from .numbers import DIMENSIONS

if TYPE_CHECKING:
    from rich.console import Console


_SAME = 1e-9  # relative: derivatives that differ by less are equal
_LEFT_OUT = ("inner_dead_centre_position", "outer_dead_centre_position")
"""Rows that the text leaves out, besides plain quantities: they follow from the dimensions at a glance."""


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people: change of each quantity for one millimetre more, and in percent per percent."""
    from rich.table import Table

    from ....objectives.registry import QUANTITIES
    from ...text.tables import print_table

    console.print("Change of each quantity for 1 mm more of a dimension (and in % for 1 % more)", style="bold")
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column("quantity", no_wrap=True)
    table.add_column("value", justify="right", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for name in DIMENSIONS:
        table.add_column(name, justify="right", no_wrap=True)
        table.add_column("", justify="right", no_wrap=True)
    kinks, plain = False, [*_LEFT_OUT, *(name for name, of in QUANTITIES.items() if of.plain)]
    for row in numbers["quantities"]:
        slopes = [row[f"{name}_per_mm{side}"] for name in DIMENSIONS for side in ("", "_below")]
        if row["quantity"] in plain or row["value"] is None or (row["value"] == 0.0 and not any(slopes)):
            continue
        cells = []
        for name in DIMENSIONS:
            relative = _sides(row, f"{name}_percent", 3)
            cells += [_sides(row, f"{name}_per_mm", 4), "" if relative == "-" else f"({relative} %)"]
            kinks = kinks or " / " in cells[-2]
        table.add_row(row["title"], f"{row['value']:.5g}", row["unit"], *cells)
    print_table(console, table)
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
