"""A linkage as a drawing: in one position, its dead centres, its paths and its dimensions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...model.links import Bar, Link
from . import layers as on
from .dimensions import dimension
from .shapes import Circle, Drawing, Label, Layer, Line, Outline, Point, Shape

if TYPE_CHECKING:
    from ...model.linkage import Linkage
    from ...model.mechanism import Mechanism

CRANK_ANGLE = math.radians(60.0)
"""Where a linkage is drawn unless asked otherwise."""
_TEXT = 0.022  # height of dimensions and notes, of the drawing's size


@dataclass(frozen=True)
class _Shown:
    """Widths of crank and rod, height of the slider and radius of pins, mm: for show unless `own`."""

    crank: float
    rod: float
    block: float
    pin: float
    own: bool


def linkage_drawing(
    mechanism: Mechanism, linkage: Linkage, *, name: str, number: int | None = None, crank_angle: float = CRANK_ANGLE
) -> Drawing:
    """Return one fully turning linkage at true scale, mm: crank pivot at (0, 0), slider line at y = offset.

    Pivots, paths, dead centres and dimensions are exact. Links that the machine describes by their section have their
    true width; other widths, pins and slider are for show, in proportion. name, number: of run and design, for the
    title. crank_angle: where it is drawn, rad. Raises `AssemblyError` for a linkage that does not turn fully.
    """
    r, l, e = (1e3 * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    inner, outer = ((1e3 * float(x), e) for x in linkage.dead_centres)
    at_inner, at_outer = (float(angle) for angle in linkage.dead_centre_angles)
    shown = _proportions(mechanism, r, l, e, abs(outer[0]))
    pivot: Point = (0.0, 0.0)
    pin, slider = _pins(linkage, crank_angle)
    left = min(-r, *(end - shown.block for end in (inner[0], outer[0])))
    right = max(r, *(end + shown.block for end in (inner[0], outer[0])))
    low, high = min(-r, e - shown.block), max(r, e + shown.block)
    size = max(right - left, high - low)

    shapes: list[Shape] = [
        *(Line(on.AXES, (left - 0.03 * size, y), (right + 0.03 * size, y)) for y in dict.fromkeys((0.0, e))),
        Circle(on.PATHS, pivot, r),
        Line(on.PATHS, inner, outer),
        *_ghost(on.INNER, (r * math.cos(at_inner), r * math.sin(at_inner)), inner, shown),
        *_ghost(on.OUTER, (r * math.cos(at_outer), r * math.sin(at_outer)), outer, shown),
        *_frame(inner[0], outer[0], e, shown, below=pin[1] >= 0.0),
        _block(on.SLIDER, slider, shown.block),
        _bar(on.ROD, pin, slider, shown.rod),
        _bar(on.CRANK, pivot, pin, shown.crank),
        *(Circle(on.PINS, point, shown.pin) for point in (pivot, pin, slider)),
        Line(on.SKELETON, pivot, pin),
        Line(on.SKELETON, pin, slider),
        *_dimensions(pin, slider, inner, outer, left=left, shown=shown, height=_TEXT * size),
    ]
    title = f"{name}, design {number}" if number is not None else name
    notes = _notes(linkage, crank_angle, (at_inner, at_outer), shown)
    bottom = min(Drawing((), tuple(shapes), size, "", ()).bounds[1], low)
    y = bottom - 0.06 * size
    shapes.append(Label(on.NOTES, title, (left, y), 1.2 * _TEXT * size))
    shapes += [
        Label(on.NOTES, note, (left, y - (1.5 * line + 0.3) * _TEXT * size), 0.75 * _TEXT * size)
        for line, note in enumerate(notes, 1)
    ]
    return Drawing(on.LAYERS, tuple(shapes), size, title, notes)


def _proportions(mechanism: Mechanism, r: float, l: float, e: float, outer: float) -> _Shown:
    usual = min(0.05 * (l + r), 0.5 * r)
    crank, rod = (_width(link, usual) for link in (mechanism.crank, mechanism.rod))
    block = max(0.16 * (r + max(r, abs(e))), 0.05 * (outer + r))
    own = any(isinstance(link, Bar) for link in (mechanism.crank, mechanism.rod))
    return _Shown(crank, rod, block, min(0.28 * min(crank, rod), 0.25 * block, 0.25 * r), own)


def _width(link: Link, usual: float) -> float:
    return 1e3 * link.width if isinstance(link, Bar) else usual


def _pins(linkage: Linkage, angle: float) -> tuple[Point, Point]:
    """Return crank pin and slider pin."""
    r = 1e3 * float(linkage.crank)
    x = 1e3 * float(linkage.at(angle).slider_position)
    return (r * math.cos(angle), r * math.sin(angle)), (x, 1e3 * float(linkage.offset))


def _bar(layer: Layer, start: Point, end: Point, width: float) -> Outline:
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


def _block(layer: Layer, pin: Point, height: float) -> Outline:
    x, y = 0.75 * height, 0.5 * height
    corners = tuple((pin[0] + u * x, pin[1] + v * y) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return Outline(layer, corners, (0.0, 0.0, 0.0, 0.0))


def _ghost(layer: Layer, pin: Point, slider: Point, shown: _Shown) -> list[Shape]:
    """Return the linkage in another position, pins as small circles."""
    return [
        _block(layer, slider, shown.block),
        _bar(layer, pin, slider, shown.rod),
        _bar(layer, (0.0, 0.0), pin, shown.crank),
        Circle(layer, pin, 0.6 * shown.pin),
        Circle(layer, slider, 0.6 * shown.pin),
    ]


def _frame(inner: float, outer: float, e: float, shown: _Shown, *, below: bool) -> list[Shape]:
    """Return the rails of the guide, hatched, and the bearing of the crank, on the side away from its pin."""
    shapes: list[Shape] = []
    start, end = min(inner, outer) - 0.95 * shown.block, max(inner, outer) + 0.95 * shown.block
    for side in (-1.0, 1.0):
        y = e + side * 0.52 * shown.block
        shapes.append(Line(on.FRAME, (start, y), (end, y)))
        pitch = 0.2 * shown.block
        count = min(200, int((end - start) / pitch))
        shapes += [
            Line(on.FRAME, (start + k * pitch, y), (start + (k - 1) * pitch, y + side * pitch))
            for k in range(1, count + 1)
        ]
    foot = 1.5 * max(shown.pin, 0.3 * shown.crank)
    y = -2.0 * foot if below else 2.0 * foot
    shapes += [Line(on.FRAME, (0.0, 0.0), (x, y)) for x in (-foot, foot)]
    shapes.append(Line(on.FRAME, (-1.8 * foot, y), (1.8 * foot, y)))
    return shapes


def _dimensions(
    pin: Point, slider: Point, inner: Point, outer: Point, *, left: float, shown: _Shown, height: float
) -> list[Shape]:
    """Return the dimensions of crank and rod beside them, of the offset at the left, of the stroke beyond the rest."""
    e, r = slider[1], math.hypot(*pin)
    side = -1.0 if pin[1] >= 0.0 else 1.0  # away from crank and rod
    crank = (pin[0], pin[1])
    rod = (slider[0] - pin[0], slider[1] - pin[1])
    # Crank and rod on the outside of the bend between them.
    bend = -1.0 if crank[0] * rod[1] - crank[1] * rod[0] > 0.0 else 1.0
    away = {"crank": 0.5 * shown.crank + 2.2 * height, "rod": 0.5 * shown.rod + 2.2 * height}
    y = side * (max(r + 0.5 * shown.crank, side * e + 0.72 * shown.block) + 3.0 * height)
    found: list[Shape] = [
        _aligned("crank", (0.0, 0.0), pin, bend * away["crank"], height),
        _aligned("rod", pin, slider, bend * away["rod"], height),
        dimension("stroke", inner, outer, (inner[0], y), 0.0, height=height),
    ]
    if e:
        x = left - 3.0 * height
        found.append(dimension("offset", (left, 0.0), (left, e), (x, 0.0), 90.0, height=height))
    return found


def _aligned(name: str, start: Point, end: Point, away: float, height: float) -> Shape:
    """Return the dimension of a link along it. away: of its line, to the left of the way from start to end."""
    x, y = end[0] - start[0], end[1] - start[1]
    length = math.hypot(x, y)
    through = (start[0] - away * y / length, start[1] + away * x / length)
    angle = math.degrees(math.atan2(y, x))
    angle += 180.0 if angle <= -90.0 else -180.0 if angle > 90.0 else 0.0  # so that texts are not upside down
    return dimension(name, start, end, through, angle, height=height)


def _notes(linkage: Linkage, angle: float, dead: tuple[float, float], shown: _Shown) -> tuple[str, ...]:
    lengths = [
        f"{name} {1e3 * float(value):.7g} mm"
        for name, value in (
            ("crank", linkage.crank),
            ("rod", linkage.rod),
            ("offset", linkage.offset),
            ("stroke", linkage.stroke),
        )
    ]
    inner, outer = (f"{math.degrees(item):.6g}" for item in dead)
    widths = "Widths of links are those of the job; slider and pins are for show."
    return (
        f"{', '.join(lengths)}; {linkage.branch} branch.",
        f"Drawn at crank angle {math.degrees(angle):.6g} deg; "
        f"dead centres at {inner} deg (inner) and {outer} deg (outer).",
        "True scale in millimetres; pivots are exact.",
        widths if shown.own else "Widths of links, slider and pins are for show.",
    )
