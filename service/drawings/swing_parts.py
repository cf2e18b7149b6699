"""Shapes of a linkage that swings: both ends, ways of its pins, its cylinder, the body on its crank."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.links import Bar
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing, dead_points, placed, require_swing
from . import layers as on
from .parts import Look, axes, bearing, links, look_between, moving, pins_at, rails
from .shapes import Arc, Circle, Layer, Line, Outline, Point, Shape

_MM = 1e3
_BODY = 0.15  # half the side of the body, of the crank


@dataclass(frozen=True)
class Cylinder:
    """A cylinder along the slider line, mm, for show: the job says nothing of it but that it drives.

    side: +1 where it stands beyond the slider along +x, -1 where on the other side. face, foot: ends of its barrel, the
    face towards the slider. width: of the barrel.
    """

    side: float
    face: float
    foot: float
    width: float


@dataclass(frozen=True)
class SwingLook:
    """A linkage that swings as it is drawn. swing: between crank angles. cylinder: None where the crank drives.

    body: mass centre of a crank that the job gives by its mass, along it and across it, mm; None of other cranks.
    """

    linkage: Linkage
    swing: Swing
    look: Look
    cylinder: Cylinder | None
    body: Point | None

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top of everything that stands or moves, about."""
        left, low, right, high = self.look.extent
        if self.cylinder is not None:
            ends = (self.cylinder.face, self.cylinder.foot)
            left, right = min(left, *ends), max(right, *ends)
        return left, low, right, high

    @property
    def below(self) -> bool:
        """Whether the bearing stands below the pivot: away from the crank in the middle of the swing."""
        return math.sin(0.5 * (self.swing.start + self.swing.end)) >= 0.0


