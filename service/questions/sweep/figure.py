"""Sweeps as figures: lines over one parameter, filled contours over two."""

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ....model.arrays import Array
from ....objectives.kinds import System, metric_unit_in
from ....objectives.quantity import Quantity
from ....objectives.tables.sensitivity import Axis
from ....optimise.front.saved_front import is_constant
from ...figures.style import (
    BLUE,
    MUTED,
    SHADE,
    TEXT,
    add_axes,
    colour_map,
    new_figure,
    padded_limits,
    style_axes,
    title_panel,
    write_heading,
)
from ...render.numerals import title_with_unit

MOST = 6
"""Maximum number of drawn quantities."""
_LEVELS = 12
_WIDTH, _SIDE = 5.4, 2.6  # inches: width of a two-parameter panel with its scale, and height of any panel


def column_of(axis: Axis) -> str:
    """Return the table column for an axis."""
    return "speed_rpm" if axis.parameter == "speed" else f"{axis.parameter}_mm"


def sweep_grid(table: pd.DataFrame, axes: Sequence[Axis], item: Quantity) -> tuple[list[Array], Array]:
    """Return the values of each axis as displayed, ascending, and the quantity's values over them; NaN if missing."""
    shape = [len(axis.values) for axis in axes]
    values = table[item.field].to_numpy(dtype=np.float64).reshape(shape)
    values = np.where(np.isfinite(values), values, np.nan)
    grids = []
    for n, axis in enumerate(axes):
        axis_values = np.moveaxis(table[column_of(axis)].to_numpy(dtype=np.float64).reshape(shape), n, 0)
        first = axis_values.reshape(shape[n], -1)[:, 0]
        order = np.argsort(first, kind="stable")
        grids.append(first[order])
        values = np.take(values, order, axis=n)
    return grids, values


def sweep_figure(
    table: pd.DataFrame, axes: Sequence[Axis], quantities: Sequence[Quantity], *, title: str, system: System = "metric"
) -> Figure:
    """Return the figure of a sweep over one or two axes: a panel for each quantity, at most six.

    An axis with a single value is stated in the heading and not drawn. system: unit system of the figure.
    """
    items = list(quantities)[:MOST]
    drawn = [n for n, axis in enumerate(axes) if len(axis.values) > 1] or [0]
    columns = 2 if len(items) > 1 else 1
    rows = -(-len(items) // columns)
    figure = new_figure(0.4 + _WIDTH * columns, 0.75 + (_SIDE + 0.85) * rows)
    height = figure.get_size_inches()[1]
    names = " and ".join(axes[n].parameter for n in drawn)
    titles = [_axis_title(axis, system) for axis in axes]
    fixed_values = [
        f"{name} = {table[column_of(axis)].iloc[0] * factor:.6g}"
        for n, (axis, (name, factor)) in enumerate(zip(axes, titles, strict=True))
        if n not in drawn
    ]
    write_heading(
        figure, textwrap.shorten(title, 60, placeholder=" ..."), "; ".join([f"sweep over {names}", *fixed_values])
    )
    for n, item in enumerate(items):
        left, foot = 0.95 + _WIDTH * (n % columns), height - 0.95 - _SIDE - (_SIDE + 0.85) * (n // columns)
        grids, values = sweep_grid(table, axes, item)
        grids = [grid * factor for grid, (_, factor) in zip(grids, titles, strict=True)]
        symbol, factor = metric_unit_in(item.unit.symbol, system)
        values = factor * values.reshape([len(grids[k]) for k in drawn])
        panel = add_axes(figure, left, foot, _WIDTH - (1.15 if len(drawn) == 1 else 1.75), _SIDE)
        style_axes(panel)
        panel.set_xlabel(titles[drawn[0]][0], fontsize=TEXT)
        missing, note = np.isnan(values), ""
        if missing.all():
            nowhere: Any = {"transform": panel.transAxes, "ha": "center", "color": MUTED, "fontsize": TEXT}
            panel.text(0.5, 0.5, "no value anywhere", **nowhere)
        elif len(drawn) == 1:
            _draw_line(panel, grids[drawn[0]], values)
            note = "shaded: no value"
        else:
            scale = add_axes(figure, left + _WIDTH - 1.6, foot, 0.13, _SIDE)
            _draw_contour(panel, scale, grids, values)
            panel.set_ylabel(titles[1][0], fontsize=TEXT)
            note = "grey: no value"
        title_panel(panel, title_with_unit(item.title, symbol), note if missing.any() else "")
    return figure


def _axis_title(axis: Axis, system: System) -> tuple[str, float]:
    """Return the title of an axis with its unit, and the size of that unit in its column's unit."""
    symbol, factor = metric_unit_in("rpm" if axis.parameter == "speed" else "mm", system)
    return title_with_unit(axis.parameter, symbol), factor


def _draw_line(panel: Axes, x: Array, values: Array) -> None:
    few = {"marker": "o", "markersize": 3.5} if len(x) <= 40 else {}
    panel.plot(x, values, color=BLUE, linewidth=1.5, **few)  # type: ignore[arg-type]
    panel.set_xlim(padded_limits(x.min(), x.max(), 0.02))
    panel.set_ylim(padded_limits(np.nanmin(values), np.nanmax(values)))
    for start in map(int, np.flatnonzero(np.isnan(values))):
        low = 0.5 * (x[start] + x[max(start - 1, 0)])
        high = 0.5 * (x[start] + x[min(start + 1, len(x) - 1)])
        panel.axvspan(low, high, color=SHADE, linewidth=0, zorder=0)


def _draw_contour(panel: Axes, scale: Axes, grids: list[Array], values: Array) -> None:
    panel.set_facecolor(SHADE)
    panel.grid(False)
    masked: Any = np.ma.masked_invalid(values.T)
    if is_constant(masked.compressed()):
        panel.figure.colorbar(panel.pcolormesh(*grids, masked, cmap=colour_map(), shading="nearest"), cax=scale)
    else:
        filled = panel.contourf(*grids, masked, levels=_LEVELS, cmap=colour_map())
        lines = panel.contour(*grids, masked, levels=list(filled.levels)[1::2], colors="white", linewidths=0.7)
        # A colour scale instead of contour labels, which crowd near locking.
        panel.figure.colorbar(filled, cax=scale).add_lines(lines)
    panel.set_xlim(grids[0].min(), grids[0].max())
    panel.set_ylim(grids[1].min(), grids[1].max())
    style_axes(scale)
    scale.grid(False)
    scale.xaxis.set_visible(False)
    scale.yaxis.tick_right()
    scale.spines[:].set_visible(False)
