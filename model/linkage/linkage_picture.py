"""Picture of a linkage at one crank angle, as SVG for notebooks and as a matplotlib figure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH, _HEIGHT, _MARGIN = 320.0, 180.0, 18.0  # px in the SVG


@dataclass(frozen=True)
class Pose:
    """Pins at a crank angle, and ends of the stroke on the slider line, m; NaN if there are none."""

    pin: tuple[float, float]
    slider: tuple[float, float]
    stroke: tuple[float, float]

    def drawing_bounds(self, crank: float) -> tuple[float, float, float, float]:
        """Return left, right, bottom and top of the whole drawing."""
        xs = [x for x in (self.slider[0], *self.stroke) if math.isfinite(x)]
        return min(-crank, *xs), max(crank, *xs), min(-crank, self.slider[1]), max(crank, self.slider[1])


def svg(pose: Pose, crank: float, label: str) -> str:
    """Return a linkage as a self-contained SVG element. label: text read aloud in place of the picture."""
    left, right, bottom, top = pose.drawing_bounds(crank)
    scale = min((_WIDTH - 2.0 * _MARGIN) / (right - left), (_HEIGHT - 2.0 * _MARGIN) / (top - bottom))
    x0 = 0.5 * (_WIDTH - scale * (left + right))
    y0 = 0.5 * (_HEIGHT + scale * (bottom + top))

    def to_pixels(point: tuple[float, float]) -> tuple[str, str]:
        return f"{x0 + scale * point[0]:.1f}", f"{y0 - scale * point[1]:.1f}"

    def line(start: tuple[float, float], end: tuple[float, float], style: str) -> str:
        (x, y), (u, v) = to_pixels(start), to_pixels(end)
        return f'<line x1="{x}" y1="{y}" x2="{u}" y2="{v}" {style}/>'

    (ox, oy), (sx, sy) = to_pixels((0.0, 0.0)), to_pixels(pose.slider)
    line_style, thick_style = (
        'stroke="#999" stroke-dasharray="4 3"',
        'stroke="currentColor" stroke-width="3" stroke-linecap="round"',
    )
    parts = [f'<circle cx="{ox}" cy="{oy}" r="{scale * crank:.1f}" fill="none" {line_style}/>']
    if all(math.isfinite(x) for x in pose.stroke):
        ends = [(x, pose.slider[1]) for x in pose.stroke]
        parts.append(line(ends[0], ends[1], line_style))
    parts.append(line((0.0, 0.0), pose.pin, thick_style) + line(pose.pin, pose.slider, thick_style))
    parts.append(
        f'<rect x="{float(sx) - 11:.1f}" y="{float(sy) - 7:.1f}" width="22" height="14" fill="none" '
        'stroke="currentColor" stroke-width="2"/>'
    )
    parts += [
        f'<circle cx="{x}" cy="{y}" r="4" fill="currentColor"/>' for x, y in map(to_pixels, ((0.0, 0.0), pose.pin))
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{escape(label)}" '
        f'width="{_WIDTH:g}" height="{_HEIGHT:g}" viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}">{"".join(parts)}</svg>'
    )


def figure(pose: Pose, crank: float, label: str) -> Figure:
    """Return a linkage as a matplotlib figure, in mm."""
    from ..notebook_figure import NotebookFigure

    picture = NotebookFigure(figsize=(6.4, 3.6), layout="constrained")
    axes = picture.subplots()
    turn = [2.0 * math.pi * share / 180.0 for share in range(181)]
    axes.plot([1e3 * crank * math.cos(t) for t in turn], [1e3 * crank * math.sin(t) for t in turn], "--", color="0.6")
    y = 1e3 * pose.slider[1]
    axes.plot([1e3 * x for x in pose.stroke], [y, y], "--", color="0.6")
    path = ((0.0, 0.0), pose.pin, pose.slider)
    axes.plot([1e3 * x for x, _ in path], [1e3 * v for _, v in path], "o-", color="C0", linewidth=3)
    axes.plot([1e3 * pose.slider[0]], [y], "s", color="C0", markersize=14, fillstyle="none")
    axes.set(xlabel="x, mm", ylabel="y, mm", title=label, aspect="equal")
    return picture
