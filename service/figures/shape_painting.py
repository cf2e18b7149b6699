"""Shapes of a drawing on matplotlib axes, and a whole drawing as a figure."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from ...model.optional_packages import NamingExtra
from ..drawings import layers as on
from ..drawings.shapes import (
    Arc,
    Circle,
    Dashes,
    Dimension,
    Drawing,
    Label,
    Line,
    Outline,
    Point,
    Shape,
    Wedge,
    outline_sides,
)
from .style import LINK, add_axes, new_figure

with NamingExtra("figures need"):
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Circle as Disc
    from matplotlib.patches import Polygon

_DASHES: dict[Dashes, object] = {
    "continuous": "-",
    "dashed": (0, (4, 2.5)),
    "centre": (0, (9, 2, 1.5, 2)),
    "phantom": (0, (8, 2, 1.5, 2, 1.5, 2)),
}
_FILLED = {on.CRANK.name: LINK, on.ROD.name: LINK, on.SLIDER.name: "#f4f4f4", on.PINS.name: "#ffffff"}
_FILLED |= {on.ACTUATOR.name: "#f4f4f4", on.BODY.name: "none"}
_POINTS = 2.6  # line width, points, for a weight of one
_CAPITALS = 0.729  # ratio of capital height to font size, DejaVu Sans
_WIDTH, _TALLEST = 9.0, 6.4  # inches
_FILLS = 0.97  # fraction of a figure that its drawing fills
_ALIGNED = {"start": "left", "middle": "center", "end": "right"}


def drawing_figure(drawing: Drawing) -> Figure:
    """Return a drawing as a figure, at the same scale in both directions."""
    left, bottom, right, top = drawing.bounds
    width, height = (right - left) / _FILLS, (top - bottom) / _FILLS
    scale = min(_WIDTH / width, _TALLEST / height) * _FILLS  # inches a mm
    figure = new_figure(scale * width, scale * height)
    axes = add_axes(figure, 0.0, 0.0, scale * width, scale * height)
    set_axes_to_rectangle(axes, left, bottom, right, top, share=_FILLS)
    dimensions = [shape for shape in drawing.shapes if isinstance(shape, Dimension)]
    for shapes in (drawing.shapes, *(shape.parts for shape in dimensions)):
        paint_shapes(axes, shapes)
        for label in shapes:
            if isinstance(label, Label):
                axes.text(
                    *label.position,
                    label.text,
                    fontsize=72.0 * scale * label.height / _CAPITALS,
                    color=label.layer.ink,
                    rotation=label.angle,
                    rotation_mode="anchor",
                    ha=_ALIGNED[label.anchor],
                    va="baseline",
                    parse_math=False,
                    zorder=9.0,
                )
    return figure


def set_axes_to_rectangle(
    axes: Axes, left: float, low: float, right: float, high: float, *, share: float = 1.0
) -> None:
    """Show a rectangle in the middle of hidden axes, at the same scale in both directions.

    share: fraction of width or height that it fills.
    """
    box = axes.get_window_extent()
    scale = max((right - left) / box.width, (high - low) / box.height) / share
    for limit, middle, size in (
        (axes.set_xlim, 0.5 * (left + right), box.width),
        (axes.set_ylim, 0.5 * (low + high), box.height),
    ):
        limit(middle - 0.5 * scale * size, middle + 0.5 * scale * size)
    axes.axis("off")


def paint_shapes(axes: Axes, shapes: Iterable[Shape]) -> list[Artist]:
    """Draw lines, circles, outlines and wedges without texts, later ones above earlier ones; return the artists."""
    artists: list[Artist] = []
    for order, shape in enumerate(shapes):
        style: dict[str, Any] = {
            "linewidth": _POINTS * shape.layer.weight,
            "linestyle": _DASHES[shape.layer.dashes],
            "zorder": 2.0 + 0.001 * order + (2.0 if shape.layer.name in _FILLED else 0.0),
        }
        fill = _FILLED.get(shape.layer.name, "none")
        if isinstance(shape, Line):
            x, y = zip(shape.start, shape.end, strict=True)
            artists.append(axes.add_line(Line2D(x, y, color=shape.layer.ink, **style)))
        elif isinstance(shape, Arc):
            x, y = zip(*shape.points, strict=True)
            artists.append(axes.add_line(Line2D(x, y, color=shape.layer.ink, **style)))
        elif isinstance(shape, Circle):
            disc = Disc(shape.centre, shape.radius, facecolor=fill, edgecolor=shape.layer.ink, **style)
            artists.append(axes.add_patch(disc))
        elif isinstance(shape, Outline):
            corners = [point for side in outline_sides(shape) for point in _arc_points(*side)]
            polygon = Polygon(corners, facecolor=fill, edgecolor=shape.layer.ink, **style)
            artists.append(axes.add_patch(polygon))
        elif isinstance(shape, Wedge):
            artists.append(axes.add_patch(Polygon(shape.corners, facecolor=shape.layer.ink, zorder=style["zorder"])))
    return artists


def _arc_points(start: Point, end: Point, bulge: float) -> list[Point]:
    """Return points along a side, except its end."""
    if not bulge:
        return [start]
    # The centre of an arc with the angle 4 atan(bulge) lies to the left of the chord's midpoint.
    chord = (end[0] - start[0], end[1] - start[1])
    aside = (1.0 - bulge * bulge) / (4.0 * bulge)
    centre = (0.5 * (start[0] + end[0]) - aside * chord[1], 0.5 * (start[1] + end[1]) + aside * chord[0])
    radius = math.dist(start, centre)
    first = math.atan2(start[1] - centre[1], start[0] - centre[0])
    angles = first + np.linspace(0.0, 4.0 * math.atan(bulge), 24, endpoint=False)
    return [(centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)) for angle in angles]
