"""The tornado figure: by how many percent each quantity changes for one percent more of each dimension."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ...model.linkage import Linkage
from ...model.mechanism import Mechanism
from ...objectives.sensitivity import DIMENSIONS, sensitivity
from .style import BLUE, FRAME, INK, MUTED, SMALL, TEXT, TITLE, VERMILION, dress, new_figure, place, save, shown, write


def tornado_rows(mechanism: Mechanism, linkage: Linkage) -> pd.DataFrame:
    """Return what is drawn: title and percentages of every quantity that has them, the most sensitive first."""
    table = sensitivity(mechanism, np.array([float(linkage.crank), float(linkage.rod), float(linkage.offset)]))
    columns = [f"{name}_percent" for name in DIMENSIONS]
    rows = table[["title", *columns]].dropna(subset=columns, how="all")
    most = rows[columns].abs().max(axis=1).sort_values(ascending=False, kind="stable")
    return rows.loc[most.index].reset_index(drop=True)


def tornado_figure(rows: pd.DataFrame) -> Figure:
    """Return the figure: a panel for each dimension, a bar for each quantity."""
    count = max(1, len(rows))
    height = 1.55 + 0.24 * count
    figure = new_figure(10.6, height)
    write(figure, 0.3, height - 0.3, "Sensitivity", fontsize=TITLE, weight="bold")
    note = "change in % for 1 % more of each dimension (of the offset: of its size); bars to the right grow with it"
    write(figure, 0.3, height - 0.5, note, color=MUTED)
    columns = [f"{name}_percent" for name in DIMENSIONS]
    reach = 1.32 * float(np.nanmax(np.abs(rows[columns].to_numpy()))) if len(rows) else 1.0
    reach = reach or 1.0
    places = np.arange(count)[::-1]
    for n, (name, column) in enumerate(zip(DIMENSIONS, columns, strict=True)):
        panel = place(figure, 2.55 + 2.68 * n, 0.55, 2.5, height - 1.5)
        dress(panel)
        panel.grid(False, axis="y")
        panel.set_xlim(-reach, reach)
        panel.set_ylim(-0.7, count - 0.3)
        panel.set_yticks(places, list(rows["title"]) if len(rows) else [""])
        panel.tick_params(labelleft=n == 0, left=False)
        panel.axvline(0.0, color=FRAME, linewidth=0.8)
        panel.set_title(name, fontsize=TEXT, color=INK, pad=4)
        panel.set_xlabel("%", fontsize=SMALL)
        for at, value in zip(places, rows[column], strict=False):
            if np.isnan(value):
                continue
            up = value >= 0.0
            panel.barh(at, value, height=0.62, color=BLUE if up else "white", edgecolor=BLUE if up else VERMILION)
            text = f"{'+' if up else ''}{shown(float(value), 3)}" if abs(value) >= 5e-4 else "0"
            side = {"ha": "left" if up else "right", "va": "center", "fontsize": SMALL - 1.0, "color": INK}
            panel.text(value + (0.02 if up else -0.02) * reach, at, text, **side)  # type: ignore[arg-type]
        if rows[column].isna().all():
            panel.text(0.0, 0.5 * (count - 1), f"no {name}:\nnot defined", ha="center", fontsize=SMALL, color=MUTED)
    return figure


def draw_sensitivity(mechanism: Mechanism, linkage: Linkage, path: Path) -> Path:
    """Write the tornado figure of one linkage as PNG; return the file."""
    save(tornado_figure(tornado_rows(mechanism, linkage)), path)
    return path
