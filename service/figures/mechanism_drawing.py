"""Mechanism drawn to scale for readers: the linkage of `service.drawings`, with annotations."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import System, metric_unit_in
from ..drawings.linkage_shapes import LinkageSizes, fixed_shapes, linkage_sizes, moving_shapes, pin_positions
from ..drawings.shapes import Point
from ..render.numerals import format_length, format_number
from .shape_painting import paint_shapes, set_axes_to_rectangle
from .style import BLUE, INK, MUTED, SMALL, VERMILION


def draw_mechanism(axes: Axes, mechanism: Mechanism, linkage: Linkage, system: System = "metric") -> None:
    """Draw one fully rotating linkage, in mm, at its least transmission angle, with lengths labelled in a unit system.

    The dead centres are outlined in grey. Links with a section have their true width.
    """
    look = linkage_sizes(mechanism, linkage)
    (left, low, right, high), size = look.extent, look.longer_side
    pin, slider = pin_positions(linkage, least_transmission_crank_angle(linkage))
    paint_shapes(axes, [*fixed_shapes(linkage, look, bearing_below=pin[1] > 0.0), *moving_shapes(pin, slider, look)])
    _draw_rotation(axes, look.crank * linkage.sign, mechanism.speed * linkage.sign)
    _draw_transmission_angle(axes, pin, slider, math.degrees(float(linkage.least_transmission_angle)))
    _draw_stroke_dimension(axes, look, size, system)
    _draw_offset_dimension(axes, left, look.offset, size, system)
    draw_scale_bar(axes, left, low - 0.13 * size, size, system)
    set_axes_to_rectangle(axes, left - 0.1 * size, low - 0.17 * size, right + 0.03 * size, high + 0.14 * size)


def least_transmission_crank_angle(linkage: Linkage) -> float:
    """Return the crank angle, rad, at which |sin(phi)| = |e - r sin(theta)| / l is greatest."""
    return math.pi * (0.5 if float(linkage.offset) < 0.0 else 1.5)


def _draw_rotation(axes: Axes, r: float, speed: float) -> None:
    """Show the direction of rotation on the crank circle, on the side away from the slider.

    r, speed: with reversed sign on the crossed branch.
    """
    if not speed:
        return
    start, end = (math.radians(angle) for angle in ((118, 152) if speed > 0.0 else (152, 118)))
    turn = np.linspace(start, end, 20)
    x, y = r * np.cos(turn), abs(r) * np.sin(turn)
    axes.plot(x, y, color=MUTED, linewidth=1.4, zorder=3)
    axes.annotate(
        "",
        xy=(x[-1], y[-1]),
        xytext=(x[-4], y[-4]),
        arrowprops={"arrowstyle": "-|>", "color": MUTED, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0},
        zorder=3,
    )


def _draw_transmission_angle(axes: Axes, pin: Point, slider: Point, degrees: float) -> None:
    """Mark the angle between the rod and the normal to the slider line, at the slider pin."""
    rod_angle = math.degrees(math.atan2(pin[1] - slider[1], pin[0] - slider[0]))
    normal = -90.0 if pin[1] < slider[1] else 90.0
    rod = math.dist(pin, slider)
    radius = 0.42 * rod
    end = slider[1] + math.copysign(1.12 * radius, normal)
    axes.plot([slider[0], slider[0]], [slider[1], end], color=VERMILION, linewidth=0.9, linestyle=":", zorder=6)
    difference = (rod_angle - normal + 180.0) % 360.0 - 180.0
    first, last = sorted((normal, normal + difference))
    axes.add_patch(
        Arc(slider, 2 * radius, 2 * radius, theta1=first, theta2=last, color=VERMILION, linewidth=1.3, zorder=6)
    )
    # Beside the normal, on the side away from the rod, where nothing else is drawn.
    away = 1.0 if pin[0] < slider[0] else -1.0
    at = (slider[0], slider[1] + math.copysign(radius, normal))
    aside = "left" if away > 0.0 else "right"
    _annotate(
        axes, f"{format_number(degrees)}°", at, (5.0 * away, 0.0), VERMILION, ha=aside, va="center", weight="bold"
    )


def _annotate(axes: Axes, text: str, at: Point, away: Point, colour: str, **style: Any) -> None:
    """Write a text at a distance in points from a position."""
    axes.annotate(text, xy=at, xytext=away, textcoords="offset points", fontsize=SMALL, color=colour, zorder=8, **style)


def _draw_stroke_dimension(axes: Axes, look: LinkageSizes, size: float, system: System) -> None:
    """Dimension the stroke on the side of the guide away from the crank pivot."""
    (inner, e), (outer, _) = look.inner, look.outer
    side = 1.0 if e >= 0.0 else -1.0
    y = e + side * (0.9 * look.slider_size + 0.5 * (look.block - look.slider_size) + 0.035 * size)
    for x in (inner, outer):
        axes.plot([x, x], [e, y + side * 0.015 * size], color=BLUE, linewidth=0.6, zorder=2)
    _draw_arrow(axes, (inner, y), (outer, y))
    text, middle = f"stroke {format_length(abs(outer - inner), system)}", (0.5 * (inner + outer), y)
    _annotate(axes, text, middle, (0, 3.0 * side), BLUE, ha="center", va="bottom" if side > 0.0 else "top")


def _draw_offset_dimension(axes: Axes, left: float, e: float, size: float, system: System) -> None:
    """Dimension the offset, unless it is too small for arrows."""
    if abs(e) < 0.06 * size:
        return
    x = left - 0.045 * size
    _draw_arrow(axes, (x, 0.0), (x, e))
    text = f"offset {format_length(e, system)}"
    _annotate(axes, text, (x, 0.5 * e), (-3.0, 0.0), BLUE, ha="right", va="center", rotation=90)


def _draw_arrow(axes: Axes, start: Point, end: Point) -> None:
    style = {"arrowstyle": "<|-|>,head_length=0.35,head_width=0.13", "color": BLUE, "linewidth": 0.8}
    axes.annotate("", xy=end, xytext=start, arrowprops={**style, "shrinkA": 0, "shrinkB": 0}, zorder=6)


def draw_scale_bar(axes: Axes, x: float, y: float, size: float, system: System) -> None:
    """Draw a scale bar with a round length, about a sixth of the picture."""
    unit, factor = metric_unit_in("mm", system)
    longest = size / 6.0 * factor
    power = 10.0 ** math.floor(math.log10(longest))
    displayed = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= longest)
    length = displayed / factor
    axes.plot([x, x + length], [y, y], color=INK, linewidth=2.0, solid_capstyle="butt")
    _annotate(axes, f"{displayed:g} {unit}", (x + length, y), (5, 0), INK, va="center")
