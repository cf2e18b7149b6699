"""Figures of a front and of single designs, as PNG files. Importing this imports matplotlib."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ...model.linkage import Linkage
from ...model.mechanism import Mechanism
from ...optimise.front import ParetoFront
from ...optimise.robust import robust_quantities
from .marks import marks
from .parallel import parallel_coordinates
from .robustness import robustness_figure
from .scatter import scatter_matrix
from .sheet import design_sheet
from .style import save

__all__ = ["draw_design", "draw_front"]


def draw_front(front: ParetoFront, folder: Path) -> Iterator[Path]:
    """Write the figures of a front that has designs; yield each file as soon as it is written.

    scatter_matrix.png (two objectives or more), parallel_coordinates.png (two designs or more), and one sheet for
    each extreme, best_<quantity>.png, and for the knee, knee.png; what coincides is copied. robust.png for a robust
    problem of two objectives or more, for which the nominal one is solved.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if len(front) > 1:
        if len(front.objectives) > 1:
            save(scatter_matrix(front), folder / "scatter_matrix.png")
            yield folder / "scatter_matrix.png"
        save(parallel_coordinates(front), folder / "parallel_coordinates.png")
        yield folder / "parallel_coordinates.png"
    if robust_quantities(front.problem) and len(front.objectives) > 1:
        figure = robustness_figure(front)
        if figure is not None:
            save(figure, folder / "robust.png")
            yield folder / "robust.png"
    bold = [front.problem.quantity(objective.quantity).field for objective in front.objectives]
    for mark in marks(front):
        mechanism = front.mechanism(mark.row)
        crank, rod, offset = front.dimensions[mark.row, :3]
        figure = design_sheet(
            mechanism,
            Linkage(crank, rod, offset, mechanism.branch),
            {str(key): value for key, value in front.designs.iloc[mark.row].items()},
            title=f"{front.problem.name}: {mark.label}",
            subtitle=f"design {mark.row + 1} of {len(front)}",
            bold=bold,
        )
        first, *others = (folder / f"{name}.png" for name in mark.names)
        save(figure, first)
        yield first
        for other in others:
            shutil.copyfile(first, other)
            yield other


def draw_design(
    mechanism: Mechanism,
    linkage: Linkage,
    numbers: Mapping[str, Any],
    folder: Path,
    *,
    title: str,
    torque: bool,
) -> Path:
    """Write the sheet of one design as design.png; return the file."""
    folder.mkdir(parents=True, exist_ok=True)
    figure = design_sheet(mechanism, linkage, numbers, title=title, torque=torque)
    save(figure, folder / "design.png")
    return folder / "design.png"
