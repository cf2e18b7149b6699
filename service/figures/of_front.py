"""The figures of a front by their names, each drawn when it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from matplotlib.figure import Figure

from ...model.linkage import Linkage
from ...objectives.kinds import System
from ...optimise.front import ParetoFront
from .marks import marks
from .parallel import parallel_coordinates
from .scatter import scatter_matrix
from .sheet import design_sheet


@dataclass(frozen=True)
class FrontFigure:
    """A figure. names: of its files; several where designs coincide. title: what it shows."""

    names: tuple[str, ...]
    title: str
    draw: Callable[[], Figure]


def front_figures(front: ParetoFront, system: System = "metric") -> list[FrontFigure]:
    """Return the figures of a front that has designs, in the units of a system.

    scatter_matrix (two objectives and two designs or more), parallel_coordinates (two designs or more), and one sheet
    for each extreme, best_<quantity>, and for the knee.
    """
    found = []
    if len(front) > 1:
        if len(front.objectives) > 1:
            found.append(
                FrontFigure(("scatter_matrix",), "every pair of objectives", partial(scatter_matrix, front, system))
            )
        title = "dimensions and objectives of every design"
        found.append(FrontFigure(("parallel_coordinates",), title, partial(parallel_coordinates, front, system)))
    sheets = (
        FrontFigure(mark.names, mark.label, partial(sheet_of, front, mark.row, mark.label, system))
        for mark in marks(front)
    )
    return [*found, *sheets]


def sheet_of(front: ParetoFront, row: int, label: str, system: System = "metric") -> Figure:
    """Return the sheet of a design of a front. label: what it is among the others. system: of units."""
    mechanism = front.mechanism(row)
    crank, rod, offset = front.dimensions[row, :3]
    return design_sheet(
        mechanism,
        Linkage(crank, rod, offset, mechanism.branch),
        {str(key): value for key, value in front.designs.iloc[row].items()},
        title=f"{front.problem.name}: {label}",
        subtitle=f"design {row + 1} of {len(front)}",
        bold=[front.problem.quantity(objective.quantity).field for objective in front.objectives],
        system=system,
    )
