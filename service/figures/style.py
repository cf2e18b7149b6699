"""Style of every figure: sizes, colours that survive greyscale and colour blindness, ticks, and saving.

Figures are `matplotlib.figure.Figure` objects with their own Agg canvas. Neither pyplot nor the global settings of
matplotlib are used, so that drawing never affects the caller's own plots.
"""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...model.arrays import Array
from ...model.optional_packages import NamingExtra
from ...optimise.front.saved_front import is_constant
from ..render.numerals import format_on_scale
from ..resources.memory import without_garbage_collection

with NamingExtra("figures need"), without_garbage_collection():
    import matplotlib
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter, MaxNLocator
    from PIL import Image

DPI = 130
TITLE, TEXT, SMALL = 11.0, 8.5, 7.5  # points

INK = "#1a1a1a"
MUTED = "#666666"
FRAME = "#8c8c8c"
GRID = "#dedede"
SHADE = "#ededed"
LINK = "#cfdce8"
# Okabe and Ito, "Color Universal Design" (2008): distinguishable with every type of colour vision, and in greyscale.
BLUE, VERMILION = "#0072b2", "#d55e00"

MARKERS = ("^", "v", "s", "D", "P", "X", "<", ">", "h")
KNEE_MARKER = "*"
# Colours for parts of a whole, distinguishable in greyscale too.
GREYS = ("#404040", "#a8a8a8", "#6e6e6e", "#d4d4d4", "#8c8c8c", "#c0c0c0", "#565656", "#ebebeb")
_HATCHES = ("", "///", "", "...", "xxx", "", "\\\\\\", "ooo")


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure with a size in inches."""
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def save_png(figure: Figure, path: Path | io.BytesIO) -> None:
    """Write a figure as PNG."""
    # No metadata, so that the same run gives the same bytes. Omitting transparency, which no figure has, is a fifth
    # faster and
    # a tenth smaller; compression 3 is a third faster than 6 and no larger.
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    drawn = Image.frombuffer("RGBA", canvas.get_width_height(), canvas.buffer_rgba(), "raw", "RGBA", 0, 1)
    drawn.convert("RGB").save(path, format="png", compress_level=3, dpi=(figure.dpi, figure.dpi))


def figure_bytes(figure: Figure, kind: str) -> bytes:
    """Return a figure as the content of a file; kind: "png" or "svg"."""
    out = io.BytesIO()
    if kind == "png":
        save_png(figure, out)
    else:
        figure.savefig(out, format=kind, metadata={"Date": None, "Creator": None})
    return out.getvalue()


def add_axes(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Return axes at a position in inches from the lower left corner."""
    total_width, total_height = figure.get_size_inches()
    return figure.add_axes((left / total_width, bottom / total_height, width / total_width, height / total_height))


def write_text(figure: Figure, x: float, y: float, text: str, **style: Any) -> None:
    """Write text verbatim at a position in inches from the lower left corner, since job names may contain $."""
    width, height = figure.get_size_inches()
    figure.text(x / width, y / height, text, **{"fontsize": TEXT, "color": INK, "parse_math": False, **style})


def write_heading(figure: Figure, title: str, subtitle: str = "", *, left: float = 0.25) -> None:
    """Write the title at the upper left of a figure, and the subtitle below it."""
    height = figure.get_size_inches()[1]
    write_text(figure, left, height - 0.3, title, fontsize=TITLE, weight="bold")
    write_text(figure, left, height - 0.5, subtitle, color=MUTED)


def title_panel(axes: Axes, title: str, note: str = "", colour: str = MUTED) -> None:
    """Write the title above the left end of a panel, and a coloured note above the right end."""
    # With y given, matplotlib does not look for ticks above the panel, which would take a tenth of the time of a
    # figure.
    axes.set_title(title, loc="left", y=1.0, fontsize=SMALL, color=INK, pad=4)
    axes.set_title(note, loc="right", y=1.0, fontsize=SMALL, color=colour, pad=4)


def show_full_turn(axes: Axes) -> None:
    """Format the x axis for a crank revolution, in deg."""
    axes.set_xlim(0, 360)
    axes.set_xticks(range(0, 361, 45))


def draw_stack(axes: Axes, x: Array, parts: Array, names: Sequence[str]) -> None:
    """Draw stacked parts (s, m) over x values (m,)."""
    stack = axes.stackplot(x, parts, labels=names, colors=GREYS, edgecolor="white", linewidth=0.4)
    for part, hatch in zip(stack, _HATCHES, strict=False):
        part.set_hatch(hatch)


def add_legend_at_right(axes: Axes, *, stacked: int = 0) -> None:
    """Add the legend at the right of axes. stacked: number of initial entries to list in reverse, the last on top."""
    handles, labels = axes.get_legend_handles_labels()
    order = [*reversed(range(stacked)), *range(stacked, len(handles))]
    place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (1.02, 1.0), "borderaxespad": 0.0}
    looks: dict[str, Any] = {"fontsize": SMALL, "frameon": False, "handlelength": 2.4, "handleheight": 1.1}
    axes.legend([handles[i] for i in order], [labels[i] for i in order], **place, **looks)


def add_legend(
    figure: Figure, x: float, y: float, handles: Sequence[Artist], labels: Sequence[str], *, spacing: float = 0.5
) -> None:
    """Add a legend to a figure, with its upper left corner at (x, y), inches from the lower left."""
    width, height = figure.get_size_inches()
    place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (x / width, y / height), "borderaxespad": 0.0}
    looks: dict[str, Any] = {"fontsize": SMALL, "frameon": False, "handletextpad": 0.4, "borderpad": 0.0}
    figure.legend(list(handles), list(labels), labelspacing=spacing, **place, **looks)


def style_axes(axes: Axes, *, most_x_ticks: int = 5, most_y_ticks: int = 5) -> None:
    """Give axes the common frame, grid and ticks; most_x_ticks, most_y_ticks: maximum number of ticks along x and y."""
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(FRAME)
        spine.set_linewidth(0.8)
    axes.tick_params(length=3, width=0.8, color=FRAME, labelcolor=INK, labelsize=SMALL)
    axes.grid(True, color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.xaxis.set_major_locator(MaxNLocator(most_x_ticks, steps=[1, 2, 2.5, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(most_y_ticks, steps=[1, 2, 2.5, 5, 10]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: format_on_scale(value, *axes.get_xlim(), digits=6)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: format_on_scale(value, *axes.get_ylim(), digits=6)))


def padded_limits(low: float, high: float, margin: float = 0.06) -> tuple[float, float]:
    """Return axis limits around a range of values, which may be a single value."""
    span = high - low
    if is_constant((low, high)):
        span = 0.1 * abs(high) or 1.0
    return low - margin * span, high + margin * span


def colour_map() -> ListedColormap:
    """Return the colour scale: cividis without its palest end, even in greyscale and for the colour-blind."""
    full = matplotlib.colormaps["cividis"]
    return ListedColormap([full(0.92 * i / 255.0) for i in range(256)])
