"""A mechanism drawn to scale: pivots, crank circle, links, slider in its guide, dead centres, transmission angle."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Arc, Circle, Polygon, Rectangle
from numpy.typing import NDArray

from ...model.linkage.linkage import Linkage
from ...model.machine.links import Bar, Link
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import System, shown_in
from .style import BLUE, FRAME, GHOST, INK, LINK, MUTED, SMALL, VERMILION, shown

_MM = 1e3
Array = NDArray[np.float64]


def draw_mechanism(axes: Axes, mechanism: Mechanism, linkage: Linkage, system: System = "metric") -> None:
    """Draw one fully turning linkage, in mm, where its transmission angle is least; its lengths are told in a system.

    The dead centres are outlined in grey. Links described by their section have their true width.
    """
    r, l, e = (_MM * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    inner, outer = (_MM * float(x) for x in linkage.dead_centres)
    reach = max(r, abs(e))
    block = max(0.16 * (r + reach), 0.05 * (abs(outer) + r))  # height of the slider
    left, right = min(-r, inner - block, outer - block), max(r, inner + block, outer + block)
    low, high = min(-r, e - block), max(r, e + block)
    size = max(right - left, high - low)

    _guide(axes, inner, outer, e, block)
    axes.add_patch(Circle((0, 0), r, fill=False, edgecolor=GHOST, linewidth=0.9, linestyle=(0, (4, 3))))
    _centre_lines(axes, left, right, e, size)
    widths = (_width(mechanism.crank, l + r), _width(mechanism.rod, l + r))
    for angle in linkage.dead_centre_angles:
        pin, slider = _pins(linkage, float(angle))
        for start, end, width in (((0.0, 0.0), pin, widths[0]), (pin, slider, widths[1])):
            outline = _bar(start, end, width)
            axes.add_patch(Polygon(outline, fill=False, edgecolor=GHOST, linewidth=0.8, zorder=2))
        axes.add_patch(_slider(slider, block, fill=False, edgecolor=GHOST, linewidth=0.8, zorder=2))

    pin, slider = _pins(linkage, least_transmission_crank_angle(linkage))
    solid: dict[str, Any] = {"edgecolor": INK, "linewidth": 1.1}
    axes.add_patch(_slider(slider, block, facecolor="#f4f4f4", zorder=3, **solid))
    axes.add_patch(Polygon(_bar(pin, slider, widths[1]), facecolor=LINK, zorder=4, **solid))
    axes.add_patch(Polygon(_bar((0.0, 0.0), pin, widths[0]), facecolor=LINK, zorder=5, **solid))
    _ground(axes, math.copysign(0.045 * size, -pin[1]))
    for point in ((0.0, 0.0), pin, slider):
        axes.add_patch(Circle(point, 0.011 * size, facecolor="white", zorder=7, **solid))
    _rotation(axes, r * linkage.sign, mechanism.speed * linkage.sign)
    _transmission_angle(axes, pin, slider, math.degrees(float(linkage.least_transmission_angle)))
    _stroke(axes, inner, outer, e, block, size, system)
    _offset(axes, left, e, size, system)
    _scale(axes, left, low - 0.13 * size, size, system)
    _frame(axes, left - 0.1 * size, right + 0.03 * size, low - 0.17 * size, high + 0.14 * size)


def least_transmission_crank_angle(linkage: Linkage) -> float:
    """Return the crank angle, rad, where |sin(phi)| = |e - r sin(theta)| / l is greatest."""
    return math.pi * (0.5 if float(linkage.offset) < 0.0 else 1.5)


def _frame(axes: Axes, left: float, right: float, low: float, high: float) -> None:
    """Show at least this rectangle, in the middle, at the same scale in both directions."""
    box = axes.get_window_extent()
    scale = max((right - left) / box.width, (high - low) / box.height)
    for limit, start, end, size in (
        (axes.set_xlim, left, right, box.width),
        (axes.set_ylim, low, high, box.height),
    ):
        middle, half = 0.5 * (start + end), 0.5 * scale * size
        limit(middle - half, middle + half)
    axes.axis("off")


def _pins(linkage: Linkage, angle: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return crank pin and slider pin, mm."""
    r = _MM * float(linkage.crank)
    x = _MM * float(linkage.at(angle).slider_position)
    return (r * math.cos(angle), r * math.sin(angle)), (x, _MM * float(linkage.offset))


def _width(link: Link, total: float) -> float:
    """Return the width of a link, mm: its own, or a share of both lengths if it has none."""
    return _MM * link.width if isinstance(link, Bar) else 0.05 * total


def _bar(start: tuple[float, float], end: tuple[float, float], width: float) -> Array:
    """Return the outline of a round-ended bar."""
    direction = math.atan2(end[1] - start[1], end[0] - start[0])
    turn = np.linspace(0.5 * math.pi, 1.5 * math.pi, 25) + direction
    half = 0.5 * width * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return np.concatenate([np.asarray(start) + half, np.asarray(end) - half])


def _slider(pin: tuple[float, float], height: float, **style: object) -> Rectangle:
    return Rectangle(
        (pin[0] - 0.75 * height, pin[1] - 0.5 * height),
        1.5 * height,
        height,
        **style,  # type: ignore[arg-type]
    )


