"""Torque, power and reflected inertia of one design over the cycle."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ....model.cycle.cycle import breakpoints, cycle
from ....model.cycle.self_locking import locking_margin
from ....model.cycle.shaking import shaking_curves
from ....model.linkage.linkage import Linkage
from ....model.machine.friction import Friction
from ....model.machine.mechanism import Mechanism
from ....model.signals.averages import average, average_torque
from ....model.signals.signals import Signal
from ...figures.cycle import Panel, Panels, Series, draw_panels, turn


def motor_curves(mechanism: Mechanism, linkage: Linkage) -> Panels:
    """Return the figure's data; at angles where friction locks there is no torque and no power."""
    design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    locks = not locking_margin(mechanism.friction, design)[0][0] > 0.0
    theta = turn(breakpoints(replace(mechanism, friction=Friction()) if locks else mechanism, linkage))
    curves = cycle(mechanism, linkage, theta)
    averages = average_torque(mechanism, design)
    rms, mean = float(averages.rms[0]), float(averages.mean[0] * mechanism.speed)
    inertia = float(average(mechanism, Signal.REFLECTED_INERTIA, design).mean[0])
    return Panels(
        "Motor over the cycle",
        np.degrees(theta),
        (
            Panel("drive torque, N m", (Series("torque", curves.torque),), None if locks else ("RMS", rms)),
            Panel("power, W", (Series("power", curves.torque * mechanism.speed),), None if locks else ("mean", mean)),
            Panel(
                "reflected inertia, kg m²",
                (Series("inertia", shaking_curves(mechanism, linkage, theta).reflected_inertia),),
                ("mean", inertia),
            ),
        ),
    )


def draw_motor(mechanism: Mechanism, linkage: Linkage, path: Path) -> Path:
    """Draw what the motor feels over the cycle as PNG; return its path."""
    return draw_panels(motor_curves(mechanism, linkage), path)
