"""Vertices of the kinematic polygons as a table, both branches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the vertices, one a line, both branches beside each other."""
    from rich import box
    from rich.table import Table

    from ...text.tables import print_table

    title = f"Kinematic polygons at {numbers['crank_angle_deg']:.6g} deg, {numbers['speed_rad_s']:.6g} rad/s"
    console.print(title, style="bold", soft_wrap=True)
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1), show_edge=False, pad_edge=False)
    table.add_column("vertex")
    for name in ("open x", "open y", "crossed x", "crossed y"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("unit")
    units = (("position_mm", "mm"), ("velocity_m_s", "m/s"), ("acceleration_m_s2", "m/s^2"))
    for polygon, unit in units:
        for vertex in numbers["open"][polygon]:
            values = (*numbers["open"][polygon][vertex], *numbers["crossed"][polygon][vertex])
            table.add_row(vertex, *(f"{value + 0.0:.5g}" for value in values), unit)
    print_table(console, table)
