"""Tornado figure: percentage change of each quantity for a one percent increase in each dimension."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ....model.linkage.dimensions import DIMENSIONS
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.swing.swing import Swing
from ....objectives.kinds import System
from ....objectives.tables.sensitivity import sensitivity
from ...figures.style import (
    BLUE,
    FRAME,
    INK,
    MUTED,
    SMALL,
    TEXT,
    VERMILION,
    add_axes,
    new_figure,
    style_axes,
    write_heading,
)
from ...render.numerals import format_number
from ..peaks import lengths_row

_STEPS: dict[System, tuple[str, float]] = {"metric": ("1 mm", 1.0), "inch": ("0.01 in", 0.254)}
"""Step of the offset, as text and in mm, for which percentages are given if the offset is zero."""


def tornado_rows(mechanism: Mechanism, linkage: Linkage, swing: Swing | None = None) -> pd.DataFrame:
    """Return the rows of the figure: title and percentages of each quantity that has them, most sensitive first.

    swing: swing of a crank that does not rotate fully. For a zero offset the percentages are per 1 mm.
    <dimension>_percent_below: percentages towards smaller values.
    """
    table = sensitivity(mechanism, lengths_row(linkage)[0], swing)
    columns = [f"{name}_percent{side}" for name in DIMENSIONS for side in ("", "_below")]
    if float(linkage.offset) == 0.0:
        # Quantities with percentages: nonzero, and not the crank angle of a dead centre.
        sizes = table["value"].where(table["crank_percent"].notna())
        for side in ("", "_below"):
            table[f"offset_percent{side}"] = 100.0 * table[f"offset_per_mm{side}"] / sizes
    rows = table[["title", *columns]].dropna(subset=columns, how="all")
    rows.attrs["offset per mm"] = float(linkage.offset) == 0.0
    largest = rows[columns].abs().max(axis=1).sort_values(ascending=False, kind="stable")
    return rows.loc[largest.index].reset_index(drop=True)


def tornado_figure(rows: pd.DataFrame, system: System = "metric", *, width: float = 10.6, limit: int = 1000) -> Figure:
    """Return the figure in a unit system: a panel for each dimension, a bar for each quantity.

    width: width of the figure, inches. limit: number of most sensitive quantities to draw.
    """
    left_out, rows = len(rows) - limit, rows.head(limit)
    step, millimetres = _STEPS[system]
    if rows.attrs.get("offset per mm", False):
        rows = rows.assign(**{name: millimetres * rows[name] for name in ("offset_percent", "offset_percent_below")})
    count = max(1, len(rows))
    height = 1.55 + 0.24 * count
    figure = new_figure(width, height)
    note = "change in % if each dimension grows by 1 % (the offset: its size); "
    note += f"{left_out} others change less" if left_out > 0 else "at a kink: derivatives below and above"
    write_heading(figure, "Sensitivity", note)
    panel_width = (width - 2.56) / len(DIMENSIONS)
    columns = [f"{name}_percent" for name in DIMENSIONS]
    all_columns = [*columns, *(f"{column}_below" for column in columns)]
    half_width = 1.5 * float(np.nanmax(np.abs(rows[all_columns].to_numpy()))) if len(rows) else 1.0
    half_width = half_width or 1.0
    places = np.arange(count)[::-1]
    for n, (name, column) in enumerate(zip(DIMENSIONS, columns, strict=True)):
        panel = add_axes(figure, 2.55 + panel_width * n, 0.55, panel_width - 0.18, height - 1.5)
        style_axes(panel)
        panel.grid(False, axis="y")
        panel.set_xlim(-half_width, half_width)
        panel.set_ylim(-0.7, count - 0.3)
        panel.set_yticks(places, list(rows["title"]) if len(rows) else [""])
        panel.tick_params(labelleft=n == 0, left=False)
        panel.axvline(0.0, color=FRAME, linewidth=0.8)
        per_mm = name == "offset" and rows.attrs.get("offset per mm", False)
        panel.set_title(f"{name}, for {step}" if per_mm else name, fontsize=TEXT, color=INK, pad=4)
        panel.set_xlabel("%", fontsize=SMALL)
        for at, upper, lower in zip(places, rows[column], rows[f"{column}_below"], strict=False):
            if np.isnan(upper):
                continue
            if abs(upper - lower) <= 1e-9 * max(abs(upper), abs(lower)):
                _draw_bar(panel, at, 0.62, float(upper), half_width)
            else:  # at a kink: a bar in the lower half of the row
                _draw_bar(panel, at - 0.19, 0.3, float(lower), half_width, "below ")
                _draw_bar(panel, at + 0.19, 0.3, float(upper), half_width, "above ")
        if rows[column].isna().all():
            panel.text(0.0, 0.5 * (count - 1), f"no {name}:\nnot defined", ha="center", fontsize=SMALL, color=MUTED)
    return figure


def _draw_bar(panel: Axes, at: float, height: float, value: float, half_width: float, side: str = "") -> None:
    up = value >= 0.0
    panel.barh(at, value, height=height, color=BLUE if up else "white", edgecolor=BLUE if up else VERMILION)
    text = side + (f"{'+' if up else ''}{format_number(value, 3)}" if abs(value) >= 5e-4 else "0")
    size = SMALL - (2.5 if side else 1.0)
    panel.text(
        value + (0.02 if up else -0.02) * half_width,
        at,
        text,
        ha="left" if up else "right",
        va="center",
        fontsize=size,
        color=INK,
    )