def swing_look(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> SwingLook:
    """Return how a linkage that swings is drawn. Raises what `require_swing` raises."""
    own = require_swing(mechanism, linkage, swing)
    swing = placed(mechanism, own, swing)
    turning = [inside for dead in dead_points(own) for inside in swing.inside(dead)]
    ways = [pins_at(own, angle)[1][0] for angle in (swing.start, swing.end, *turning)]
    reach = (min(ways), max(ways))
    body = _body(mechanism, own)
    swept = _swept(own, swing, body)
    look = look_between(mechanism, own, (ways[0], ways[1]), reach, swept)
    cylinder = _cylinder(look) if swing.driver == "slider" else None
    return SwingLook(own, swing, look, cylinder, body)


def _body(mechanism: Mechanism, linkage: Linkage) -> Point | None:
    crank = mechanism.crank
    if isinstance(crank, Bar) or not crank.mass:
        return None
    along = 0.5 * float(linkage.crank) if crank.centre is None else crank.centre
    return _MM * along, _MM * crank.centre_across


def half_body(look: Look) -> float:
    """Return half the side of the body, mm."""
    return _BODY * look.crank


def _swept(linkage: Linkage, swing: Swing, body: Point | None) -> tuple[float, float, float, float]:
    """Return the box of the crank's way and of its body's, mm."""
    r = _MM * float(linkage.crank)
    angles = np.linspace(swing.start, swing.end, 181)
    quarters = [angle for k in range(4) for angle in swing.inside(0.5 * math.pi * k)]
    angles = np.concatenate([angles, quarters])
    x, y = [np.zeros(1), r * np.cos(angles)], [np.zeros(1), r * np.sin(angles)]
    if body is not None:
        half = math.sqrt(2.0) * _BODY * r
        across = body[0] * np.cos(angles) - body[1] * np.sin(angles)
        up = body[0] * np.sin(angles) + body[1] * np.cos(angles)
        x += [across - half, across + half]
        y += [up - half, up + half]
    every = np.concatenate(x), np.concatenate(y)
    return float(every[0].min()), float(every[1].min()), float(every[0].max()), float(every[1].max())


def _cylinder(look: Look) -> Cylinder:
    """Return a cylinder as long as it must be, on the far side of the slider."""
    side = 1.0 if sum(look.reach) >= 0.0 else -1.0
    far = side * look.reach[1 if side > 0.0 else 0]
    face = far + 1.3 * look.block
    long = look.reach[1] - look.reach[0] + 0.6 * look.block
    return Cylinder(side, side * face, side * (face + long), 0.5 * look.block)


def swing_scenery(of: SwingLook) -> list[Shape]:
    """Return axes, ways of the pins, both ends, guide, bearing and the barrel of the cylinder."""
    look, swing = of.look, of.swing
    first, last = sorted(math.degrees(angle) for angle in (swing.start, swing.end))
    ways = (Arc(on.PATHS, (0.0, 0.0), look.crank, first, last), Line(on.PATHS, *((x, look.offset) for x in look.reach)))
    ghosts: list[Shape] = []
    for layer, angle in ((on.START, swing.start), (on.END, swing.end)):
        pin, slider = pins_at(of.linkage, angle)
        ghosts += links((layer,) * 3, pin, slider, look)
        ghosts += [Circle(layer, point, 0.6 * look.pin) for point in (pin, slider)]
        if of.cylinder is not None:
            ghosts.append(_push(layer, slider, of.cylinder, look))
    barrel = [] if of.cylinder is None else _barrel(of.cylinder, look)
    return [*axes(look), *ways, *ghosts, *rails(look), *bearing(look, below=of.below), *barrel]


def swing_moving(of: SwingLook, angle: float) -> list[Shape]:
    """Return the cylinder's rod, the links with their pins and the body at a crank angle, rad."""
    pin, slider = pins_at(of.linkage, angle)
    pushed = [] if of.cylinder is None else [_push(on.ACTUATOR, slider, of.cylinder, of.look)]
    turned = [] if of.body is None else body_shapes(of.body, of.look, angle)
    return [*pushed, *moving(pin, slider, of.look), *turned]


def body_shapes(body: Point, look: Look, angle: float) -> list[Shape]:
    """Return the body on a crank at an angle, rad: a square about its mass centre, with a cross there."""
    half, mark = half_body(look), 0.5 * half_body(look)
    cosine, sine = math.cos(angle), math.sin(angle)

    def at(along: float, across: float) -> Point:
        u, v = body[0] + along, body[1] + across
        return u * cosine - v * sine, u * sine + v * cosine

    corners = tuple(at(u * half, v * half) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return [
        Outline(on.BODY, corners, (0.0, 0.0, 0.0, 0.0)),
        Circle(on.BODY, at(0.0, 0.0), 0.6 * mark),
        Line(on.BODY, at(-mark, 0.0), at(mark, 0.0)),
        Line(on.BODY, at(0.0, -mark), at(0.0, mark)),
    ]


def _push(layer: Layer, slider: Point, of: Cylinder, look: Look) -> Outline:
    """Return the rod of the cylinder, from the slider to the barrel."""
    return box(layer, (slider[0] + of.side * 0.75 * look.block, slider[1]), (of.face, slider[1]), 0.3 * of.width)


def cylinder_parts(of: Cylinder, look: Look) -> tuple[Outline, Outline]:
    """Return the cylinder's rod about the slider pin, whole, and its barrel."""
    near = look.reach[0] if of.side > 0.0 else look.reach[1]
    rod = box(on.ACTUATOR, (of.side * 0.75 * look.block, 0.0), (of.face - near, 0.0), 0.3 * of.width)
    return rod, box(on.ACTUATOR, (of.face, look.offset), (of.foot, look.offset), of.width)


def box(layer: Layer, start: Point, end: Point, width: float) -> Outline:
    """Return a rectangle about a level line."""
    half = 0.5 * width
    corners = (
        (start[0], start[1] - half),
        (end[0], end[1] - half),
        (end[0], end[1] + half),
        (start[0], start[1] + half),
    )
    return Outline(layer, corners, (0.0, 0.0, 0.0, 0.0))


def _barrel(of: Cylinder, look: Look) -> list[Shape]:
    """Return the barrel of the cylinder, and where it is held."""
    y, half = look.offset, 0.8 * of.width
    hatch = [
        Line(on.FRAME, (of.foot, y + k * half), (of.foot + of.side * 0.35 * half, y + (k - 0.35) * half))
        for k in (-0.6, -0.2, 0.2, 0.6, 1.0)
    ]
    wall = Line(on.FRAME, (of.foot, y - half), (of.foot, y + half))
    return [box(on.ACTUATOR, (of.face, y), (of.foot, y), of.width), wall, *hatch]