def _guide(axes: Axes, inner: float, outer: float, e: float, block: float) -> None:
    start, end = min(inner, outer) - 1.1 * block, max(inner, outer) + 1.1 * block
    for side in (-1.0, 1.0):
        y = e + side * 0.54 * block
        axes.plot([start, end], [y, y], color=FRAME, linewidth=1.2, zorder=1)
        pitch = 0.22 * block
        feet = np.arange(start + pitch, end + 1e-9, pitch)
        strokes = np.stack(
            [
                np.stack([feet, np.full_like(feet, y)], axis=1),
                np.stack([feet - pitch, np.full_like(feet, y + side * pitch)], axis=1),
            ],
            axis=1,
        )
        axes.add_collection(LineCollection(list(strokes), colors=GHOST, linewidths=0.6, zorder=1), autolim=False)


def _centre_lines(axes: Axes, left: float, right: float, e: float, size: float) -> None:
    for y in {0.0, e} if abs(e) > 0.02 * size else {e}:  # close together they look like one heavy line
        axes.plot(
            [left - 0.05 * size, right],
            [y, y],
            color=GHOST,
            linewidth=0.7,
            linestyle=(0, (9, 2, 1.5, 2)),
            zorder=1,
        )


def _ground(axes: Axes, size: float) -> None:
    """Draw the frame's bearing at the crank pivot, above it for a positive size and below for a negative one."""
    foot = np.array([[0.0, 0.0], [-0.6 * size, size], [0.6 * size, size]])
    axes.add_patch(Polygon(foot, facecolor="white", edgecolor=INK, linewidth=1.0, zorder=6))
    axes.plot([-0.9 * size, 0.9 * size], [size, size], color=INK, linewidth=1.3, zorder=6)


def _rotation(axes: Axes, r: float, speed: float) -> None:
    """Show the direction of rotation on the crank circle, away from the slider.

    r, speed: with the sign turned on the crossed branch.
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


def _transmission_angle(axes: Axes, pin: tuple[float, float], slider: tuple[float, float], degrees: float) -> None:
    """Mark the angle between the rod and the normal of the slider line, at the slider pin."""
    along = math.degrees(math.atan2(pin[1] - slider[1], pin[0] - slider[0]))
    normal = -90.0 if pin[1] < slider[1] else 90.0
    rod = math.dist(pin, slider)
    radius = 0.42 * rod
    end = slider[1] + math.copysign(1.12 * radius, normal)
    axes.plot([slider[0], slider[0]], [slider[1], end], color=VERMILION, linewidth=0.9, linestyle=":", zorder=6)
    difference = (along - normal + 180.0) % 360.0 - 180.0
    first, last = sorted((normal, normal + difference))
    axes.add_patch(
        Arc(slider, 2 * radius, 2 * radius, theta1=first, theta2=last, color=VERMILION, linewidth=1.3, zorder=6)
    )
    # Beside the normal, on the side away from the rod, where nothing else is drawn.
    away = 1.0 if pin[0] < slider[0] else -1.0
    axes.annotate(
        f"{shown(degrees)}°",
        xy=(slider[0], slider[1] + math.copysign(radius, normal)),
        xytext=(5.0 * away, 0.0),
        textcoords="offset points",
        ha="left" if away > 0.0 else "right",
        va="center",
        fontsize=SMALL,
        color=VERMILION,
        weight="bold",
        zorder=8,
    )


def _stroke(axes: Axes, inner: float, outer: float, e: float, block: float, size: float, system: System) -> None:
    """Dimension the stroke on the side of the guide that is away from the crank pivot."""
    side = 1.0 if e >= 0.0 else -1.0
    y = e + side * (0.9 * block + 0.035 * size)
    for x in (inner, outer):
        axes.plot([x, x], [e, y + side * 0.015 * size], color=BLUE, linewidth=0.6, zorder=2)
    _arrow(axes, (inner, y), (outer, y))
    axes.annotate(
        f"stroke {_length(abs(outer - inner), system)}",
        xy=(0.5 * (inner + outer), y),
        xytext=(0, 3.0 * side),
        textcoords="offset points",
        ha="center",
        va="bottom" if side > 0.0 else "top",
        fontsize=SMALL,
        color=BLUE,
    )


def _offset(axes: Axes, left: float, e: float, size: float, system: System) -> None:
    """Dimension the offset, unless it is too small to draw arrows in."""
    if abs(e) < 0.06 * size:
        return
    x = left - 0.045 * size
    _arrow(axes, (x, 0.0), (x, e))
    axes.annotate(
        f"offset {_length(e, system)}",
        xy=(x, 0.5 * e),
        xytext=(-3.0, 0.0),
        textcoords="offset points",
        ha="right",
        va="center",
        rotation=90,
        fontsize=SMALL,
        color=BLUE,
    )


def _length(millimetres: float, system: System) -> str:
    unit, factor = shown_in("mm", system)
    return f"{shown(millimetres * factor)} {unit}"


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    style = {"arrowstyle": "<|-|>,head_length=0.35,head_width=0.13", "color": BLUE, "linewidth": 0.8}
    axes.annotate("", xy=end, xytext=start, arrowprops={**style, "shrinkA": 0, "shrinkB": 0}, zorder=6)


def _scale(axes: Axes, x: float, y: float, size: float, system: System) -> None:
    """Draw a scale bar of a round length, about a sixth of the picture."""
    unit, factor = shown_in("mm", system)
    most = size / 6.0 * factor
    power = 10.0 ** math.floor(math.log10(most))
    told = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most)
    length = told / factor
    axes.plot([x, x + length], [y, y], color=INK, linewidth=2.0, solid_capstyle="butt")
    axes.annotate(
        f"{told:g} {unit}",
        xy=(x + length, y),
        xytext=(5, 0),
        textcoords="offset points",
        va="center",
        fontsize=SMALL,
        color=INK,
    )
