"""A matplotlib figure that a notebook displays even if pyplot was never imported."""

import io

from .optional_packages import NamingExtra

with NamingExtra("figures need"):
    from matplotlib.figure import Figure


class NotebookFigure(Figure):
    """A figure that renders itself as PNG for notebooks."""

    def _repr_png_(self) -> bytes:
        """Return the figure as PNG, at its own resolution."""
        out = io.BytesIO()
        self.savefig(out, format="png")
        return out.getvalue()
