"""The moving picture of the README: a pointer walks along a front while the linkage of each design turns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image
from PIL.Image import Image as Picture

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.service.drawings.linkage_shapes import (
    LinkageSizes,
    fixed_shapes,
    linkage_sizes,
    moving_shapes,
    pin_positions,
)
from slidercrank.service.figures.shape_painting import paint_shapes, set_axes_to_rectangle
from slidercrank.service.figures.style import (
    INK,
    TEXT,
    TITLE,
    VERMILION,
    add_axes,
    colour_map,
    new_figure,
    padded_limits,
    style_axes,
    write_text,
)

STEPS, REST, MILLISECONDS = 42, 18, 70
"""Frames of a walk along the front, of a rest at an end or at the knee, and how long each frame is shown."""
_TURNS = 7  # of the crank in the whole picture: it ends as it begins
_WIDTH, _HEIGHT, _DOTS = 9.6, 3.5, 100
_COLOURS = 64
_LABELS = {
    "time_ratio": "time ratio",
    "peak_torque_Nm": "peak torque, N m",
    "least_transmission_angle_deg": "least transmission angle, deg",
}


@dataclass(frozen=True)
class _Columns:
    across: np.ndarray[Any, np.dtype[np.float64]]
    up: np.ndarray[Any, np.dtype[np.float64]]
    colour: np.ndarray[Any, np.dtype[np.float64]]


def visits(count: int, knee: int) -> list[int]:
    """Return the design that each frame shows: from the first to the last of them, resting at both and at the knee."""
    walk = [round(step * (count - 1) / (STEPS - 1)) for step in range(STEPS)]
    before = [row for row in walk if row < knee]
    after = [row for row in walk if row > knee]
    forward = [*[0] * REST, *before, *[knee] * REST, *after, *[count - 1] * REST]
    return [*forward, *reversed(after), *[knee] * REST, *reversed(before)]


def exploring_front(front: ParetoFront, file: Path) -> None:
    """Write the picture as a GIF, of a front between time ratio, peak torque and least transmission angle."""
    of = _Columns(*(front.columns[key] for key in _LABELS))
    linkages = [Linkage(*dimensions[:3]) for dimensions in front.dimensions]
    looks = [linkage_sizes(front.mechanism(row), linkage) for row, linkage in enumerate(linkages)]
    figure = new_figure(_WIDTH, _HEIGHT)
    figure.set_dpi(_DOTS)
    chart, stage = _chart(figure, of), _stage(figure, looks)
    write_text(figure, 0.3, _HEIGHT - 0.32, f"{len(front)} Pareto-optimal feeders", fontsize=TITLE, weight="bold")
    reading = figure.text(4.75 / _WIDTH, 0.2 / _HEIGHT, "", fontsize=TEXT, color=INK, linespacing=1.5)
    canvas: Any = figure.canvas
    canvas.draw()
    still, frames, palette = canvas.copy_from_bbox(figure.bbox), [], None
    shown = visits(len(front), front.knee())
    for step, row in enumerate(shown):
        angle = 2.0 * math.pi * _TURNS * step / len(shown)
        pin, slider = pin_positions(linkages[row], angle)
        shapes = [*fixed_shapes(linkages[row], looks[row], bearing_below=True), *moving_shapes(pin, slider, looks[row])]
        (dot,) = chart.plot(
            of.across[row], of.up[row], "o", markersize=11, markerfacecolor="none", markeredgecolor=VERMILION, mew=2.2
        )
        crank, rod, offset = (1e3 * float(getattr(linkages[row], name)) for name in ("crank", "rod", "offset"))
        reading.set_text(
            f"crank {crank:.1f} mm, rod {rod:.0f} mm, offset {offset:.0f} mm\ntime ratio {of.across[row]:.2f}, "
            f"peak torque {of.up[row]:.0f} N m, transmission angle {of.colour[row]:.0f}° or more"
        )
        canvas.restore_region(still)
        for artist in (reading, dot, *paint_shapes(stage, shapes)):
            figure.draw_artist(artist)
            if artist is not reading:
                artist.remove()
        picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])
        palette = palette or picture.quantize(_COLOURS, method=Image.Quantize.MAXCOVERAGE)
        frames.append(picture.quantize(palette=palette, dither=Image.Dither.NONE))
    _save(frames, file)


def _save(frames: list[Picture], file: Path) -> None:
    frames[0].save(
        file, save_all=True, append_images=frames[1:], duration=MILLISECONDS, loop=0, disposal=1, optimize=False
    )


def _chart(figure: Figure, of: _Columns) -> Axes:
    """Return axes with the designs on the front."""
    axes = add_axes(figure, 0.75, 0.6, 2.75, 2.35)
    style_axes(axes, most_x_ticks=4, most_y_ticks=4)
    across, up, colour = _LABELS.values()
    axes.set_xlim(*padded_limits(of.across.min(), of.across.max()))
    axes.set_ylim(*padded_limits(of.up.min(), of.up.max()))
    axes.set_xlabel(across, fontsize=TEXT, color=INK)
    axes.set_ylabel(up, fontsize=TEXT, color=INK)
    dots = axes.scatter(of.across, of.up, c=of.colour, s=20, cmap=colour_map(), linewidths=0.0)
    bar = figure.colorbar(dots, cax=add_axes(figure, 3.62, 0.6, 0.1, 2.35))
    bar.set_label(colour, fontsize=TEXT, color=INK)
    bar.ax.tick_params(labelsize=TEXT - 1.0, length=2)
    bar.outline.set_visible(False)
    return axes


def _stage(figure: Figure, looks: list[LinkageSizes]) -> Axes:
    """Return axes that show every linkage of the front at one scale."""
    extents = np.array([look.extent for look in looks])
    left, low = extents[:, :2].min(axis=0)
    right, high = extents[:, 2:].max(axis=0)
    margin = 0.04 * (right - left)
    axes = add_axes(figure, 4.45, 0.65, _WIDTH - 4.5, _HEIGHT - 0.7)
    set_axes_to_rectangle(axes, left - margin, low - margin, right + margin, high + margin)
    return axes
