"""Style of every figure: sizes, colours that survive greyscale and colour blindness, ticks, and saving.

Figures are `matplotlib.figure.Figure` objects with their own Agg canvas. Neither pyplot nor the global settings of
matplotlib are touched, so that drawing never changes what a caller plots himself.
"""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from ...optimise.front.constant import is_constant

DPI = 130
TITLE, TEXT, SMALL = 11.0, 8.5, 7.5  # points

INK = "#1a1a1a"
MUTED = "#666666"
FRAME = "#8c8c8c"
GRID = "#dedede"
SHADE = "#ededed"
GHOST = "#b0b0b0"
LINK = "#cfdce8"
# Okabe and Ito, "Color Universal Design" (2008): told apart with every kind of colour vision, and by their greys.
BLUE, VERMILION = "#0072b2", "#d55e00"

MARKERS = ("^", "v", "s", "D", "P", "X", "<", ">", "h")
KNEE_MARKER = "*"


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of a size in inches."""
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def save(figure: Figure, path: Path | io.BytesIO) -> None:
    """Write a figure as PNG."""
    # No metadata: the same run gives the same bytes. Compression 3: a third quicker than 6, no larger.
    figure.savefig(path, format="png", metadata={"Software": None}, pil_kwargs={"compress_level": 3})


def image(figure: Figure, kind: str) -> bytes:
    """Return a figure as the content of a file; kind: "png" or "svg"."""
    out = io.BytesIO()
    if kind == "png":
        save(figure, out)
    else:
        figure.savefig(out, format=kind, metadata={"Date": None, "Creator": None})
    return out.getvalue()


def place(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Return axes at a place given in inches from the lower left corner."""
    total_width, total_height = figure.get_size_inches()
    return figure.add_axes((left / total_width, bottom / total_height, width / total_width, height / total_height))


def write(figure: Figure, x: float, y: float, text: str, **style: Any) -> None:
    """Write text verbatim at a place in inches from the lower left corner, as job names may contain $."""
    width, height = figure.get_size_inches()
    figure.text(x / width, y / height, text, **{"fontsize": TEXT, "color": INK, "parse_math": False, **style})


def dress(axes: Axes, *, across: int = 5, up: int = 5) -> None:
    """Give axes the common frame, grid and ticks; across, up: the most ticks along x and y."""
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(FRAME)
        spine.set_linewidth(0.8)
    axes.tick_params(length=3, width=0.8, color=FRAME, labelcolor=INK, labelsize=SMALL)
    axes.grid(True, color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.xaxis.set_major_locator(MaxNLocator(across, steps=[1, 2, 2.5, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(up, steps=[1, 2, 2.5, 5, 10]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: on_scale(value, *axes.get_xlim(), digits=6)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: on_scale(value, *axes.get_ylim(), digits=6)))


def on_scale(value: float, low: float, high: float, *, digits: int = 4) -> str:
    """Return a number as text for an axis from low to high; less than a millionth of it is zero."""
    return shown(0.0 if abs(value) < 1e-6 * abs(high - low) else value, digits)


def shown(value: float, digits: int = 4, *, zeros: bool = False) -> str:
    """Return a number for people: that many significant digits, no exponent where avoidable, a real minus sign.

    zeros: keep those at the end, so that numbers below one another have the same precision.
    """
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "–"
    text = f"{value:#.{digits}g}".rstrip(".") if zeros else f"{value:.{digits}g}"
    if "e" in text and 1e-5 < abs(value) < 1e7:
        text = f"{value:.0f}" if abs(value) >= 1.0 else f"{value:.{digits + 3}f}".rstrip("0")
    return ("0" if float(text) == 0.0 else text).replace("-", "−")


def unit_text(symbol: str) -> str:
    """Return a unit as printed: m/s^2 with a raised 2."""
    return symbol.replace("^2", "²").replace("^3", "³")


def with_unit(title: str, symbol: str) -> str:
    """Return an axis title with its unit."""
    return f"{title}, {unit_text(symbol)}" if symbol else title


def limits(low: float, high: float, margin: float = 0.06) -> tuple[float, float]:
    """Return axis limits around a range of values, also around a single one."""
    span = high - low
    if is_constant((low, high)):
        span = 0.1 * abs(high) or 1.0
    return low - margin * span, high + margin * span


def colours() -> ListedColormap:
    """Return the colour scale: cividis without its palest end, even in greyscale and for the colour-blind."""
    full = matplotlib.colormaps["cividis"]
    return ListedColormap([full(0.92 * i / 255.0) for i in range(256)])
