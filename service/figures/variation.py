"""One-at-a-time variation: displacement, velocity and acceleration with one dimension changed, over the cycle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...model.linkage.linkage import Linkage
from ...model.linkage.variation import Dimension, Variations, vary
from ...model.machine.mechanism import Mechanism
from .style import BLUE, FRAME, INK, SMALL, TEXT, TITLE, VERMILION, dress, new_figure, place, save, shown, write

Array = NDArray[np.float64]
ANGLES = 361
SHARE = 0.05
_LINES = ((VERMILION, (0, (6, 2))), (BLUE, (0, (1.5, 1.5))), ("#666666", (0, (6, 2, 1.5, 2))))


@dataclass(frozen=True)
class Panels:
    """Curves by panel. angles: (m,), deg. labels: of the curves. titles: of the panels. curves: (3, k, m), as shown."""

    angles: Array
    labels: tuple[str, ...]
    titles: tuple[str, ...]
    curves: Array


def variation_panels(mechanism: Mechanism, linkage: Linkage, changes: Sequence[tuple[Dimension, float]] = ()) -> Panels:
    """Return the curves of a linkage and of each change: a dimension and its other value, m.

    Without changes, 5 % more of each dimension that is not zero. Without a crank speed, velocity and acceleration are
    per unit of crank speed.
    """
    own = {"crank": float(linkage.crank), "rod": float(linkage.rod), "offset": float(linkage.offset)}
    changes = changes or [(name, (1.0 + SHARE) * size) for name, size in own.items() if size]  # type: ignore[misc]
    linkage = Linkage(own["crank"], own["rod"], own["offset"], mechanism.branch)
    theta = np.linspace(0.0, 2.0 * np.pi, ANGLES)
    speed, acceleration = (mechanism.speed, mechanism.acceleration) if mechanism.speed else (1.0, 0.0)
    found: Variations = vary(linkage, changes, theta, speed=speed, acceleration=acceleration)
    motions = [found.meant, *(variation.motion for variation in found.varied)]
    units = ("m/s", "m/s²", 1.0) if mechanism.speed else ("mm/rad", "mm/rad²", 1e3)
    curves = [
        [1e3 * motion.slider_position for motion in motions],
        [units[2] * motion.slider_velocity for motion in motions],
        [units[2] * motion.slider_acceleration for motion in motions],
    ]
    changed = (f"{v.dimension} {shown(1e3 * own[v.dimension])} → {shown(1e3 * v.value)} mm" for v in found.varied)
    per = "" if mechanism.speed else " per crank speed"
    titles = ("displacement, mm", f"velocity{per}, {units[0]}", f"acceleration{per}, {units[1]}")
    return Panels(np.degrees(theta), ("as given", *changed), titles, np.array(curves))


def variation_figure(panels: Panels) -> Figure:
    """Return the figure: three panels above one another."""
    figure = new_figure(9.2, 7.4)
    write(figure, 0.3, 7.1, "Variation of one dimension at a time", fontsize=TITLE, weight="bold")
    for n, (title, curves) in enumerate(zip(panels.titles, panels.curves, strict=True)):
        panel = place(figure, 0.85, 4.95 - 2.17 * n, 6.1, 1.8)
        dress(panel)
        panel.set_xlim(0, 360)
        panel.set_xticks(range(0, 361, 45))
        panel.tick_params(labelbottom=n == 2)
        if curves.min() < 0.0 < curves.max():
            panel.axhline(0.0, color=FRAME, linewidth=0.8)
        panel.plot(panels.angles, curves[0], color=INK, linewidth=1.6, label=panels.labels[0])
        for k, (label, curve) in enumerate(zip(panels.labels[1:], curves[1:], strict=True)):
            colour, dashes = _LINES[k % len(_LINES)]
            panel.plot(panels.angles, curve, color=colour, linestyle=dashes, linewidth=1.4, label=label)
        panel.set_title(title, fontsize=SMALL, color=INK, loc="left", pad=4)
        if n == 0:
            panel.legend(
                loc="upper left",
                bbox_to_anchor=(1.02, 1.0),
                fontsize=SMALL,
                frameon=False,
                borderaxespad=0.0,
                handlelength=3.2,
            )
        if n == 2:
            panel.set_xlabel("crank angle, deg", fontsize=TEXT)
    return figure


def draw_variation(
    mechanism: Mechanism, linkage: Linkage, path: Path, changes: Sequence[tuple[Dimension, float]] = ()
) -> Path:
    """Write the figure of one linkage and its changes as PNG; return the file."""
    save(variation_figure(variation_panels(mechanism, linkage, changes)), path)
    return path
