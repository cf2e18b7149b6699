"""Designs marked in the same way in every figure of a front: the best in each objective, and the knee."""

from dataclasses import dataclass
from typing import Any

from ...model.arrays import Array
from ...objectives.kinds import System, metric_unit_in
from ...objectives.tables.design_input import column_of_variable
from ...optimise.front.front import ParetoFront
from ...optimise.front.saved_front import is_constant
from ...optimise.problem.requirements import Objective
from ..render.numerals import title_with_unit
from .style import INK, KNEE_MARKER, MARKERS, VERMILION

BETTER = {"maximise": 1, "minimise": -1, "target": 0}
"""Direction of better values of an objective, upward positive, by its sense."""


def with_better_arrow(title: str, better: int) -> str:
    """Return an axis title with the direction of better values below it. better: as in `Axis`.

    This is also correct for y titles, which are rotated: there the arrows point up and down.
    """
    return f"{title}\n{'→' if better > 0 else '←'} better" if better else title


@dataclass(frozen=True)
class Mark:
    """Marked design. row: row in the front's table. names: its figure files. labels: as shown. size: in points."""

    row: int
    names: tuple[str, ...]
    labels: tuple[str, ...]
    marker: str
    size: float

    @property
    def label(self) -> str:
        """All labels as one line."""
        return ", ".join(self.labels)

    @property
    def colour(self) -> str:
        """Colour of marker and line: the knee stands out."""
        return VERMILION if self.marker == KNEE_MARKER else INK

    @property
    def style(self) -> dict[str, Any]:
        """Marker as arguments of `Axes.plot` and `Line2D`."""
        return {
            "marker": self.marker,
            "markersize": self.size,
            "markerfacecolor": "white",
            "markeredgecolor": self.colour,
            "markeredgewidth": 1.2,
            "linestyle": "none",
        }


@dataclass(frozen=True)
class Axis:
    """Column shown on an axis.

    title: with unit. values: (n,), as displayed. better: +1 upward, -1 downward, 0 neither.
    """

    title: str
    unit: str
    values: Array
    better: int

    @property
    def values_vary(self) -> bool:
        """Whether its values differ between designs by more than rounding."""
        return not is_constant(self.values)


def marked_designs(front: ParetoFront) -> list[Mark]:
    """Return the marked designs; one that is best in several objectives appears once. The knee comes last."""
    labels: dict[int, list[tuple[str, str]]] = {}
    for name, row in front.extremes().items():
        quantity = front.problem.quantity(name)
        file = name if name.isidentifier() else quantity.column_stem
        labels.setdefault(row, []).append((f"best_{file}", f"best {quantity.short_title}"))
    if len(front.objectives) > 1:
        labels.setdefault(front.knee(), []).append(("knee", "knee"))
    marked = []
    for order, (row, pairs) in enumerate(labels.items()):
        names, words = zip(*pairs, strict=True)
        if names == ("knee",):
            marker, size = KNEE_MARKER, 11.0
        else:  # decreasing sizes, so that marks at the same point stay visible
            marker, size = MARKERS[order % len(MARKERS)], max(5.5, 9.5 - order)
        marked.append(Mark(row, names, words, marker, size))
    return marked


def objective_axis(front: ParetoFront, objective: Objective, system: System = "metric") -> Axis:
    """Return the axis of an objective, in a unit system."""
    quantity = front.problem.quantity(objective.quantity)
    symbol, factor = metric_unit_in(quantity.unit.symbol, system)
    values = front.columns[quantity.field] * factor
    target = None if objective.target is None else objective.target * quantity.unit.factor * factor
    return Axis(title_with_unit(quantity.short_title, symbol, target), symbol, values, BETTER[objective.sense])


def dimension_axes(front: ParetoFront, system: System = "metric") -> list[Axis]:
    """Return the axes for crank, rod, offset and the extra variables, in a unit system."""
    columns = ("crank", "rod", "offset")
    length, unit_factor = metric_unit_in("mm", system)
    axes = [
        Axis(title_with_unit(name, length), length, 1e3 * unit_factor * front.dimensions[:, index], 0)
        for index, name in enumerate(columns)
    ]
    for index, item in enumerate(front.problem.mechanism.varying, start=3):
        unit = column_of_variable(item)[1]
        symbol, unit_factor = metric_unit_in(unit.symbol, system)
        title = title_with_unit(item.name.removeprefix("mechanism."), symbol)
        axes.append(Axis(title, symbol, unit.factor * unit_factor * front.dimensions[:, index], 0))
    return axes
