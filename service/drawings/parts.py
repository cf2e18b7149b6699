"""Shapes of a linkage in a position, and of its fixed surroundings: in mm, on their layers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...model.machine.links import Bar, Link
from . import layers as on
from .shapes import Circle, Layer, Line, Outline, Point, Shape

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

_MM = 1e3
_FEET = 200  # hatching lines of a rail at most


@dataclass(frozen=True)
class Proportions:
    """Widths of crank and rod, height of the slider and radius of pins, mm.

    own: whether a link is described by its section, so that its width is true; everything else is for show.
    """

    crank: float
    rod: float
    block: float
    pin: float
    own: bool


@dataclass(frozen=True)
class Sizes:
    """Dimensions of a fully turning linkage, mm. inner, outer: slider pins at the dead centres."""

    crank: float
    rod: float
    offset: float
    inner: Point
    outer: Point


def sizes_of(linkage: Linkage) -> Sizes:
    """Return the dimensions of a linkage. Raises `AssemblyError` for one that does not turn fully."""
    r, l, e = (_MM * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    inner, outer = ((_MM * float(x), e) for x in linkage.dead_centres)
    return Sizes(r, l, e, inner, outer)


def proportions(mechanism: Mechanism, sizes: Sizes) -> Proportions:
    """Return how wide the parts of a machine are drawn."""
    r, l, e = sizes.crank, sizes.rod, abs(sizes.offset)
    usual = min(0.05 * (l + r), 0.5 * r)
    crank, rod = (_width(link, usual) for link in (mechanism.crank, mechanism.rod))
    block = max(0.16 * (r + max(r, e)), 0.05 * (abs(sizes.outer[0]) + r))
    own = any(isinstance(link, Bar) for link in (mechanism.crank, mechanism.rod))
    return Proportions(crank, rod, block, min(0.28 * min(crank, rod), 0.25 * block, 0.25 * r), own)


def _width(link: Link, usual: float) -> float:
    return _MM * link.width if isinstance(link, Bar) else usual


def pins_at(linkage: Linkage, angle: float) -> tuple[Point, Point]:
    """Return crank pin and slider pin at a crank angle, rad."""
    r, x = _MM * float(linkage.crank), _MM * float(linkage.at(angle).slider_position)
    return (r * math.cos(angle), r * math.sin(angle)), (x, _MM * float(linkage.offset))


def moving(pin: Point, slider: Point, shown: Proportions) -> list[Shape]:
    """Return slider, rod and crank with their pins where crank pin and slider pin are."""
    pivot: Point = (0.0, 0.0)
    return [
        block(on.SLIDER, slider, shown.block),
        bar(on.ROD, pin, slider, shown.rod),
        bar(on.CRANK, pivot, pin, shown.crank),
        *(Circle(on.PINS, point, shown.pin) for point in (pivot, pin, slider)),
    ]


def extent(sizes: Sizes, shown: Proportions) -> tuple[float, float, float, float]:
    """Return left, bottom, right and top of what a turn sweeps over, about."""
    r, ends, half = sizes.crank, (sizes.inner[0], sizes.outer[0]), 0.5 * shown.crank
    return (
        min(-r - half, *(x - 0.95 * shown.block for x in ends)),
        min(-r - half, sizes.offset - 0.72 * shown.block),
        max(r + half, *(x + 0.95 * shown.block for x in ends)),
        max(r + half, sizes.offset + 0.72 * shown.block),
    )


def scenery(linkage: Linkage, sizes: Sizes, shown: Proportions, *, below: bool) -> list[Shape]:
    """Return axes, paths, both dead centres, guide and bearing. below: whether the bearing stands below the pivot."""
    left, bottom, right, top = extent(sizes, shown)
    beyond = 0.03 * max(right - left, top - bottom)
    ends = (left - beyond, right + beyond)
    axes = [Line(on.AXES, (ends[0], y), (ends[1], y)) for y in dict.fromkeys((0.0, sizes.offset))]
    paths = (Circle(on.PATHS, (0.0, 0.0), sizes.crank), Line(on.PATHS, sizes.inner, sizes.outer))
    ghosts: list[Shape] = []
    for layer, angle, end in zip(
        (on.INNER, on.OUTER), linkage.dead_centre_angles, (sizes.inner, sizes.outer), strict=True
    ):
        r = sizes.crank
        ghosts += _ghost(layer, (r * math.cos(angle), r * math.sin(angle)), end, shown)
    return [*axes, *paths, *ghosts, *_rails(sizes, shown), *_bearing(shown, below=below)]


def bar(layer: Layer, start: Point, end: Point, width: float) -> Outline:
    """Return a round-ended outline about two pivots."""
    length = math.dist(start, end)
    x, y = (0.5 * width * (end[0] - start[0]) / length, 0.5 * width * (end[1] - start[1]) / length)
    corners = (
        (start[0] + y, start[1] - x),
        (end[0] + y, end[1] - x),
        (end[0] - y, end[1] + x),
        (start[0] - y, start[1] + x),
    )
    return Outline(layer, corners, (0.0, 1.0, 0.0, 1.0))


def block(layer: Layer, pin: Point, height: float) -> Outline:
    """Return the outline of a slider about its pin."""
    x, y = 0.75 * height, 0.5 * height
    corners = tuple((pin[0] + u * x, pin[1] + v * y) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return Outline(layer, corners, (0.0, 0.0, 0.0, 0.0))


def _ghost(layer: Layer, pin: Point, slider: Point, shown: Proportions) -> list[Shape]:
    """Return the linkage in another position, pins as small circles."""
    return [
        block(layer, slider, shown.block),
        bar(layer, pin, slider, shown.rod),
        bar(layer, (0.0, 0.0), pin, shown.crank),
        Circle(layer, pin, 0.6 * shown.pin),
        Circle(layer, slider, 0.6 * shown.pin),
    ]


def _rails(sizes: Sizes, shown: Proportions) -> list[Shape]:
    """Return the guide of the slider, hatched."""
    shapes: list[Shape] = []
    ends = (sizes.inner[0], sizes.outer[0])
    start, end = min(ends) - 0.95 * shown.block, max(ends) + 0.95 * shown.block
    for side in (-1.0, 1.0):
        y = sizes.offset + side * 0.52 * shown.block
        shapes.append(Line(on.FRAME, (start, y), (end, y)))
        pitch = max(0.2 * shown.block, (end - start) / _FEET)
        shapes += [
            Line(on.FRAME, (start + k * pitch, y), (start + (k - 1) * pitch, y + side * pitch))
            for k in range(1, int((end - start) / pitch) + 1)
        ]
    return shapes


def _bearing(shown: Proportions, *, below: bool) -> list[Shape]:
    foot = 1.5 * max(shown.pin, 0.3 * shown.crank)
    y = -2.0 * foot if below else 2.0 * foot
    legs = [Line(on.FRAME, (0.0, 0.0), (x, y)) for x in (-foot, foot)]
    return [*legs, Line(on.FRAME, (-1.8 * foot, y), (1.8 * foot, y))]
