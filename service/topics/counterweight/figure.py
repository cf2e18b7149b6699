"""Shaking before and after balancing: hodograph of the force, force and moment over the cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ....optimise.sizing.counterweight import Balance
from ...figures.panels import Line, Panel, Sheet, draw_sheet
from ...figures.style import save, shown

_SAMPLES = 1441


def balancing_sheet(found: Balance, *, title: str) -> Sheet:
    """Return the figure's data: before and after, N and N m; the moment only where a rod balance changes it."""
    theta = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    degrees = np.degrees(theta)
    curves = list(zip(("before", "after"), found.hodograph(theta), strict=True))
    panels = [
        Panel(
            "hodograph of the shaking force",
            "along the slider line, N; upward: across it, N",
            tuple(Line(name, each.force_x, each.force_y, n) for n, (name, each) in enumerate(curves)),
            equal=True,
        ),
        Panel(
            "size of the shaking force, N",
            "crank angle, deg",
            tuple(
                Line(name, degrees, np.hypot(each.force_x, each.force_y), n) for n, (name, each) in enumerate(curves)
            ),
            turns=True,
        ),
    ]
    if found.rod is not None:
        lines = tuple(Line(name, degrees, each.moment, n) for n, (name, each) in enumerate(curves))
        panels.append(Panel("moment about the pivot, N m", "crank angle, deg", lines, turns=True))
    angle = shown(float(np.degrees(found.angle)) % 360.0)
    parts = [f"counterweight {shown(found.mass)} kg at {shown(1e3 * found.radius)} mm, {angle}° from the crank"]
    if found.rod is not None:
        parts.append(f"{shown(found.rod.mass)} kg added to the rod" if found.rod.mass else "nothing added to the rod")
    return Sheet(f"{title}: balance", ", ".join(parts), tuple(panels), columns=len(panels))


def draw_balancing(found: Balance, path: Path, *, title: str) -> Path:
    """Write the figure as PNG; return the file."""
    save(draw_sheet(balancing_sheet(found, title=title), width=5.0, height=4.4), path)
    return path
