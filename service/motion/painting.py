"""Shapes of a drawing on axes of matplotlib."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle as Disc
from matplotlib.patches import Polygon

from ..drawings import layers as on
from ..drawings.shapes import Circle, Dashes, Line, Outline, Point, Shape, pairs
from ..figures.style import LINK

_DASHES: dict[Dashes, object] = {
    "continuous": "-",
    "dashed": (0, (4, 2.5)),
    "centre": (0, (9, 2, 1.5, 2)),
    "phantom": (0, (8, 2, 1.5, 2, 1.5, 2)),
}
_FILLED = {on.CRANK.name: LINK, on.ROD.name: LINK, on.SLIDER.name: "#f4f4f4", on.PINS.name: "#ffffff"}
_POINTS = 2.6  # line width, points, of a weight of one


def paint(axes: Axes, shapes: Iterable[Shape]) -> list[Artist]:
    """Draw lines, circles and outlines, later ones above earlier ones; return what was drawn."""
    found: list[Artist] = []
    for place, shape in enumerate(shapes):
        style = {
            "linewidth": _POINTS * shape.layer.weight,
            "linestyle": _DASHES[shape.layer.dashes],
            "zorder": 2.0 + 0.001 * place + (2.0 if shape.layer.name in _FILLED else 0.0),
        }
        fill = _FILLED.get(shape.layer.name, "none")
        if isinstance(shape, Line):
            x, y = zip(shape.start, shape.end, strict=True)
            found.append(axes.add_line(Line2D(x, y, color=shape.layer.ink, **style)))
        elif isinstance(shape, Circle):
            disc = Disc(shape.centre, shape.radius, facecolor=fill, edgecolor=shape.layer.ink, **style)  # type: ignore[arg-type]
            found.append(axes.add_patch(disc))
        elif isinstance(shape, Outline):
            corners = [point for side in pairs(shape) for point in _along(*side)]
            polygon = Polygon(corners, facecolor=fill, edgecolor=shape.layer.ink, **style)  # type: ignore[arg-type]
            found.append(axes.add_patch(polygon))
    return found


def _along(start: Point, end: Point, bulge: float) -> list[Point]:
    """Return points along a side, its end left out."""
    if not bulge:
        return [start]
    # The centre of an arc of the angle 4 atan(bulge) lies to the left of the chord's middle.
    chord = (end[0] - start[0], end[1] - start[1])
    aside = (1.0 - bulge * bulge) / (4.0 * bulge)
    centre = (0.5 * (start[0] + end[0]) - aside * chord[1], 0.5 * (start[1] + end[1]) + aside * chord[0])
    radius = math.dist(start, centre)
    first = math.atan2(start[1] - centre[1], start[0] - centre[0])
    angles = first + np.linspace(0.0, 4.0 * math.atan(bulge), 24, endpoint=False)
    return [(centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)) for angle in angles]
