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
    from rich.table import Table

    from ...text.tables import print_table

    screen = console()
    shown = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for axis in axes:
        unit, _ = shown_in("rpm" if axis.parameter == "speed" else "mm", units)
        shown.add_column(f"{axis.parameter}, {unit}", justify="right")
    for item in quantities:
        shown.add_column(f"{item.title}, {shown_in(item.unit.symbol, units)[0]}".rstrip(", "), justify="right")
    stuck = 0
    keys = ["speed_rpm" if axis.parameter == "speed" else f"{axis.parameter}_mm" for axis in axes]
    for row in rows_in(rows_of(table.to_dict("list")), units):
        at = [row[key_in(key, units)[0]] for key in keys]
        values = [row[key_in(item.field, units)[0]] for item in quantities]
        stuck += bool(row["reason"])
        shown.add_row(*(f"{cell:.6g}" for cell in at), *("-" if row["reason"] else f"{cell:.6g}" for cell in values))
    print_table(screen, shown)
    if stuck:
        first = next(reason for reason in table["reason"] if reason)
        say(f"{stuck} of {len(table)} without a value; the first: {first}")
