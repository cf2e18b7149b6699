"""Drawing of panels with curves as a figure."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from ...model.arrays import Array
from ...objectives.kinds import System
from ..render.formatting import format_text
from . import style
from .panel_figure import DASHED, DOTS, FAINT, SAMPLES, SOLID, Line, Panel, PanelFigure, panel_in_units

FigureSource = PanelFigure | Figure | Callable[[System], Figure]
"""Panels, a finished figure, or a function that draws one in a unit system when needed."""

GREEN = "#009e73"  # same palette
# Their dashes distinguish them without colour.
_STYLES: dict[int, dict[str, Any]] = {
    0: {"color": style.BLUE, "linewidth": 1.6, "zorder": 3},
    1: {"color": style.VERMILION, "linewidth": 1.5, "linestyle": (0, (5, 2)), "zorder": 3},
    2: {"color": GREEN, "linewidth": 1.5, "linestyle": (0, (7, 2, 1.5, 2)), "zorder": 3},
    3: {"color": style.INK, "linewidth": 1.4, "linestyle": (0, (1.2, 1.5)), "zorder": 3},
    4: {"color": style.MUTED, "linewidth": 1.3, "linestyle": (0, (10, 3)), "zorder": 3},
    SOLID: {"color": style.BLUE, "linewidth": 1.0, "zorder": 3},
    DASHED: {"color": style.INK, "linewidth": 1.1, "linestyle": (0, (4, 2)), "zorder": 3},
    FAINT: {"color": style.MUTED, "linewidth": 0.8, "linestyle": "--", "zorder": 2},
    DOTS: {"color": style.VERMILION, "linestyle": "none", "marker": "o", "markersize": 2.2, "zorder": 4},
    SAMPLES: {"color": style.VERMILION, "linestyle": "none", "marker": "o", "markersize": 2.8, "zorder": 2},
}
_POINTS: dict[str, Any] = {
    **{"color": style.VERMILION, "linestyle": "none", "marker": "o", "markersize": 5.0, "zorder": 4, "clip_on": False},
    **{"markerfacecolor": "white", "markeredgewidth": 1.4},
}
_LEFT, _RIGHT, _FOOT, _HEAD = 0.75, 0.25, 0.5, 0.72  # inches
_GAP, _AXES_GAP = 0.5, 0.9  # between stacked panels, and between panels with separate axes


def draw_panel_figure(figure_panels: PanelFigure, system: System = "metric", *, space_above: float = 0.0) -> Figure:
    """Return the figure for panels in a unit system. space_above: space kept free below the heading, inches."""
    widths = (
        [figure_panels.width] * figure_panels.columns
        if isinstance(figure_panels.width, float)
        else list(figure_panels.width)
    )
    rows = math.ceil(len(figure_panels.panels) / figure_panels.columns)
    tall = figure_panels.height - (_GAP if figure_panels.stacked else _AXES_GAP)
    head = _HEAD + (_GAP - 0.3 if figure_panels.stacked and figure_panels.subtitle else 0.0)
    figure = style.new_figure(sum(widths), rows * figure_panels.height + head + space_above)
    style.write_heading(
        figure, *(format_text(text, system, printed=True) for text in (figure_panels.title, figure_panels.subtitle))
    )
    for index, panel in enumerate(figure_panels.panels):
        row, column = divmod(index, figure_panels.columns)
        left, foot = sum(widths[:column]) + _LEFT, (rows - 1 - row) * figure_panels.height + _FOOT
        axes = style.add_axes(figure, left, foot, widths[column] - _LEFT - _RIGHT, tall)
        draw_panel(axes, panel, system, has_x_title=not figure_panels.stacked or row == rows - 1)
    return figure


def draw_figure(source: FigureSource, system: System = "metric") -> Figure:
    """Return a finished figure unchanged, or draw panels or a function's figure in a unit system."""
    if isinstance(source, Figure):
        return source
    return draw_panel_figure(source, system) if isinstance(source, PanelFigure) else source(system)


def save_figure(source: FigureSource, path: Path, system: System = "metric") -> None:
    """Write the result of `draw_figure` as PNG."""
    style.save_png(draw_figure(source, system), path)


