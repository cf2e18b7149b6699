"""The panels of a scatter matrix: each pair of objectives once, below the diagonal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .style import SMALL, place


def triangle(
    figure: Figure, labels: Sequence[str], *, left: float, bottom: float, side: float, gap: float
) -> Iterator[tuple[Axes, int, int]]:
    """Yield empty panels with what goes across and what goes up, places in labels; label the outer ones once drawn.

    left, bottom: of the lowest row's first panel. side, gap: of and between panels. All in inches.
    """
    count = len(labels) - 1
    for row in range(count):
        for column in range(row + 1):
            panel = place(figure, left + column * (side + gap), bottom + (count - 1 - row) * (side + gap), side, side)
            yield panel, column, row + 1
            panel.tick_params(labelleft=column == 0, labelbottom=row == count - 1)
            if column == 0:
                panel.set_ylabel(labels[row + 1], fontsize=SMALL)
            if row == count - 1:
                panel.set_xlabel(labels[column], fontsize=SMALL)
