"""Torque, guide force and transmission angle of one design with and without friction, over the cycle."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ....model.cycle.cycle import breakpoints, cycle
from ....model.cycle.locked_angles import verdict
from ....model.linkage.linkage import Linkage
from ....model.machine.friction import Friction
from ....model.machine.mechanism import Mechanism
from ...figures.cycle import Panel, Panels, Series, draw_panels, turn


def friction_curves(mechanism: Mechanism, linkage: Linkage) -> Panels:
    """Return the figure's data; at angles where friction locks there is no torque and no force."""
    smooth = replace(mechanism, friction=Friction())
    found = verdict(mechanism, linkage)
    ends = [end for span in found.locked for end in span]
    theta = turn(breakpoints(smooth if found.locks else mechanism, linkage), ends)
    with_it, without = (cycle(each, linkage, theta) for each in (mechanism, smooth))
    least = float(np.degrees(linkage.least_transmission_angle))
    margin = np.degrees(found.margin)
    level = ("locks below (worst side)", least - float(margin)) if np.isfinite(margin) else None
    return Panels(
        "Friction over the cycle",
        np.degrees(theta),
        (
            Panel("drive torque, N m", (Series("with friction", with_it.torque), Series("without", without.torque))),
            Panel(
                "force of the guide on the slider, N",
                (Series("with friction", with_it.guide), Series("without", without.guide)),
            ),
            Panel(
                "transmission angle, deg",
                (Series("transmission angle", np.degrees(with_it.transmission_angle)),),
                level,
            ),
        ),
        tuple((float(np.degrees(a)), float(np.degrees(b))) for a, b in found.locked),
        "locks or may jam",
    )


def draw_friction(mechanism: Mechanism, linkage: Linkage, path: Path) -> Path:
    """Draw friction over the cycle as PNG; return its path."""
    return draw_panels(friction_curves(mechanism, linkage), path)
