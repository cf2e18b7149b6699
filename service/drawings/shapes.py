"""Elements of a drawing: lines, circles, outlines, labels and dimensions on layers, in millimetres, y upward."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Literal

Point = tuple[float, float]
Dashes = Literal["continuous", "dashed", "centre", "phantom"]
Anchor = Literal["start", "middle", "end"]

WIDE = 0.85
"""Approximate ratio of character width to capital height in the wider common fonts."""


@dataclass(frozen=True)
class Layer:
    """Layer. title: its content. ink: colour, #rrggbb. number: colour in CAD. weight: line width, mm on paper."""

    name: str
    title: str
    dashes: Dashes
    ink: str
    number: int
    weight: float


@dataclass(frozen=True)
class Line:
    """A straight line."""

    layer: Layer
    start: Point
    end: Point


@dataclass(frozen=True)
class Circle:
    """A circle."""

    layer: Layer
    centre: Point
    radius: float


@dataclass(frozen=True)
class Arc:
    """Circular arc, counter-clockwise from start to end, deg."""

    layer: Layer
    centre: Point
    radius: float
    start: float
    end: float

    def point_at(self, angle: float) -> Point:
        """Return the point at an angle, deg."""
        turn = math.radians(angle)
        return self.centre[0] + self.radius * math.cos(turn), self.centre[1] + self.radius * math.sin(turn)

    @property
    def points(self) -> list[Point]:
        """Points along the arc, at most a degree apart."""
        count = max(1, math.ceil(self.end - self.start))
        return [self.point_at(self.start + (self.end - self.start) * k / count) for k in range(count + 1)]


@dataclass(frozen=True)
class Outline:
    """Closed outline. bulges: bulge of the side after each corner; 0 is straight, 1 a semicircle to the left."""

    layer: Layer
    corners: tuple[Point, ...]
    bulges: tuple[float, ...]


@dataclass(frozen=True)
class Wedge:
    """A filled triangle."""

    layer: Layer
    corners: tuple[Point, Point, Point]


@dataclass(frozen=True)
class Label:
    """Line of text at a point. height: height of capitals. angle: angle of the text line, deg."""

    layer: Layer
    text: str
    position: Point
    height: float
    angle: float = 0.0
    anchor: Anchor = "start"


@dataclass(frozen=True)
class Dimension:
    """Distance between two points along a direction, with its graphics.

    name: name of the length. angle: angle of the dimension line, deg. through: point on that line. tolerance:
    tolerance, mm, 0 for none. parts: its lines, arrows and text; CAD redraws them when a point is moved.
    """

    layer: Layer
    name: str
    start: Point
    end: Point
    through: Point
    angle: float
    text: str
    height: float
    parts: tuple[Line | Wedge | Label, ...] = field(repr=False)
    tolerance: float = 0.0

    @property
    def length(self) -> float:
        """Measured distance, mm."""
        direction = (math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle)))
        return abs((self.end[0] - self.start[0]) * direction[0] + (self.end[1] - self.start[1]) * direction[1])


Shape = Line | Circle | Arc | Outline | Wedge | Label | Dimension


@dataclass(frozen=True)
class Drawing:
    """Drawing. size: reference length for line types and texts, mm. notes: notes on the drawing."""

    layers: tuple[Layer, ...]
    shapes: tuple[Shape, ...]
    size: float
    title: str
    notes: tuple[str, ...]

    def shapes_on_layer(self, name: str) -> list[Shape]:
        """Return the shapes on a layer."""
        return [shape for shape in self.shapes if shape.layer.name == name]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top of all shapes."""
        x, y = zip(*(point for shape in self.shapes for point in _extreme_points(shape)), strict=True)
        return min(x), min(y), max(x), max(y)


def outline_sides(outline: Outline) -> Iterator[tuple[Point, Point, float]]:
    """Yield the sides of an outline as start, end and bulge."""
    corners = outline.corners
    yield from zip(corners, (*corners[1:], corners[0]), outline.bulges, strict=True)


def _extreme_points(shape: Shape) -> Iterable[Point]:
    if isinstance(shape, Line):
        return shape.start, shape.end
    if isinstance(shape, Circle):
        (x, y), r = shape.centre, shape.radius
        return (x - r, y - r), (x + r, y + r)
    if isinstance(shape, Arc):
        return shape.points
    if isinstance(shape, Outline):
        return [point for side in outline_sides(shape) for point in _box_corners(*side)]
    if isinstance(shape, Wedge):
        return shape.corners
    if isinstance(shape, Dimension):
        return [point for part in shape.parts for point in _extreme_points(part)]
    long, turn = WIDE * shape.height * len(shape.text), math.radians(shape.angle)
    back = {"start": 0.0, "middle": 0.5, "end": 1.0}[shape.anchor] * long
    corners = [(u - back, v) for u in (0.0, long) for v in (-0.3 * shape.height, shape.height)]
    return [
        (
            shape.position[0] + u * math.cos(turn) - v * math.sin(turn),
            shape.position[1] + u * math.sin(turn) + v * math.cos(turn),
        )
        for u, v in corners
    ]


def _box_corners(start: Point, end: Point, bulge: float) -> tuple[Point, ...]:
    """Return the corners of a box around a side; for an arc, at most the box of its semicircle."""
    if not bulge:
        return start, end
    half = 0.5 * math.dist(start, end)
    x, y = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    return (x - half, y - half), (x + half, y + half)
