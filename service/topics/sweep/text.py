"""Sweeps as tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ....objectives.kinds import System, shown_in
from ...designs.columns import key_in
from ...designs.shown_units import rows_in
from ...runs.result import rows_of
from ...text.screen import console, say

if TYPE_CHECKING:
    import pandas as pd

    from ....objectives.quantity import Quantity
    from ....objectives.tables.sweep import Axis


def show(table: pd.DataFrame, axes: Sequence[Axis], quantities: Sequence[Quantity], units: System) -> None:
    """Write one row for each point; then how many have no value, and why the first has none."""
    from ...text.tables import print_table
    from ...text.tables import table as table_of

    units_of = ["rpm" if axis.parameter == "speed" else "mm" for axis in axes]
    heads = [f">{axis.parameter}, {shown_in(unit, units)[0]}" for axis, unit in zip(axes, units_of, strict=True)]
    heads += [f">{item.title}, {shown_in(item.unit.symbol, units)[0]}".rstrip(", ") for item in quantities]
    shown = table_of(*heads)
    stuck = 0
    keys = [f"{axis.parameter}_{unit}" for axis, unit in zip(axes, units_of, strict=True)]
    for row in rows_in(rows_of(table.to_dict("list")), units):
        at = [row[key_in(key, units)[0]] for key in keys]
        values = [row[key_in(item.field, units)[0]] for item in quantities]
        stuck += bool(row["reason"])
        shown.add_row(*(f"{cell:.6g}" for cell in at), *("-" if row["reason"] else f"{cell:.6g}" for cell in values))
    print_table(console(), shown)
    if stuck:
        first = next(reason for reason in table["reason"] if reason)
        say(f"{stuck} of {len(table)} without a value; the first: {first}")
