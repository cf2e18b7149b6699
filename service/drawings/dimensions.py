"""Dimensions with their graphics: extension lines, dimension line with arrows, and text."""

import math
from dataclasses import dataclass

from ...objectives.kinds import System, metric_unit_in
from ..designs.length_with_tolerance import format_length
from .layers import DIMENSIONS
from .shapes import WIDE, Dimension, Label, Line, Point, Wedge

_ARROW = 1.2  # arrow length relative to text height; a sixth as wide to either side
_GAP, _BEYOND = 0.4, 0.6  # of an extension line: before its point and past the dimension line, relative to text height


@dataclass(frozen=True)
class Lettering:
    """Lettering of dimensions. height: text height, mm. system: unit system."""

    height: float
    system: System = "metric"

    @property
    def display_factor(self) -> float:
        """Conversion factor from mm to the unit in the texts."""
        return metric_unit_in("mm", self.system)[1]


def dimension_along_angle(
    name: str,
    start: Point,
    end: Point,
    through: Point,
    angle: float,
    *,
    look: Lettering,
    tolerance: float = 0.0,
) -> Dimension:
    """Return the dimension between two points along `angle`, deg, with its line through a given point.

    tolerance: tolerance, mm; it sets the digits of the text, five if there is none. If arrows and text do not fit
    between the points, they are drawn outside, with the text beyond the end.
    """
    turn, height = math.radians(angle), look.height
    direction, normal = (math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))
    feet = [_shifted_along(through, direction, _dot(_difference(point, through), direction)) for point in (start, end)]
    if _dot(feet[1], direction) < _dot(feet[0], direction):
        feet.reverse()
        start, end = end, start
    length = _dot(_difference(feet[1], feet[0]), direction)
    displayed, off = look.display_factor * length, look.display_factor * tolerance
    text = format_length(displayed, off)
    wide, arrow = WIDE * height * len(text), _ARROW * height
    fits = length > wide + 2.6 * arrow
    parts: list[Line | Wedge | Label] = []
    for point, foot in zip((start, end), feet, strict=True):
        distance = math.dist(point, foot)
        if distance > _GAP * height:
            unit = ((foot[0] - point[0]) / distance, (foot[1] - point[1]) / distance)
            first, last = _shifted_along(point, unit, _GAP * height), _shifted_along(foot, unit, _BEYOND * height)
            parts.append(Line(DIMENSIONS, first, last))
    side = 1.0 if fits else -1.0
    for foot, out in ((feet[0], side), (feet[1], -side)):
        base = _shifted_along(foot, direction, out * arrow)
        corners = (foot, _shifted_along(base, normal, arrow / 6.0), _shifted_along(base, normal, -arrow / 6.0))
        parts.append(Wedge(DIMENSIONS, corners))
    if fits:
        parts.append(Line(DIMENSIONS, *feet))
        middle = _shifted_along(feet[0], direction, 0.5 * length)
    else:
        parts.append(
            Line(
                DIMENSIONS,
                _shifted_along(feet[0], direction, -2.0 * arrow),
                _shifted_along(feet[1], direction, 2.4 * arrow + wide),
            )
        )
        middle = _shifted_along(feet[1], direction, 2.2 * arrow + 0.5 * wide)
    parts.append(Label(DIMENSIONS, text, _shifted_along(middle, normal, 0.4 * height), height, angle, "middle"))
    return Dimension(DIMENSIONS, name, start, end, through, angle, text, height, tuple(parts), tolerance)


def aligned_dimension(name: str, start: Point, end: Point, away: float, look: Lettering, tolerance: float) -> Dimension:
    """Return the dimension along a link. away: distance of its line to the left of the direction from start to end."""
    x, y = end[0] - start[0], end[1] - start[1]
    length = math.hypot(x, y)
    through = (start[0] - away * y / length, start[1] + away * x / length)
    angle = math.degrees(math.atan2(y, x))
    angle += 180.0 if angle <= -90.0 else -180.0 if angle > 90.0 else 0.0  # keeps texts upright
    return dimension_along_angle(name, start, end, through, angle, look=look, tolerance=tolerance)


def _shifted_along(point: Point, unit: Point, length: float) -> Point:
    return point[0] + length * unit[0], point[1] + length * unit[1]


def _difference(point: Point, origin: Point) -> Point:
    return point[0] - origin[0], point[1] - origin[1]


def _dot(u: Point, v: Point) -> float:
    return u[0] * v[0] + u[1] * v[1]
