"""Figures of a front and of single designs, as PNG files. Importing this imports matplotlib."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ...model.extras import NamingExtra
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import System
from ...optimise.front.front import ParetoFront
from ...optimise.problem.robust import robust_quantities

with NamingExtra("figures need"):
    from .front import front_figures
    from .robustness import robustness_figure
    from .sheet import design_sheet
    from .style import save

__all__ = ["draw_design", "draw_front"]


def draw_front(front: ParetoFront, folder: Path, system: System = "metric") -> Iterator[Path]:
    """Write the figures of a front that has designs; yield each file as soon as it is written.

    Those of `front_figures`; what coincides is copied. robust.png for a robust problem of two objectives or more, for
    which the nominal one is solved. system: of the units that they are in.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for item in front_figures(front, system):
        first, *others = (folder / f"{name}.png" for name in item.names)
        save(item.draw(), first)
        yield first
        for other in others:
            shutil.copyfile(first, other)
            yield other
    if robust_quantities(front.problem) and len(front.objectives) > 1:
        figure = robustness_figure(front)
        if figure is not None:
            save(figure, folder / "robust.png")
            yield folder / "robust.png"


def draw_design(
    mechanism: Mechanism,
    linkage: Linkage,
    numbers: Mapping[str, Any],
    folder: Path,
    *,
    title: str,
    torque: bool,
    system: System = "metric",
) -> Path:
    """Write the sheet of one design as design.png; return the file. system: of the units that it is in."""
    folder.mkdir(parents=True, exist_ok=True)
    figure = design_sheet(mechanism, linkage, numbers, title=title, torque=torque, system=system)
    save(figure, folder / "design.png")
    return folder / "design.png"
