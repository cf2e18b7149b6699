"""Statistics of a loose joint as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .numbers import ROWS

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the statistics for people."""
    from rich.table import Table

    joint, radial = numbers["joint"], numbers["radial_clearance_mm"]
    console.print(f"Radial clearance of {radial:g} mm at the {joint} (law: {numbers['law']})", style="bold")
    if not numbers["turns"]:
        console.print("cancelled before there was a turn to count")
        return
    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    for justify in ("left", "right", "left", "left"):
        table.add_column(justify=justify, no_wrap=True)
    for _, key, unit, _, title, symbol in ROWS:
        value, certain = numbers[f"{key}{unit}"], numbers[f"{key}_uncertainty{unit}"]
        if value == 0.0 and not certain:
            continue
        table.add_row(title, f"{value:.4g}", "" if certain is None else f"± {certain:.2g}", symbol)
    console.print(table)
    turns, discarded = numbers["turns"], numbers["turns_discarded"]
    note = f"means over {turns} turns after {discarded} of running in, ± 99 % confidence"
    if numbers["status"] == "cancelled":
        note += "; cancelled before the end"
    console.print(f" {note}", style="dim")
