"""Shapes of a swinging linkage: both ends, paths of its pins, its cylinder, the body on its crank."""

import math
from dataclasses import dataclass

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.links_and_joints import Bar
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing, dead_point_angles, require_swing, swing_between_crank_angles
from . import layers as on
from .linkage_shapes import (
    LinkageSizes,
    centre_lines,
    crank_bearing,
    guide_rails,
    link_shapes,
    linkage_sizes_between,
    moving_shapes,
    pin_positions,
)
from .shapes import Arc, Circle, Layer, Line, Outline, Point, Shape

_MM = 1e3
_BODY = 0.15  # half the side of the body, relative to the crank


@dataclass(frozen=True)
class Cylinder:
    """Schematic cylinder on the slider line, mm: the job states only that it drives.

    side: +1 if it lies beyond the slider along +x, -1 on the other side. face, foot: ends of its barrel, the face
    towards the slider. width: width of the barrel.
    """

    side: float
    near_end: float
    foot: float
    width: float


@dataclass(frozen=True)
class SwingSizes:
    """Sizes of a drawn swinging linkage. swing: swing between crank angles. cylinder: None if the crank drives.

    body: mass centre of a crank with a given mass, along and across the crank, mm; None for other cranks.
    """

    linkage: Linkage
    swing: Swing
    look: LinkageSizes
    cylinder: Cylinder | None
    body: Point | None

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Approximate left, bottom, right and top of all fixed and moving parts."""
        left, low, right, high = self.look.extent
        if self.cylinder is not None:
            ends = (self.cylinder.near_end, self.cylinder.foot)
            left, right = min(left, *ends), max(right, *ends)
        return left, low, right, high

    @property
    def is_bearing_below(self) -> bool:
        """Whether the bearing stands below the pivot: away from the crank at mid-swing."""
        return math.sin(0.5 * (self.swing.start + self.swing.end)) >= 0.0


def swing_sizes(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> SwingSizes:
    """Return the drawn sizes of a swinging linkage. Raises the errors of `require_swing`."""
    checked = require_swing(mechanism, linkage, swing)
    swing = swing_between_crank_angles(mechanism, checked, swing)
    turning = [
        dead_angle for dead in dead_point_angles(checked) for dead_angle in swing.equal_angles_within_swing(dead)
    ]
    ways = [pin_positions(checked, angle)[1][0] for angle in (swing.start, swing.end, *turning)]
    slider_range = (min(ways), max(ways))
    body = _body_centre(mechanism, checked)
    swept = _swept_box(checked, swing, body)
    look = linkage_sizes_between(mechanism, checked, (ways[0], ways[1]), slider_range, swept)
    cylinder = _cylinder_beyond_slider(look) if swing.driver == "slider" else None
    return SwingSizes(checked, swing, look, cylinder, body)


def _body_centre(mechanism: Mechanism, linkage: Linkage) -> Point | None:
    crank = mechanism.crank
    if isinstance(crank, Bar) or not crank.mass:
        return None
    centre_along = 0.5 * float(linkage.crank) if crank.centre is None else crank.centre
    return _MM * centre_along, _MM * crank.centre_across


def half_body_side(look: LinkageSizes) -> float:
    """Return half the side of the body's square, mm."""
    return _BODY * look.crank


def _swept_box(linkage: Linkage, swing: Swing, body: Point | None) -> tuple[float, float, float, float]:
    """Return the box around the paths of the crank and its body, mm."""
    r = _MM * float(linkage.crank)
    angles = np.linspace(swing.start, swing.end, 181)
    quarters = [angle for k in range(4) for angle in swing.equal_angles_within_swing(0.5 * math.pi * k)]
    angles = np.concatenate([angles, quarters])
    x, y = [np.zeros(1), r * np.cos(angles)], [np.zeros(1), r * np.sin(angles)]
    if body is not None:
        half = math.sqrt(2.0) * _BODY * r
        x_centre = body[0] * np.cos(angles) - body[1] * np.sin(angles)
        y_centre = body[0] * np.sin(angles) + body[1] * np.cos(angles)
        x += [x_centre - half, x_centre + half]
        y += [y_centre - half, y_centre + half]
    every = np.concatenate(x), np.concatenate(y)
    return float(every[0].min()), float(every[1].min()), float(every[0].max()), float(every[1].max())


def _cylinder_beyond_slider(look: LinkageSizes) -> Cylinder:
    """Return a cylinder of the required length, on the far side of the slider."""
    side = 1.0 if sum(look.slider_range) >= 0.0 else -1.0
    far = side * look.slider_range[1 if side > 0.0 else 0]
    near_end = far + 1.3 * look.block
    long = look.slider_range[1] - look.slider_range[0] + 0.6 * look.block
    return Cylinder(side, side * near_end, side * (near_end + long), 0.5 * look.block)


