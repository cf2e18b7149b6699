"""Kinematic polygons of one design at one crank angle, both branches: position, velocity and acceleration."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from rich.console import Console

from ....model.classical.polygons import Polygons, polygons
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Branch, Mechanism
from ...figures.numerals import shown
from ...figures.sheets import Line, Panel, Sheet
from ...text.tables import print_table, table

_BRANCHES: tuple[Branch, ...] = ("open", "crossed")
_POLYGONS = (
    ("position", Polygons.POSITION, "mm", "mm"),
    ("velocity", Polygons.VELOCITY, "m_s", "m/s"),
    ("acceleration", Polygons.ACCELERATION, "m_s2", "m/s^2"),
)
"""Name, vertices, suffix of the key and unit."""
_COMMON = {"position": 1, "velocity": 1, "acceleration": 2}  # the last vertex of the crank, the same on both branches
CRANK_ANGLE = math.radians(30.0)
"""Of the polygons unless another one is asked for: no link of any common proportion is then normal to the line."""


def both_branches(
    linkage: Linkage, crank_angle: float, *, speed: float, acceleration: float
) -> Mapping[Branch, Polygons]:
    """Return the polygons of the linkage on each branch at one crank angle, rad."""
    lengths = (linkage.crank, linkage.rod, linkage.offset)
    return {
        branch: polygons(Linkage(*lengths, branch), crank_angle, speed=speed, acceleration=acceleration)
        for branch in _BRANCHES
    }


def numbers(mechanism: Mechanism, linkage: Linkage, *, crank_angle: float = CRANK_ANGLE) -> dict[str, Any]:
    """Return the vertices at one crank angle, rad, by branch and polygon; without a crank speed for 1 rad/s."""
    speed = mechanism.speed or 1.0
    record: dict[str, Any] = {
        "crank_angle_deg": math.degrees(crank_angle),
        "speed_rad_s": speed,
        "acceleration_rad_s2": mechanism.acceleration,
    }
    for branch, found in both_branches(linkage, crank_angle, speed=speed, acceleration=mechanism.acceleration).items():
        record[branch] = {
            f"{name}_{suffix}": dict(zip(vertices, _shown(found, name).tolist(), strict=True))
            for name, vertices, suffix, _ in _POLYGONS
        } | {
            "rod_velocity_rad_s": float(found.rod_velocity),
            "rod_acceleration_rad_s2": float(found.rod_acceleration),
        }
    return record


def _shown(found: Polygons, name: str, length: float = 1e3) -> np.ndarray:
    """Return the vertices of a polygon (n, 2). length: the unit of positions in a metre."""
    points: np.ndarray = getattr(found, name)
    return length * points if name == "position" else points


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the vertices, one a line, both branches beside each other."""
    title = f"Kinematic polygons at {numbers['crank_angle_deg']:.6g} deg, {numbers['speed_rad_s']:.6g} rad/s"
    console.print(title, style="bold", soft_wrap=True)
    rows = table("vertex", ">open x", ">open y", ">crossed x", ">crossed y", "unit", ruled=True)
    for name, vertices, suffix, unit in _POLYGONS:
        for vertex in vertices:
            values = [value for branch in _BRANCHES for value in numbers[branch][f"{name}_{suffix}"][vertex]]
            rows.add_row(vertex, *(f"{value + 0.0:.5g}" for value in values), unit)
    print_table(console, rows)


def figure(mechanism: Mechanism, linkage: Linkage, *, crank_angle: float = CRANK_ANGLE) -> Sheet:
    """Return the polygons at one crank angle, rad; without a crank speed for 1 rad/s."""
    speed = mechanism.speed or 1.0
    found = both_branches(linkage, crank_angle, speed=speed, acceleration=mechanism.acceleration)
    subtitle = (
        f"{linkage.label}; crank angle {shown(math.degrees(crank_angle))}°, "
        f"{shown(speed)} rad/s, {shown(mechanism.acceleration)} rad/s²"
    )
    return polygon_sheet(found, title="Kinematic polygons", subtitle=subtitle)


def polygon_sheet(
    found: Mapping[Branch, Polygons],
    *,
    title: str,
    subtitle: str,
    units: tuple[str, str, str] = ("mm", "m/s", "m/s²"),
    length: float = 1e3,
) -> Sheet:
    """Return the three polygons as panels, one line for each branch; the vertices are named.

    units: of position, velocity and acceleration. length: the unit of positions in a metre.
    """
    panels = []
    for (name, vertices, _, _), unit in zip(_POLYGONS, units, strict=True):
        lines, names = [], []
        for index, branch in enumerate(found):
            points = _shown(found[branch], name, length)
            closed = np.concatenate([points, points[:1]]) if name != "position" else points
            lines.append(Line(branch, closed[:, 0], closed[:, 1], index))
            for number, (vertex, (x, y)) in enumerate(zip(vertices, points, strict=True)):
                if number > _COMMON[name]:
                    names.append((f"{vertex} {branch}", float(x), float(y)))
                elif index == 0:
                    names.append((vertex, float(x), float(y)))
        panels.append(Panel(f"{name}, {unit}", f"x, {unit}", tuple(lines), tuple(names), equal=True))
    return Sheet(title, subtitle, tuple(panels), columns=3, width=4.6, height=4.2)
