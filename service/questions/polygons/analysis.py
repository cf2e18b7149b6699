"""Kinematic polygons of one design at one crank angle, for both branches: position, velocity and acceleration."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ....model.classical.loop_equations import Polygons, motion_polygons
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Branch, Mechanism
from ....objectives.kinds import ACCELERATION, LENGTH, SPEED
from ...figures.panel_figure import Line, Panel, PanelFigure
from ...render.blocks import (
    Block,
    Table,
    Text,
    Unit,
    Value,
    column,
    dimensions_text,
    heading,
    joined,
    value_from_record,
)
from ...render.numerals import format_number
from ..record_types import Record
from . import AT


class BranchPolygons(Record):
    """Vertices by name, each with x and y, and the rates of the rod."""

    position_mm: dict[str, list[float]]
    velocity_m_s: dict[str, list[float]]
    acceleration_m_s2: dict[str, list[float]]
    rod_velocity_rad_s: float
    rod_acceleration_rad_s2: float


class PolygonNumbers(Record):
    """Kinematic polygons at one crank angle, on both branches."""

    crank_angle_deg: float
    speed_rad_s: float
    """1 if the crank has no speed."""
    acceleration_rad_s2: float
    open: BranchPolygons
    crossed: BranchPolygons


_BRANCHES: tuple[Branch, ...] = ("open", "crossed")
_POLYGONS = (
    ("position", Polygons.POSITION, LENGTH),
    ("velocity", Polygons.VELOCITY, SPEED),
    ("acceleration", Polygons.ACCELERATION, ACCELERATION),
)
_COMMON = {"position": 1, "velocity": 1, "acceleration": 2}  # the last vertex of the crank, which both branches share


def polygons_by_branch(
    linkage: Linkage, crank_angle: float, *, speed: float, acceleration: float
) -> Mapping[Branch, Polygons]:
    """Return the polygons of the linkage on each branch at one crank angle, rad."""
    lengths = (linkage.crank, linkage.rod, linkage.offset)
    return {
        branch: motion_polygons(Linkage(*lengths, branch), crank_angle, speed=speed, acceleration=acceleration)
        for branch in _BRANCHES
    }


def numbers(mechanism: Mechanism, linkage: Linkage, *, crank_angle: float = AT.default) -> PolygonNumbers:
    """Return the vertices at a crank angle, rad, by branch and polygon. Without a crank speed, 1 rad/s applies."""
    speed = mechanism.speed or 1.0
    by_branch = polygons_by_branch(linkage, crank_angle, speed=speed, acceleration=mechanism.acceleration)
    return {
        "crank_angle_deg": math.degrees(crank_angle),
        "speed_rad_s": speed,
        "acceleration_rad_s2": mechanism.acceleration,
        "open": _vertices(by_branch["open"]),
        "crossed": _vertices(by_branch["crossed"]),
    }


def _vertices(drawn: Polygons) -> BranchPolygons:
    position, velocity, acceleration = (
        dict(zip(vertices, (kind.metric.factor * getattr(drawn, name)).tolist(), strict=True))
        for name, vertices, kind in _POLYGONS
    )
    return {
        "position_mm": position,
        "velocity_m_s": velocity,
        "acceleration_m_s2": acceleration,
        "rod_velocity_rad_s": float(drawn.rod_velocity),
        "rod_acceleration_rad_s2": float(drawn.rod_acceleration),
    }


def blocks(numbers: Mapping[str, Any]) -> list[Block]:
    """Return the vertices, one per line, both branches side by side."""
    heads = ("open x", "open y", "crossed x", "crossed y")
    rows: list[tuple[Text, ...]] = []
    for name, vertices, kind in _POLYGONS:
        for vertex in vertices:
            values = [value for branch in _BRANCHES for value in numbers[branch][name + kind.metric.suffix][vertex]]
            cells = (Value(value / kind.metric.factor, kind, digits=5) for value in values)
            rows.append((vertex, *cells, Unit(kind)))
    return [
        heading(
            "Kinematic polygons at {angle}, {speed} rad/s",
            angle=value_from_record(numbers, "crank_angle_deg"),
            speed=Value(numbers["speed_rad_s"]),
        ),
        Table(
            (column("vertex", left=True), *(column(head) for head in heads), column("unit", left=True)),
            tuple(rows),
            ruled=True,
        ),
    ]


def figure(mechanism: Mechanism, linkage: Linkage, *, crank_angle: float = AT.default) -> PanelFigure:
    """Return the polygons at one crank angle, rad; for 1 rad/s if there is no crank speed."""
    speed = mechanism.speed or 1.0
    by_branch = polygons_by_branch(linkage, crank_angle, speed=speed, acceleration=mechanism.acceleration)
    rates = f"{format_number(speed)} rad/s, {format_number(mechanism.acceleration)} rad/s²"
    at = f"crank angle {format_number(math.degrees(crank_angle))}°, {rates}"
    subtitle = joined([dimensions_text(linkage), at], "; ")
    return polygon_panels(by_branch, title="Kinematic polygons", subtitle=subtitle)


def polygon_panels(
    by_branch: Mapping[Branch, Polygons], *, title: Text, subtitle: Text, units: tuple[str, str, str] | None = None
) -> PanelFigure:
    """Return the three polygons as panels with a line for each branch and named vertices.

    units: units of position, velocity and acceleration, for numbers drawn without conversion; None for SI.
    """
    panels = []
    for place, (name, vertices, kind) in enumerate(_POLYGONS):
        lines, names = [], []
        for index, branch in enumerate(by_branch):
            points: np.ndarray = getattr(by_branch[branch], name)
            closed = np.concatenate([points, points[:1]]) if name != "position" else points
            lines.append(Line(branch, closed[:, 0], closed[:, 1], index))
            for number, (vertex, (x, y)) in enumerate(zip(vertices, points, strict=True)):
                if number > _COMMON[name]:
                    names.append((f"{vertex} {branch}", float(x), float(y)))
                elif index == 0:
                    names.append((vertex, float(x), float(y)))
        unit, axis_kind = ("", kind) if units is None else (f", {units[place]}", None)
        panels.append(Panel(f"{name}{unit}", f"x{unit}", tuple(lines), axis_kind, axis_kind, tuple(names), equal=True))
    return PanelFigure(title, subtitle, tuple(panels), columns=3, width=4.6, height=4.2)
