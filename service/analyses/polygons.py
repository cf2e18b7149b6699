"""Vertices of the kinematic polygons of one design at one crank angle, both branches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism


def numbers(mechanism: Mechanism, linkage: Linkage, *, crank_angle: float = math.radians(30.0)) -> dict[str, Any]:
    """Return the vertices at one crank angle, rad, by branch and polygon; without a crank speed for 1 rad/s."""
    from ...model.classical.polygons import Polygons, polygons
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Branch

    branches: tuple[Branch, ...] = ("open", "crossed")
    speed = mechanism.speed or 1.0
    record: dict[str, Any] = {
        "crank_angle_deg": math.degrees(crank_angle),
        "speed_rad_s": speed,
        "acceleration_rad_s2": mechanism.acceleration,
    }
    for branch in branches:
        one = Linkage(linkage.crank, linkage.rod, linkage.offset, branch)
        found = polygons(one, crank_angle, speed=speed, acceleration=mechanism.acceleration)
        record[branch] = {
            "position_mm": dict(zip(Polygons.POSITION, (1e3 * found.position).tolist(), strict=True)),
            "velocity_m_s": dict(zip(Polygons.VELOCITY, found.velocity.tolist(), strict=True)),
            "acceleration_m_s2": dict(zip(Polygons.ACCELERATION, found.acceleration.tolist(), strict=True)),
            "rod_velocity_rad_s": float(found.rod_velocity),
            "rod_acceleration_rad_s2": float(found.rod_acceleration),
        }
    return record


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the vertices, one a line, both branches beside each other."""
    from rich import box
    from rich.table import Table

    from ..commands.tables import print_table

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
