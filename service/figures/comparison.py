"""Several fronts in one scatter matrix, each with its marker: fronts of runs, or robust and nominal fronts."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...model.arrays import Array
from ...objectives.kinds import count_with_noun, unit_text
from ...optimise.decisions.price_of_robustness import robust_cost
from ...optimise.front.front import ParetoFront
from ...optimise.problem.robust_problem import robust_quantities
from ..render.numerals import title_with_unit
from ..runs.result import StoredObjective, stored_objectives
from .design_marks import BETTER, with_better_arrow
from .scatter_matrix import MOST, triangle_of_panels
from .style import INK, SMALL, add_legend, new_figure, padded_limits, style_axes, write_heading, write_text

# Fill, edge and marker: neighbours differ clearly in greyscale, with the colours of Okabe and Ito (see `style`).
_STYLES = (
    ("#0072b2", "#0072b2", "o"),
    ("none", "#d55e00", "s"),
    ("#000000", "#000000", "x"),
    ("none", "#009e73", "D"),
    ("#cc79a7", INK, "v"),
    ("none", INK, "P"),
    ("#56b4e9", INK, "*"),
    ("#f0e442", INK, "^"),
)
MOST_RUNS = len(_STYLES)
"""Maximum number of runs that can be told apart in one figure."""
_LEFT, _BOTTOM, _TOP, _RIGHT, _GAP, _KEY, _NOTE = 0.95, 0.75, 0.55, 0.3, 0.18, 0.24, 0.18  # inches


@dataclass(frozen=True)
class PlottedRun:
    """Run in the figure. label: text in the legend. values: its objectives (n, m), in display units."""

    label: str
    values: Array


def comparison_matrix(
    runs: Sequence[PlottedRun],
    objectives: Sequence[StoredObjective],
    *,
    title: str = "Fronts compared",
    notes: Sequence[str] = (),
) -> Figure:
    """Return the scatter matrix for the fronts of several runs with at least two objectives. notes: lines below it."""
    count = min(len(objectives), MOST) - 1
    side = max(1.6, min(4.2 if count == 1 else 2.6, 8.4 / count))
    width = max(_LEFT + count * (side + _GAP) + _RIGHT, 6.4)
    key = _KEY * len(runs) + 0.2
    notes_height = _NOTE * len(notes) + 0.2 if notes else 0.0
    bottom = _BOTTOM + notes_height
    figure = new_figure(width, bottom + count * (side + _GAP) + _TOP + key)
    labels = [_axis_label(objective) for objective in objectives[:MOST]]
    for panel, x_column, y_column in triangle_of_panels(figure, labels, left=_LEFT, bottom=bottom, side=side, gap=_GAP):
        _draw_panel(panel, runs, x_column, y_column)
    height = figure.get_size_inches()[1]
    subtitle = f"the first {MOST} of {len(objectives)} objectives" if len(objectives) > MOST else ""
    write_heading(figure, title, subtitle, left=0.2)
    for line, note in enumerate(notes):
        write_text(figure, 0.2, notes_height - 0.1 - _NOTE * line, note, fontsize=SMALL, va="center")
    handles = [Line2D([], [], **_line_style(index)) for index in range(len(runs))]
    labels = [f"{run.label}, {count_with_noun(len(run.values), 'design')}" for run in runs]
    add_legend(figure, 0.2, height - _TOP, handles, labels)
    return figure


def robustness_figure(front: ParetoFront) -> Figure | None:
    """Return nominal and robust front in one scatter matrix, with the cost of robustness below.

    Returns None if there is no nominal front to compare with.
    """
    comparison = robust_cost(front)
    if comparison is None:
        return None
    first = robust_quantities(front.problem)[0]
    kind = first.case if first.case == "worst case" else f"{100.0 * first.share:.6g} % of machines"
    inner = {quantity.name: quantity.inner.title for quantity in robust_quantities(front.problem)}
    axes = [replace(item, title=inner.get(item.quantity, item.title)) for item in stored_objectives(front.problem)]
    runs = [
        PlottedRun("nominal front, without errors", comparison.nominal),
        PlottedRun(f"robust front, within tolerances ({kind})", comparison.robust),
        PlottedRun(
            f"nominal front's designs within tolerances, {comparison.keeps} meet all requirements",
            np.where(np.isfinite(comparison.toleranced), comparison.toleranced, np.nan),
        ),
    ]
    notes = ["Cost of robustness, best design of each front:"]
    for column, item in enumerate(axes):
        if item.target is not None:
            continue
        best = np.max if item.sense == "maximise" else np.min
        unit = unit_text(item.unit)
        before, after = float(best(comparison.nominal[:, column])), float(best(comparison.robust[:, column]))
        cost = comparison.cost_of_robustness(column, maximised=item.sense == "maximise")
        title = item.title.removesuffix(", worst case")
        change = f"{before:.5g} → {after:.5g} {unit}".rstrip()
        notes.append(f"   {title}: {change}, cost {cost:.2g} {unit}".rstrip())
    return comparison_matrix(runs, axes, title=f"{front.problem.name}: nominal and robust front", notes=notes)


def _draw_panel(panel: Axes, runs: Sequence[PlottedRun], x_column: int, y_column: int) -> None:
    style_axes(panel)
    for index, run in enumerate(runs):
        panel.plot(run.values[:, x_column], run.values[:, y_column], **_line_style(index), zorder=2 + 0.01 * index)
    for column, set_limits in ((x_column, panel.set_xlim), (y_column, panel.set_ylim)):
        values = np.concatenate([run.values[:, column] for run in runs])
        set_limits(padded_limits(values.min(), values.max()))


def _line_style(index: int) -> dict[str, Any]:
    fill, edge, marker = _STYLES[index]
    return {
        "marker": marker,
        "markersize": 4.6,
        "markerfacecolor": fill,
        "markeredgecolor": edge,
        "markeredgewidth": 0.9,
        "linestyle": "none",
    }


def _axis_label(objective: StoredObjective) -> str:
    title = title_with_unit(objective.title.removesuffix(", worst case"), objective.unit, objective.target)
    return with_better_arrow(title, BETTER[objective.sense])
