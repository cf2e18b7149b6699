"""Plots of a front: its objectives against each other."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from ...model.arrays import Array

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH, _HEIGHT, _MARGIN = 320.0, 200.0, 30.0  # px in the SVG


def scatter_svg(values: Array, labels: Sequence[str]) -> str:
    """Return an SVG scatter plot of the first two columns, or of a single column against its row number."""
    x = values[:, 0]
    y = values[:, 1] if values.shape[1] > 1 else np.arange(len(values), dtype=np.float64)
    names = [*labels, "design"][:2]
    horizontal = _MARGIN + (_WIDTH - 2 * _MARGIN) * _fraction_of_range(x)
    down = _MARGIN + (_HEIGHT - 2 * _MARGIN) * (1.0 - _fraction_of_range(y))
    spots = "".join(
        f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="currentColor" fill-opacity="0.6"/>'
        for a, b in zip(horizontal, down, strict=True)
    )
    frame = (
        f'<path d="M{_MARGIN:g} {_MARGIN / 2:g} V{_HEIGHT - _MARGIN / 2:g} H{_WIDTH - _MARGIN / 2:g}" '
        'fill="none" stroke="#999"/>'
    )
    text = 'font-size="11" font-family="sans-serif" fill="currentColor"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{escape(" against ".join(names))}" '
        f'width="{_WIDTH:g}" height="{_HEIGHT:g}" viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}">{frame}{spots}'
        f'<text x="{_WIDTH / 2:g}" y="{_HEIGHT - 2:g}" text-anchor="middle" {text}>{escape(names[0])}</text>'
        f'<text x="12" y="{_HEIGHT / 2:g}" text-anchor="middle" transform="rotate(-90 12 {_HEIGHT / 2:g})" {text}>'
        f"{escape(names[1])}</text></svg>"
    )


def scatter_figure(values: Array, labels: Sequence[str], title: str) -> Figure:
    """Return a matplotlib figure of every objective against the first; a single one is plotted in row order.

    values: (n, m), in display units.
    """
    from ...model.notebook_figure import NotebookFigure

    rows = max(1, values.shape[1] - 1)
    drawing = NotebookFigure(figsize=(6.4, 1.2 + 2.4 * rows), layout="constrained")
    for column, axes in enumerate(np.atleast_1d(drawing.subplots(rows, 1, sharex=True)), start=1):
        alone = values.shape[1] == 1
        y = np.arange(len(values), dtype=np.float64) if alone else values[:, column]
        axes.plot(values[:, 0], y, "o", markersize=4, alpha=0.7)
        axes.set_ylabel("design" if alone else labels[column])
        axes.set_xlabel(labels[0])
    drawing.suptitle(title)
    return drawing


def _fraction_of_range(values: Array) -> Array:
    low, span = values.min(initial=np.inf), np.ptp(values) if len(values) else 0.0
    return np.full(len(values), 0.5) if not span > 0.0 else (values - low) / span
