"""Curves over the crank angle in stacked panels, several to a panel, told apart in greyscale too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from .style import BLUE, FRAME, INK, MUTED, SHADE, SMALL, TEXT, TITLE, VERMILION, dress, limits, new_figure, place, save
from .style import write as write_text

Array = NDArray[np.float64]

_LOOKS = ((BLUE, "-", 1.5), (VERMILION, (0, (5, 2)), 1.3), (INK, (0, (1, 1.5)), 1.3))
_WIDTH, _HEIGHT, _LEFT, _FOOT, _HEAD, _GAP = 6.4, 1.75, 0.85, 0.6, 0.6, 0.5


@dataclass(frozen=True)
class Series:
    """A curve: its name and its values (n,), NaN where there is none."""

    name: str
    values: Array


@dataclass(frozen=True)
class Panel:
    """Curves that share a panel. title: with unit. level: a horizontal line, with its name, or None."""

    title: str
    series: tuple[Series, ...]
    level: tuple[str, float] | None = None


@dataclass(frozen=True)
class Panels:
    """A figure's data. angles: (n,), deg. shaded: crank angles (from, to), deg, with what they are."""

    title: str
    angles: Array
    panels: tuple[Panel, ...]
    shaded: tuple[tuple[float, float], ...] = ()
    shaded_name: str = ""


def draw_panels(data: Panels, path: Path) -> Path:
    """Write the figure as PNG; return its path."""
    count = len(data.panels)
    height = _FOOT + _HEAD + count * _HEIGHT + (count - 1) * _GAP
    figure = new_figure(_WIDTH, height)
    write_text(figure, 0.15, height - 0.27, data.title, fontsize=TITLE, fontweight="bold")
    axes: list[Axes] = []
    for index, panel in enumerate(data.panels):
        bottom = _FOOT + (count - 1 - index) * (_HEIGHT + _GAP)
        axes.append(place(figure, _LEFT, bottom, _WIDTH - _LEFT - 0.2, _HEIGHT))
        _draw(axes[-1], data, panel, last=index == count - 1)
    shaded = f" (shaded: {data.shaded_name})" if data.shaded else ""
    axes[-1].set_xlabel(f"crank angle, deg{shaded}", fontsize=TEXT)
    save(figure, path)
    return path


def _draw(axes: Axes, data: Panels, panel: Panel, *, last: bool) -> None:
    dress(axes, up=6)
    axes.set_xticks(range(0, 361, 45))
    axes.tick_params(labelbottom=last)
    for start, end in data.shaded:
        for shift in (-360.0, 0.0, 360.0):
            axes.axvspan(start + shift, end + shift, color=SHADE, linewidth=0, zorder=0)
    levels = [] if panel.level is None else [panel.level[1]]
    finite = np.concatenate([series.values[np.isfinite(series.values)] for series in panel.series] + [np.array(levels)])
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    if low < 0.0 < high:
        axes.axhline(0.0, color=FRAME, linewidth=0.8, zorder=1)
    for series, (colour, dashes, width) in zip(panel.series, _LOOKS, strict=False):
        axes.plot(data.angles, series.values, color=colour, linestyle=dashes, linewidth=width, label=series.name)
    if panel.level is not None:
        name, level = panel.level
        axes.axhline(level, color=MUTED, linewidth=1.1, linestyle=(0, (6, 2, 1, 2)), label=name)
    axes.set_xlim(0, 360)
    axes.set_ylim(limits(low, high, 0.09))
    axes.text(0.0, 1.04, panel.title, transform=axes.transAxes, va="bottom", ha="left", fontsize=SMALL, color=INK)
    if len(panel.series) + len(levels) > 1:
        axes.legend(
            loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=4, frameon=False, fontsize=SMALL, borderaxespad=0.0,
            handlelength=2.8, columnspacing=1.2,
        )  # fmt: skip


def turn(*marked: Sequence[float] | Array, samples: int = 720) -> Array:
    """Return crank angles, rad, over a turn, with those marked just before and just after: jumps stay upright."""
    around = [np.mod(np.asarray(angles) + side, 2.0 * np.pi) for angles in marked for side in (-1e-9, 1e-9)]
    return np.unique(np.concatenate([np.linspace(0.0, 2.0 * np.pi, samples + 1), *around]))
