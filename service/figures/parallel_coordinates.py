"""Parallel coordinates: dimensions and objectives of every design on a front, one line per design."""

import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ...objectives.kinds import System, count_with_noun
from ...optimise.front.front import ParetoFront
from ..render.numerals import format_on_scale
from .design_marks import Axis, dimension_axes, marked_designs, objective_axis
from .style import FRAME, INK, MUTED, SMALL, TEXT, add_axes, colour_map, new_figure, padded_limits, write_heading

_DASHES = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5)), (0, (8, 2)), (0, (2.5, 1)))
_STEP, _HEIGHT, _SIDE = 1.45, 4.1, 0.75  # inches: between axes, along the axes, beside them


def parallel_coordinates(front: ParetoFront, system: System = "metric") -> Figure:
    """Return the parallel coordinates of a front with at least one design, in a unit system."""
    dimensions = dimension_axes(front, system)
    objectives = [objective_axis(front, objective, system) for objective in front.objectives]
    axes = dimensions + objectives
    marked = marked_designs(front)
    columns = max(2, min(4, len(axes) - 2))
    foot = 0.45 + 0.2 * -(-len(marked) // columns)
    width = 2.0 * _SIDE + _STEP * (len(axes) - 1)
    titles = [textwrap.wrap(axis.title, 16) for axis in axes]
    head = 0.24 + 0.15 * max(len(lines) for lines in titles)
    figure = new_figure(width, foot + _HEIGHT + head + 1.0)
    panel = add_axes(figure, _SIDE, foot, width - 2.0 * _SIDE, _HEIGHT)
    panel.set_xlim(0, len(axes) - 1)
    panel.set_ylim(0, 1)
    panel.axis("off")

    ends = [_axis_ends(axis) for axis in axes]
    heights = np.stack(
        [(axis.values - low) / (high - low) for axis, (low, high) in zip(axes, ends, strict=True)], axis=1
    )
    lines = np.stack([np.broadcast_to(np.arange(len(axes)), heights.shape), heights], axis=2)
    first = objectives[0].values
    order = np.argsort(first)
    panel.add_collection(
        LineCollection(
            list(lines[order]),
            array=first[order],
            cmap=colour_map(),
            linewidths=1.0 if len(front) <= 150 else 0.6,
            alpha=0.75,
            zorder=1,
        ),
        autolim=False,
    )
    handles = []
    for number, mark in enumerate(marked):
        style = {
            **mark.style,
            "color": mark.colour,
            "linewidth": 1.5,
            "linestyle": _DASHES[number % len(_DASHES)],
            "markersize": 0.7 * mark.size,
            "clip_on": False,
        }
        handles += panel.plot(np.arange(len(axes)), heights[mark.row], zorder=3, **style)
    for position, axis in enumerate(axes):
        _draw_axis(panel, position, axis, "\n".join(titles[position]))
    heading_text = "objectives, up is better" if all(axis.better for axis in objectives) else "objectives"
    top = 1.0 + (head + 0.08) / _HEIGHT
    _name_axes_group(panel, 0, len(dimensions) - 1, top, "dimensions")
    _name_axes_group(panel, len(dimensions), len(axes) - 1, top, heading_text)
    figure.legend(
        handles,
        [mark.label for mark in marked],
        loc="lower center",
        ncols=columns,
        fontsize=SMALL,
        frameon=False,
        handlelength=4.0,
        columnspacing=2.0,
    )
    text = f"Pareto front, {count_with_noun(len(front), 'design')}; lines coloured by "
    write_heading(figure, front.problem.name, text + objectives[0].title.split(",")[0], left=0.2)
    return figure


def _axis_ends(axis: Axis) -> tuple[float, float]:
    """Return the values at the lower and the upper end; for objectives the better end is up."""
    low, high = padded_limits(axis.values.min(), axis.values.max(), 0.0 if axis.values_vary else 0.5)
    return (high, low) if axis.better < 0 else (low, high)


def _draw_axis(panel: Axes, position: int, axis: Axis, title: str) -> None:
    panel.plot([position, position], [0, 1], color=FRAME, linewidth=1.2, zorder=2, clip_on=False)
    low, high = _axis_ends(axis)
    if axis.values_vary:
        locator = MaxNLocator(6, steps=[1, 2, 2.5, 5, 10])
        ticks = np.asarray(locator.tick_values(min(low, high), max(low, high)))
    else:
        ticks = axis.values[:1]
    for tick in ticks:
        at = (tick - low) / (high - low)
        if not -1e-9 <= at <= 1.0 + 1e-9:
            continue
        panel.plot([position - 0.03, position], [at, at], color=FRAME, linewidth=1.0, zorder=2, clip_on=False)
        panel.text(
            position - 0.05,
            at if axis.values_vary else at + 0.012,  # all lines meet if there is only one value
            format_on_scale(tick, low, high, digits=6 if axis.values_vary else 4),
            ha="right",
            va="center" if axis.values_vary else "bottom",
            fontsize=SMALL,
            color=INK,
            zorder=4,
            bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.6},
        )
    if axis.values_vary:
        ends: dict[str, Any] = {"ha": "center", "fontsize": SMALL, "color": MUTED}
        panel.text(position, -0.025, format_on_scale(low, low, high), va="top", **ends)
        panel.text(position, 1.025, format_on_scale(high, low, high), va="bottom", **ends)
    panel.text(position, 1.0 + 0.24 / _HEIGHT, title, ha="center", va="bottom", fontsize=TEXT)


def _name_axes_group(panel: Axes, first: int, last: int, at: float, title: str) -> None:
    """Name a group of axes above their titles."""
    ends = [first - 0.35, last + 0.35]
    panel.plot(ends, [at, at], color=FRAME, linewidth=0.8, clip_on=False)
    middle = 0.5 * (first + last)
    panel.text(middle, at + 0.012, title, ha="center", va="bottom", fontsize=SMALL, color=MUTED)