def fixed_swing_shapes(drawn: SwingSizes) -> list[Shape]:
    """Return axes, paths of the pins, both ends, guide, bearing and the barrel of the cylinder."""
    look, swing = drawn.look, drawn.swing
    first, last = sorted(math.degrees(angle) for angle in (swing.start, swing.end))
    ways = (
        Arc(on.PATHS, (0.0, 0.0), look.crank, first, last),
        Line(on.PATHS, *((x, look.offset) for x in look.slider_range)),
    )
    ghosts: list[Shape] = []
    for layer, angle in ((on.START, swing.start), (on.END, swing.end)):
        pin, slider = pin_positions(drawn.linkage, angle)
        ghosts += link_shapes((layer,) * 3, pin, slider, look)
        ghosts += [Circle(layer, pin, 0.6 * look.pins[1]), Circle(layer, slider, 0.6 * look.pins[2])]
        if drawn.cylinder is not None:
            ghosts.append(_piston_rod(layer, slider, drawn.cylinder, look))
    barrel = [] if drawn.cylinder is None else _barrel(drawn.cylinder, look)
    return [
        *centre_lines(look),
        *ways,
        *ghosts,
        *guide_rails(look),
        *crank_bearing(look, is_below_pivot=drawn.is_bearing_below),
        *barrel,
    ]


def moving_swing_shapes(drawn: SwingSizes, angle: float) -> list[Shape]:
    """Return the cylinder's rod, the links with their pins, and the body at a crank angle, rad."""
    pin, slider = pin_positions(drawn.linkage, angle)
    pushed = [] if drawn.cylinder is None else [_piston_rod(on.ACTUATOR, slider, drawn.cylinder, drawn.look)]
    turned = [] if drawn.body is None else body_shapes(drawn.body, drawn.look, angle)
    return [*pushed, *moving_shapes(pin, slider, drawn.look), *turned]


def body_shapes(body: Point, look: LinkageSizes, angle: float) -> list[Shape]:
    """Return the body on a crank at an angle, rad: a square around its mass centre, marked by a cross."""
    half, mark = half_body_side(look), 0.5 * half_body_side(look)
    cosine, sine = math.cos(angle), math.sin(angle)

    def rotated(dx: float, dy: float) -> Point:
        u, v = body[0] + dx, body[1] + dy
        return u * cosine - v * sine, u * sine + v * cosine

    corners = tuple(rotated(u * half, v * half) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return [
        Outline(on.BODY, corners, (0.0, 0.0, 0.0, 0.0)),
        Circle(on.BODY, rotated(0.0, 0.0), 0.6 * mark),
        Line(on.BODY, rotated(-mark, 0.0), rotated(mark, 0.0)),
        Line(on.BODY, rotated(0.0, -mark), rotated(0.0, mark)),
    ]


def _piston_rod(layer: Layer, slider: Point, cylinder: Cylinder, look: LinkageSizes) -> Outline:
    """Return the rod of the cylinder, from the slider to the barrel."""
    return rectangle_around_horizontal_line(
        layer,
        (slider[0] + cylinder.side * 0.75 * look.block, slider[1]),
        (cylinder.near_end, slider[1]),
        0.3 * cylinder.width,
    )


def piston_rod_and_barrel(cylinder: Cylinder, look: LinkageSizes) -> tuple[Outline, Outline]:
    """Return the cylinder's complete rod relative to the slider pin, and its barrel."""
    near = look.slider_range[0] if cylinder.side > 0.0 else look.slider_range[1]
    rod = rectangle_around_horizontal_line(
        on.ACTUATOR, (cylinder.side * 0.75 * look.block, 0.0), (cylinder.near_end - near, 0.0), 0.3 * cylinder.width
    )
    return rod, rectangle_around_horizontal_line(
        on.ACTUATOR, (cylinder.near_end, look.offset), (cylinder.foot, look.offset), cylinder.width
    )


def rectangle_around_horizontal_line(layer: Layer, start: Point, end: Point, width: float) -> Outline:
    """Return a rectangle around a horizontal line."""
    half = 0.5 * width
    corners = (
        (start[0], start[1] - half),
        (end[0], end[1] - half),
        (end[0], end[1] + half),
        (start[0], start[1] + half),
    )
    return Outline(layer, corners, (0.0, 0.0, 0.0, 0.0))


def _barrel(cylinder: Cylinder, look: LinkageSizes) -> list[Shape]:
    """Return the barrel of the cylinder and its mount."""
    y, half = look.offset, 0.8 * cylinder.width
    hatch = [
        Line(
            on.FRAME,
            (cylinder.foot, y + k * half),
            (cylinder.foot + cylinder.side * 0.35 * half, y + (k - 0.35) * half),
        )
        for k in (-0.6, -0.2, 0.2, 0.6, 1.0)
    ]
    wall = Line(on.FRAME, (cylinder.foot, y - half), (cylinder.foot, y + half))
    return [
        rectangle_around_horizontal_line(on.ACTUATOR, (cylinder.near_end, y), (cylinder.foot, y), cylinder.width),
        wall,
        *hatch,
    ]
