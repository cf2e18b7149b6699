"""Position, velocity and acceleration polygons of one position of the crank, both branches."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ....model.classical.polygons import Polygons, polygons
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Branch, Mechanism
from ...figures.panels import Line, Panel, Sheet, draw_sheet
from ...figures.style import save, shown

BRANCHES: tuple[Branch, ...] = ("open", "crossed")
_UNITS = ("mm", "m/s", "m/s²")
_COMMON = {"position": 1, "velocity": 1, "acceleration": 2}  # the last vertex of the crank, the same on both branches
CRANK_ANGLE = math.radians(30.0)
"""Drawn unless another one is asked for: no link of any common proportion is then normal to the slider line."""


def both_branches(
    linkage: Linkage, crank_angle: float, *, speed: float, acceleration: float
) -> Mapping[Branch, Polygons]:
    """Return the polygons of the linkage on each branch at one crank angle, rad."""
    return {
        branch: polygons(
            Linkage(linkage.crank, linkage.rod, linkage.offset, branch),
            crank_angle,
            speed=speed,
            acceleration=acceleration,
        )
        for branch in BRANCHES
    }


def polygon_sheet(
    found: Mapping[Branch, Polygons],
    *,
    title: str,
    subtitle: str,
    units: tuple[str, str, str] = _UNITS,
    length: float = 1e3,
) -> Sheet:
    """Return the three polygons as panels, one line for each branch; the vertices are named.

    units: of position, velocity and acceleration. length: the unit of positions in a metre.
    """
    panels = []
    for name, unit, vertices in zip(
        ("position", "velocity", "acceleration"),
        units,
        (Polygons.POSITION, Polygons.VELOCITY, Polygons.ACCELERATION),
        strict=True,
    ):
        lines, names = [], []
        for index, branch in enumerate(found):
            points = getattr(found[branch], name) * (length if name == "position" else 1.0)
            closed = np.concatenate([points, points[:1]]) if name != "position" else points
            lines.append(Line(branch, closed[:, 0], closed[:, 1], index))
            for number, (vertex, (x, y)) in enumerate(zip(vertices, points, strict=True)):
                if number > _COMMON[name]:
                    names.append((f"{vertex} {branch}", float(x), float(y)))
                elif index == 0:
                    names.append((vertex, float(x), float(y)))
        panels.append(Panel(f"{name}, {unit}", f"x, {unit}", tuple(lines), tuple(names), equal=True))
    return Sheet(title, subtitle, tuple(panels), columns=3)


def draw_polygons(mechanism: Mechanism, linkage: Linkage, path: Path, *, crank_angle: float = CRANK_ANGLE) -> Path:
    """Write the polygons at one crank angle, rad, as PNG; without a crank speed for 1 rad/s."""
    speed = mechanism.speed or 1.0
    found = both_branches(linkage, crank_angle, speed=speed, acceleration=mechanism.acceleration)
    subtitle = (
        f"crank {shown(1e3 * float(linkage.crank))}, rod {shown(1e3 * float(linkage.rod))}, "
        f"offset {shown(1e3 * float(linkage.offset))} mm; crank angle {shown(math.degrees(crank_angle))}°, "
        f"{shown(speed)} rad/s, {shown(mechanism.acceleration)} rad/s²"
    )
    sheet = polygon_sheet(found, title="Kinematic polygons", subtitle=subtitle)
    save(draw_sheet(sheet, width=4.6, height=4.2), path)
    return path
