"""Figures of a front by name, each drawn on request."""

import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ...objectives.kinds import System
from ...optimise.front.front import ParetoFront
from ...optimise.problem.robust_problem import robust_quantities
from ..designs.changed_design import Variation
from ..designs.stored_designs import StoredDesign
from ..resources.memory import without_garbage_collection
from .comparison import robustness_figure
from .datasheet import design_datasheet
from .design_marks import marked_designs
from .parallel_coordinates import parallel_coordinates
from .scatter_matrix import scatter_matrix
from .style import save_png
from .swing_figure import lever_datasheet, swing_figure


@dataclass(frozen=True)
class FrontFigure:
    """Figure. names: names of its files; several if designs coincide. title: its content."""

    names: tuple[str, ...]
    title: str
    draw: Callable[[], Figure]


def front_figures(front: ParetoFront, system: System = "metric") -> list[FrontFigure]:
    """Return the figures of a front that has designs, in a unit system.

    scatter_matrix (at least two objectives and two designs), parallel_coordinates (at least two designs), and one
    datasheet for each extreme design, best_<quantity>, and for the knee.
    """
    figures = []
    if len(front) > 1:
        if len(front.objectives) > 1:
            figures.append(
                FrontFigure(("scatter_matrix",), "every pair of objectives", partial(scatter_matrix, front, system))
            )
        title = "dimensions and objectives of every design"
        figures.append(FrontFigure(("parallel_coordinates",), title, partial(parallel_coordinates, front, system)))
    datasheets = (
        FrontFigure(mark.names, mark.label, partial(datasheet_of, front, mark.row, mark.label, system))
        for mark in marked_designs(front)
    )
    return [*figures, *datasheets]


def write_front_figures(front: ParetoFront, folder: Path, system: System = "metric") -> Iterator[Path]:
    """Write the figures of a front that has designs; yield each file as soon as it is written.

    Writes those of `front_figures`; coinciding ones are copied. Adds robust.png for a robust problem with at least two
    objectives, for which the nominal problem is solved. system: unit system of the figures.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for item in front_figures(front, system):
        first, *copies = (folder / f"{name}.png" for name in item.names)
        with without_garbage_collection():
            save_png(item.draw(), first)
        yield first
        for copy in copies:
            shutil.copyfile(first, copy)
            yield copy
    if robust_quantities(front.problem) and len(front.objectives) > 1:
        figure = robustness_figure(front)
        if figure is not None:
            save_png(figure, folder / "robust.png")
            yield folder / "robust.png"


def datasheet_of(
    front: ParetoFront, row: int, label: str, system: System = "metric", changed: Variation | None = None
) -> Figure:
    """Return the datasheet for a design on a front. label: its role on the front. system: unit system.

    changed: the design with other lengths, if changed.
    """
    if changed is None:
        design = StoredDesign(front.part(row), tuple(front.dimensions[row].tolist()))
        numbers: Mapping[str, Any] = {name: values[row] for name, values in front.columns.items()}
        subtitle = f"design {row + 1} of {len(front)}"
    else:
        design, numbers, subtitle = changed.design, changed.row, "lengths other than those found"
    title, linkage, swing = f"{front.problem.name}: {label}", design.linkage, front.problem.motion
    if swing is not None and swing.of_lever:
        return lever_datasheet(design.mechanism, linkage, swing, system, title=title, subtitle=subtitle)
    if swing is not None:
        return swing_figure(design.mechanism, linkage, swing, system, title=title, subtitle=subtitle)
    quantities = [front.problem.quantity(objective.quantity) for objective in front.objectives]
    bold = {quantity.field: quantity.short_title for quantity in quantities}
    return design_datasheet(
        design.mechanism, linkage, numbers, title=title, subtitle=subtitle, bold=bold, system=system
    )
