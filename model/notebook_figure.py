"""A matplotlib figure that a notebook shows by itself, also where nothing has imported pyplot."""

from __future__ import annotations

import io

from matplotlib.figure import Figure


class NotebookFigure(Figure):
    """A figure with a PNG of its own for notebooks."""

    def _repr_png_(self) -> bytes:
        """The figure as PNG, at the figure's resolution."""
        out = io.BytesIO()
        self.savefig(out, format="png")
        return out.getvalue()
