"""Static forces of one design over the cycle."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ....model.classical.static_forces import static_forces
from ....model.cycle.cycle import cycle
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ...figures.panels import Line, Panel, Sheet, draw_sheet
from ...figures.style import save, shown
from .numbers import massless

_ACROSS = "crank angle, deg"
_MOST_ADVANTAGE = 10.0  # beyond it the curve only says that a dead centre is near


def static_forces_sheet(mechanism: Mechanism, linkage: Linkage, *, load: float | None = None) -> Sheet:
    """Return forces, torque and mechanical advantage over the cycle; load as in the analysis of the same name."""
    theta = np.linspace(0.0, 2.0 * math.pi, 721)
    at = static_forces(linkage, theta, load=cycle(massless(mechanism, load), linkage, theta).load)
    degrees = np.degrees(theta)
    advantage = np.where(at.mechanical_advantage <= _MOST_ADVANTAGE, at.mechanical_advantage, np.nan)
    panels = (
        Panel(
            "forces, N",
            _ACROSS,
            (
                Line("load, outward", degrees, at.load, 3),
                Line("rod, compression", degrees, at.rod_force),
                Line("guide", degrees, at.guide_reaction, 1),
            ),
            turns=True,
        ),
        Panel("crank torque, N m", _ACROSS, (Line("", degrees, at.crank_torque),), turns=True),
        Panel(
            f"mechanical advantage, up to {_MOST_ADVANTAGE:g}",
            _ACROSS,
            (Line("", degrees, advantage),),
            turns=True,
        ),
    )
    subtitle = (
        f"crank {shown(1e3 * float(linkage.crank))}, rod {shown(1e3 * float(linkage.rod))}, "
        f"offset {shown(1e3 * float(linkage.offset))} mm; without masses and friction"
    )
    return Sheet("Static forces", subtitle, panels)


def draw_static_forces(mechanism: Mechanism, linkage: Linkage, path: Path) -> Path:
    """Write the static forces over the cycle as PNG."""
    save(draw_sheet(static_forces_sheet(mechanism, linkage), width=8.0), path)
    return path
