"""The approximate models against the exact one: over crank angle, and their errors over offset."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ....model.classical.comparison import compare
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ...figures.panels import Line, Panel, Sheet, draw_sheet
from ...figures.style import save, shown
from .numbers import over_offset

_OFFSETS = 25


def approximations_sheet(mechanism: Mechanism, linkage: Linkage) -> Sheet:
    """Return acceleration and inertia torque, exact and approximate, and the greatest errors over offset."""
    found = compare(mechanism, linkage, np.linspace(0.0, 2.0 * math.pi, 721))
    errors = over_offset(mechanism, linkage, count=_OFFSETS)
    degrees, offsets = np.degrees(found.crank_angle), np.abs(1e3 * errors.offset)
    panels = [
        Panel(
            "slider acceleration, m/s²",
            "crank angle, deg",
            (
                Line("exact", degrees, found.acceleration),
                *(Line(name, degrees, curve, 1) for name, curve in found.accelerations.items()),
            ),
            turns=True,
        ),
        Panel(
            "inertia torque, N m",
            "crank angle, deg",
            (
                Line("exact", degrees, found.torque),
                *(Line(_SHORT[name], degrees, curve, 1 + n) for n, (name, curve) in enumerate(found.torques.items())),
            ),
            turns=True,
        ),
        Panel(
            "greatest error of acceleration, % of its peak",
            "offset, mm",
            tuple(Line(name, offsets, 100.0 * curve, 1) for name, curve in errors.accelerations.items()),
        ),
    ]
    if np.all(errors.peak_torque > 0.0):
        lines = (
            Line(_SHORT[name], offsets, 100.0 * curve, 1 + n) for n, (name, curve) in enumerate(errors.torques.items())
        )
        panels.append(Panel("greatest error of torque, %", "offset, mm", tuple(lines)))
    subtitle = (
        f"crank {shown(1e3 * float(linkage.crank))}, rod {shown(1e3 * float(linkage.rod))}, "
        f"offset {shown(1e3 * float(linkage.offset))} mm, {shown(mechanism.speed)} rad/s; inertia alone"
    )
    return Sheet("Approximate models against the exact one", subtitle, tuple(panels), columns=2)


_SHORT = {
    "two masses by mass centre": "two masses",
    "two masses, half and half": "half and half",
    "series": "series",
    "k F tan(alpha)": "k F tan(alpha)",
}


def draw_approximations(mechanism: Mechanism, linkage: Linkage, path: Path) -> Path:
    """Write the approximate models and their errors as PNG."""
    save(draw_sheet(approximations_sheet(mechanism, linkage), width=7.6, height=3.0), path)
    return path