def draw_panel(axes: Axes, panel: Panel, system: System = "metric", *, has_x_title: bool = True) -> None:
    """Draw a panel on axes in a unit system. has_x_title: whether the x axis has its title."""
    panel = panel_in_units(panel, system)
    style.style_axes(axes, most_x_ticks=8)
    for start, end in panel.shaded:
        for shift in (-360.0, 0.0, 360.0) if panel.turns else (0.0,):
            axes.axvspan(start + shift, end + shift, color=style.SHADE, linewidth=0, zorder=0)
    for line in panel.lines:
        axes.plot(line.x, line.y, label=line.label, **(_POINTS if line.points else _STYLES[line.style]))
    if panel.level is not None:
        name, level = panel.level
        axes.axhline(level, color=style.MUTED, linewidth=1.1, linestyle=(0, (6, 2, 1, 2)), label=name)
    _scale_axes(axes, panel)
    _name_points(axes, panel)
    ink = style.VERMILION if any(line.points for line in panel.lines) else style.MUTED
    style.title_panel(axes, str(panel.title), str(panel.note), ink)
    axes.tick_params(labelbottom=has_x_title)
    if has_x_title:
        axes.set_xlabel(str(panel.x_title), fontsize=style.TEXT)
    named = [line.label for line in panel.lines if line.label]
    if len(named) + (panel.level is not None) > 1:
        axes.legend(
            **{"loc": "lower right", "bbox_to_anchor": (1.01, 0.99), "ncols": len(named) + 1, "frameon": False},
            **{"fontsize": style.SMALL, "handlelength": 2.6, "columnspacing": 1.2, "borderaxespad": 0.2},
        )


_PLACES = tuple(
    (distance * x, distance * y)
    for distance in (5.0, 14.0)
    for x, y in ((1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1.2), (0, -1.2), (1.2, 0), (-1.2, 0))
)
"""Candidate label positions, in points from the labelled point; the first is used unless another is clearer."""


def _name_points(axes: Axes, panel: Panel) -> None:
    """Write each name beside its point, where it overlaps least with other names and lines."""
    if not panel.names:
        return
    axes.apply_aspect()
    drawn = np.concatenate([axes.transData.transform(_dense_points(line)) for line in panel.lines])
    label_boxes: list[Bbox] = []
    for text, x, y in panel.names:
        axes.plot(x, y, marker="o", markersize=2.6, color=style.INK, zorder=5)
        best: tuple[float, Annotation] | None = None
        for place_x, place_y in _PLACES:
            label = axes.annotate(
                text,
                xy=(x, y),
                xytext=(place_x, place_y),
                textcoords="offset points",
                ha="left" if place_x > 0.0 else "right" if place_x < 0.0 else "center",
                va="bottom" if place_y > 0.0 else "top" if place_y < 0.0 else "center",
                fontsize=style.SMALL,
                color=style.INK,
                zorder=6,
            )
            box = label.get_window_extent()
            covered = int(box.count_contains(drawn))
            outside = not (axes.bbox.x0 <= box.x0 and box.x1 <= axes.bbox.x1)
            cost = covered + 1000.0 * outside + sum(1000.0 for other_box in label_boxes if box.overlaps(other_box))
            if best is None or cost < best[0]:
                if best is not None:
                    best[1].remove()
                best = (cost, label)
            else:
                label.remove()
        assert best is not None
        label_boxes.append(best[1].get_window_extent())


def _dense_points(line: Line) -> Array:
    """Return closely spaced points (m, 2) along a line."""
    at = np.linspace(0.0, len(line.x) - 1.0, 60 * len(line.x))
    index = np.arange(len(line.x))
    return np.stack([np.interp(at, index, line.x), np.interp(at, index, line.y)], axis=1)


def _scale_axes(axes: Axes, panel: Panel) -> None:
    if panel.equal:
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.12)
        return
    values = np.concatenate([*(line.y for line in panel.lines), [] if panel.level is None else [panel.level[1]]])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    if low < 0.0 < high:
        axes.axhline(0.0, color=style.FRAME, linewidth=0.8, zorder=1)
    axes.set_ylim(style.padded_limits(low, high))
    ends = np.concatenate([line.x for line in panel.lines])
    left, right = float(ends.min()), float(ends.max())
    if any(line.points for line in panel.lines) and not panel.turns:
        axes.set_xlim(style.padded_limits(left, right, 0.03))
    elif right > left:
        axes.set_xlim(left, right)
    if panel.turns:
        axes.set_xticks(np.arange(0.0, right + 1.0, 45.0 if right - left <= 400.0 else 90.0))
