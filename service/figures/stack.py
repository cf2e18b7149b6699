"""Parts that add up over the cycle, on top of one another, told apart in greyscale too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

GREYS = ("#404040", "#a8a8a8", "#6e6e6e", "#d4d4d4", "#8c8c8c", "#c0c0c0", "#565656", "#ebebeb")
_HATCHES = ("", "///", "", "...", "xxx", "", "\\\\\\", "ooo")


def draw_stack(axes: Axes, across: NDArray[np.float64], parts: NDArray[np.float64], names: Sequence[str]) -> None:
    """Draw parts (s, m) over what goes across (m,)."""
    stack = axes.stackplot(across, parts, labels=names, colors=GREYS, edgecolor="white", linewidth=0.4)
    for part, hatch in zip(stack, _HATCHES, strict=False):
        part.set_hatch(hatch)
