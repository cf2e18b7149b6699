"""A sheet of panels with lines, as data and as a figure, for the analyses and the published cases."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from .style import BLUE, FRAME, INK, MUTED, SMALL, TEXT, TITLE, VERMILION, dress, limits, new_figure, place, write

Array = NDArray[np.float64]

GREEN = "#009e73"  # of the same palette
# Told apart by their dashes where colour is lost.
_STYLES: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "linewidth": 1.6},
    {"color": VERMILION, "linewidth": 1.5, "linestyle": (0, (5, 2))},
    {"color": GREEN, "linewidth": 1.5, "linestyle": (0, (7, 2, 1.5, 2))},
    {"color": INK, "linewidth": 1.4, "linestyle": (0, (1.2, 1.5))},
    {"color": MUTED, "linewidth": 1.3, "linestyle": (0, (10, 3))},
)
_POINTS: dict[str, Any] = {
    **{"color": VERMILION, "linestyle": "none", "marker": "o", "markersize": 5.0},
    **{"markerfacecolor": "white", "markeredgewidth": 1.4},
}


@dataclass(frozen=True)
class Line:
    """A curve through (x, y), each (n,), as shown, with a gap where y is nan; single points if `points`.

    style: which of the line styles.
    """

    label: str
    x: Array
    y: Array
    style: int = 0
    points: bool = False


@dataclass(frozen=True)
class Panel:
    """Lines over a common axis. title, across: with unit. names: (text, x, y) of what is named in the drawing.

    equal: the same scale in both directions. turns: x is a crank angle in deg, ticked by quarter turns.
    """

    title: str
    across: str
    lines: tuple[Line, ...]
    names: tuple[tuple[str, float, float], ...] = ()
    equal: bool = False
    turns: bool = False


@dataclass(frozen=True)
class Sheet:
    """Panels row by row, `columns` in each row. subtitle: what the mechanism is."""

    title: str
    subtitle: str
    panels: tuple[Panel, ...]
    columns: int = 1


def draw_sheet(sheet: Sheet, *, width: float = 6.2, height: float = 2.35) -> Figure:
    """Return the figure; width, height: of a panel with its margins, inches."""
    rows = math.ceil(len(sheet.panels) / sheet.columns)
    head = 0.72
    figure = new_figure(sheet.columns * width, rows * height + head)
    write(figure, 0.25, rows * height + head - 0.3, sheet.title, fontsize=TITLE, weight="bold")
    write(figure, 0.25, rows * height + head - 0.52, sheet.subtitle, color=MUTED)
    for index, panel in enumerate(sheet.panels):
        row, column = divmod(index, sheet.columns)
        left, foot = column * width + 0.75, (rows - 1 - row) * height + 0.5
        _draw(place(figure, left, foot, width - 1.0, height - 0.9), panel)
    return figure


def _draw(axes: Axes, panel: Panel) -> None:
    dress(axes, across=8)
    for line in panel.lines:
        style = _POINTS if line.points else _STYLES[line.style % len(_STYLES)]
        axes.plot(line.x, line.y, label=line.label, zorder=4 if line.points else 3, **style)
    _scale(axes, panel)
    _name(axes, panel)
    axes.text(0.0, 1.04, panel.title, transform=axes.transAxes, va="bottom", fontsize=SMALL, color=INK, weight="bold")
    axes.set_xlabel(panel.across, fontsize=TEXT)
    labelled = [line for line in panel.lines if line.label]
    if len(labelled) > 1:
        axes.legend(
            **{"loc": "lower right", "bbox_to_anchor": (1.01, 0.99), "ncols": len(labelled), "frameon": False},
            **{"fontsize": SMALL, "handlelength": 2.6, "columnspacing": 1.2, "borderaxespad": 0.2},
        )


_PLACES = tuple(
    (distance * x, distance * y)
    for distance in (5.0, 14.0)
    for x, y in ((1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1.2), (0, -1.2), (1.2, 0), (-1.2, 0))
)
"""Places for a name, points from what it names; the first is taken unless another is clearer."""


def _name(axes: Axes, panel: Panel) -> None:
    """Write each name beside its point, where it covers the least of other names and of lines."""
    if not panel.names:
        return
    axes.apply_aspect()
    drawn = np.concatenate([axes.transData.transform(_dense(line)) for line in panel.lines])
    taken: list[Bbox] = []
    for text, x, y in panel.names:
        axes.plot(x, y, marker="o", markersize=2.6, color=INK, zorder=5)
        best: tuple[float, Annotation] | None = None
        for place_x, place_y in _PLACES:
            label = axes.annotate(
                text,
                xy=(x, y),
                xytext=(place_x, place_y),
                textcoords="offset points",
                ha="left" if place_x > 0.0 else "right" if place_x < 0.0 else "center",
                va="bottom" if place_y > 0.0 else "top" if place_y < 0.0 else "center",
                fontsize=SMALL,
                color=INK,
                zorder=6,
            )
            box = label.get_window_extent()
            covered = int(box.count_contains(drawn))
            outside = not (axes.bbox.x0 <= box.x0 and box.x1 <= axes.bbox.x1)
            cost = covered + 1000.0 * outside + sum(1000.0 for other in taken if box.overlaps(other))
            if best is None or cost < best[0]:
                if best is not None:
                    best[1].remove()
                best = (cost, label)
            else:
                label.remove()
        assert best is not None
        taken.append(best[1].get_window_extent())


def _dense(line: Line) -> Array:
    """Return points (m, 2) close to each other along a line."""
    at = np.linspace(0.0, len(line.x) - 1.0, 60 * len(line.x))
    index = np.arange(len(line.x))
    return np.stack([np.interp(at, index, line.x), np.interp(at, index, line.y)], axis=1)


def _scale(axes: Axes, panel: Panel) -> None:
    values = np.concatenate([line.y for line in panel.lines])
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    if panel.equal:
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.12)
        return
    if low < 0.0 < high:
        axes.axhline(0.0, color=FRAME, linewidth=0.8, zorder=1)
    axes.set_ylim(limits(low, high))
    ends = np.concatenate([line.x for line in panel.lines])
    if any(line.points for line in panel.lines):
        axes.set_xlim(limits(float(ends.min()), float(ends.max()), 0.03))
    else:
        axes.set_xlim(float(ends.min()), float(ends.max()))
    if panel.turns:
        axes.set_xticks(_quarters(ends))


def _quarters(ends: Array) -> Sequence[float]:
    step = 45.0 if ends.max() - ends.min() <= 400.0 else 90.0
    return [float(tick) for tick in np.arange(0.0, ends.max() + 1.0, step)]
