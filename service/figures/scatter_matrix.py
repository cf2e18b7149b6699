"""Scatter matrix: every pair of objectives of a front, coloured by one of them."""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...objectives.kinds import System, count_with_noun
from ...optimise.front.front import ParetoFront
from .design_marks import Axis, Mark, dimension_axes, marked_designs, objective_axis, with_better_arrow
from .style import (
    INK,
    SMALL,
    TEXT,
    add_axes,
    add_legend,
    colour_map,
    new_figure,
    padded_limits,
    style_axes,
    write_heading,
)

MOST = 6
"""Maximum number of drawn objectives: with more, the panels are too small to read."""

_LEFT, _BOTTOM, _TOP, _RIGHT, _GAP = 0.95, 0.75, 0.7, 0.3, 0.18  # inches


def scatter_matrix(front: ParetoFront, system: System = "metric") -> Figure:
    """Return the scatter matrix of a front with at least two objectives and one design, in a unit system."""
    axes = [objective_axis(front, objective, system) for objective in front.objectives[:MOST]]
    marked = marked_designs(front)
    count = len(axes) - 1
    if count == 1:
        colour = max(
            dimension_axes(front, system), key=lambda axis: np.ptp(axis.values) / (np.abs(axis.values).max() or 1.0)
        )
        return _single_panel(front, axes, colour, marked)
    side = max(1.55, min(2.6, 8.4 / count))
    size = _LEFT + count * side + (count - 1) * _GAP + _RIGHT
    figure = new_figure(size, size - _LEFT - _RIGHT + _BOTTOM + _TOP)
    labels = [with_better_arrow(axis.title, axis.better) for axis in axes]
    for panel, x_column, y_column in triangle_of_panels(
        figure, labels, left=_LEFT, bottom=_BOTTOM, side=side, gap=_GAP
    ):
        points = _draw_panel(panel, axes[x_column], axes[y_column], axes[0].values, marked)
    # The empty upper right holds legend and colour scale. From five objectives on, two panels one above the other are
    # free.
    x = _LEFT + (2 if count > 3 else 1) * (side + _GAP) + 2.0 * _GAP
    y = _BOTTOM + (count - 1) * (side + _GAP) + side
    _draw_colour_bar(figure, points, axes[0].title, x, y - 0.45)
    _draw_legend(figure, marked, x, y - 0.75)
    _draw_heading(figure, front, len(front.objectives))
    return figure


def triangle_of_panels(
    figure: Figure, labels: Sequence[str], *, left: float, bottom: float, side: float, gap: float
) -> Iterator[tuple[Axes, int, int]]:
    """Yield empty panels, each with the label indices of its x and y axes; label the outer panels once drawn.

    left, bottom: position of the first panel in the lowest row. side: side of a panel. gap: gap between panels. All in
    inches.
    """
    count = len(labels) - 1
    for row in range(count):
        for column in range(row + 1):
            panel = add_axes(
                figure, left + column * (side + gap), bottom + (count - 1 - row) * (side + gap), side, side
            )
            yield panel, column, row + 1
            panel.tick_params(labelleft=column == 0, labelbottom=row == count - 1)
            if column == 0:
                panel.set_ylabel(labels[row + 1], fontsize=SMALL)
            if row == count - 1:
                panel.set_xlabel(labels[column], fontsize=SMALL)


def _single_panel(front: ParetoFront, axes: list[Axis], colour: Axis, marked: list[Mark]) -> Figure:
    """Return the only panel for two objectives, coloured by the dimension that varies most."""
    figure = new_figure(8.8, 5.2)
    panel = add_axes(figure, _LEFT, _BOTTOM, 4.9, 5.2 - _BOTTOM - _TOP)
    points = _draw_panel(panel, axes[0], axes[1], colour.values, marked)
    panel.set_xlabel(with_better_arrow(axes[0].title, axes[0].better), fontsize=TEXT)
    panel.set_ylabel(with_better_arrow(axes[1].title, axes[1].better), fontsize=TEXT)
    x, y = _LEFT + 5.2, 5.2 - _TOP
    _draw_colour_bar(figure, points, colour.title, x, y - 0.45)
    _draw_legend(figure, marked, x, y - 0.75)
    _draw_heading(figure, front, 2)
    return figure


def _draw_panel(panel: Axes, x_axis: Axis, y_axis: Axis, colour: np.ndarray, marked: list[Mark]) -> PathCollection:
    style_axes(panel)
    points = panel.scatter(
        x_axis.values,
        y_axis.values,
        c=colour,
        cmap=colour_map(),
        s=16,
        linewidths=0.3,
        edgecolors=INK,
        zorder=2,
    )
    for mark in marked:
        panel.plot(x_axis.values[mark.row], y_axis.values[mark.row], **mark.style, zorder=3)
    panel.set_xlim(padded_limits(x_axis.values.min(), x_axis.values.max()))
    panel.set_ylim(padded_limits(y_axis.values.min(), y_axis.values.max()))
    return points


def _draw_colour_bar(figure: Figure, points: PathCollection, title: str, x: float, y: float) -> None:
    bar = add_axes(figure, x, y, 2.2, 0.13)
    figure.colorbar(points, cax=bar, orientation="horizontal")
    style_axes(bar, most_x_ticks=4)
    bar.yaxis.set_visible(False)
    bar.grid(False)
    bar.spines[:].set_visible(False)
    bar.set_title(title, fontsize=SMALL, color=INK, loc="left", pad=4)


def _draw_legend(figure: Figure, marked: list[Mark], x: float, y: float) -> None:
    handles = [Line2D([], [], **mark.style) for mark in marked]
    add_legend(figure, x, y, handles, ["\n".join(mark.labels) for mark in marked], spacing=0.6)


def _draw_heading(figure: Figure, front: ParetoFront, objectives: int) -> None:
    text = f"Pareto front, {count_with_noun(len(front), 'design')}"
    if objectives > MOST:
        text += f"; the first {MOST} of {objectives} objectives"
    write_heading(figure, front.problem.name, text, left=0.2)
