"""Shaking force and shaking moment of one design over the cycle, with and without its counterweight."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ....model.cycle.shaking import shaking_curves
from ....model.linkage.linkage import Linkage
from ....model.machine.links import Counterweight
from ....model.machine.mechanism import Mechanism
from ...figures.cycle import Panel, Panels, Series, draw_panels, turn


def balance_curves(mechanism: Mechanism, linkage: Linkage) -> Panels:
    """Return the figure's data."""
    theta = turn()
    now = shaking_curves(mechanism, linkage, theta)
    size, moment = [Series("as it is", np.hypot(now.force_x, now.force_y))], [Series("as it is", now.moment)]
    if mechanism.counterweight.mass > 0.0:
        bare = shaking_curves(replace(mechanism, counterweight=Counterweight(mass=0.0, radius=0.0)), linkage, theta)
        size.append(Series("without counterweight", np.hypot(bare.force_x, bare.force_y)))
        moment.append(Series("without counterweight", bare.moment))
    return Panels(
        "Shaking force and moment on the frame",
        np.degrees(theta),
        (
            Panel("shaking force, N", tuple(size)),
            Panel("its components, N", (Series("along the slider line", now.force_x), Series("across", now.force_y))),
            Panel("shaking moment about the crank pivot, N m", tuple(moment)),
        ),
    )


def draw_balance(mechanism: Mechanism, linkage: Linkage, path: Path) -> Path:
    """Draw shaking force and moment over the cycle as PNG; return its path."""
    return draw_panels(balance_curves(mechanism, linkage), path)
