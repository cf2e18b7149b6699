"""Allocated tolerances: the contribution of each to the position error over the cycle, and its cost."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ....model.arrays import Array
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.tolerance.error_distributions import SOURCES, angle_ranges_where_error_counts
from ....model.tolerance.exact_worst_case import FirstOrder, first_order_position_errors
from ....objectives.kinds import LENGTH, System
from ....optimise.problem.tolerance_costs import Costs, costs_of_tolerances
from ....optimise.sizing.tolerance_allocation import Allocation
from ...figures import style
from ...render.numerals import format_number, title_with_unit

_SAMPLES = 721


@dataclass(frozen=True)
class AllocationCurves:
    """Data of the figure: errors in m over crank angles (m,), deg.

    sources: names of the error sources (s,). parts: contribution of each (s, m), its term (worst case) or its fraction
    of the squares times the error (root-sum-square), so that both add up to the error. before: error (m,) with the
    original tolerances; None if some were missing. limit: error limit, m. counted: crank angles (from, to), deg, of the
    parts of the cycle that count. active: crank angles of active limits, deg. names, costs, costs_before: names and
    costs of the chosen tolerances.
    """

    angles: Array
    sources: tuple[str, ...]
    parts: Array
    error_before: Array | None
    limit: float
    counted: tuple[tuple[float, float], ...]
    active: Array
    names: tuple[str, ...]
    costs: Array
    costs_before: Array | None
    kind: str


def allocation_curves(allocation: Allocation, linkage: Linkage, costs: Costs, before: Mechanism) -> AllocationCurves:
    """Return the data of the figure. before: mechanism with its original tolerances."""
    theta = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    now = first_order_position_errors(allocation.mechanism, linkage, theta)
    share, error = _cumulated_error(now, allocation.kind)
    contributes = now.contributions.max(axis=1) > 0.0
    was = costs_of_tolerances(costs, linkage, before)
    spans = [
        (float(np.degrees(part[0])), float(np.degrees(part[-1])))
        for part in angle_ranges_where_error_counts(before, linkage)
    ]
    return AllocationCurves(
        np.degrees(theta),
        tuple(name for name, adds in zip(SOURCES, contributes, strict=True) if adds),
        (share * error)[contributes],
        None
        if was is None
        else _cumulated_error(first_order_position_errors(before, linkage, theta), allocation.kind)[1],
        allocation.limit,
        tuple(spans),
        np.degrees(allocation.angles),
        tuple(part.name.replace("_", " ") for part in allocation.parts),
        np.array([part.cost for part in allocation.parts]),
        None if was is None else np.array(list(was.values())),
        "worst case" if allocation.kind == "worst case" else "root-sum-square",
    )


def _cumulated_error(linear: FirstOrder, kind: str) -> tuple[Array, Array]:
    """Return the contributions of the sources (8, m) and the error (m,), m, combined as in an allocation."""
    if kind == "worst case":
        return linear.share_of_worst_case, linear.worst_case
    return linear.share_of_variance, linear.root_sum_square


def allocation_figure(data: AllocationCurves, system: System = "metric") -> Figure:
    """Return the figure in a unit system: the error over the cycle above, the costs below."""
    unit = LENGTH.display_unit(system)
    limit = unit.factor * data.limit
    count = len(data.names)
    foot = 0.55 + 0.42 * count
    figure = style.new_figure(9.2, foot + 4.25)
    gaps = _uncounted_ranges(data.counted)
    note = f"{data.kind} within {format_number(limit)} {unit.symbol}" + ("; pale: not counted" if gaps else "")
    style.write_heading(figure, "Least-cost tolerances", note)
    error = style.add_axes(figure, 0.8, foot + 0.85, 5.9, 2.7)
    style.style_axes(error, most_y_ticks=6)
    style.show_full_turn(error)
    style.draw_stack(error, data.angles, unit.factor * data.parts, data.sources)
    if data.error_before is not None:
        errors = unit.factor * data.error_before
        error.plot(data.angles, errors, color=style.BLUE, linewidth=1.3, linestyle=":", label="as in the job")
    error.axhline(limit, color=style.VERMILION, linewidth=1.4, linestyle=(0, (6, 2)), label="limit")
    error.plot(
        data.active, np.full(len(data.active), limit), linestyle="none", marker="o", markersize=6,
        markerfacecolor="white", markeredgecolor=style.VERMILION, markeredgewidth=1.5, label="limit reached", zorder=5,
    )  # fmt: skip
    for start, end in gaps:
        error.axvspan(start, end, color=style.SHADE, alpha=0.8, linewidth=0, zorder=4)
    tops = [
        float(data.parts.sum(axis=0).max()),
        data.limit,
        *([] if data.error_before is None else [data.error_before.max()]),
    ]
    error.set_ylim(0.0, 1.06 * unit.factor * max(tops))
    error.set_ylabel(title_with_unit("position error", unit.symbol), fontsize=style.TEXT)
    error.set_xlabel("crank angle, deg", fontsize=style.TEXT)
    style.add_legend_at_right(error, stacked=len(data.sources))

    cost = style.add_axes(figure, 1.3, 0.5, 5.4, foot - 0.35)
    style.style_axes(cost, most_x_ticks=8)
    cost.grid(False, axis="y")
    rows = np.arange(count)[::-1]
    before = data.costs_before
    thick, shift = (0.55, 0.0) if before is None else (0.36, 0.2)
    bars: list[tuple[str, Array, float, dict[str, Any]]] = [("now", data.costs, shift, {"color": style.GREYS[0]})]
    if before is not None:
        bars.append(("as in the job", before, -shift, {"color": "white", "edgecolor": style.BLUE, "hatch": "///"}))
    for name, costs, at, look in bars:
        drawn = cost.barh(rows + at, costs, height=thick, label=f"{name}, {format_number(costs.sum())}", **look)
        cost.bar_label(
            drawn, [format_number(value) for value in costs], padding=3, fontsize=style.SMALL, color=style.INK
        )
    cost.set_yticks(rows, data.names, fontsize=style.TEXT)
    cost.set_ylim(-0.6, count - 0.4)
    cost.margins(x=0.12)
    cost.set_xlim(left=0.0)
    cost.set_xlabel("cost", fontsize=style.TEXT)
    style.add_legend_at_right(cost)
    return figure


def _uncounted_ranges(counted: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
    """Return the crank angle ranges within 0 to 360 deg that do not count."""
    counted_spans = sorted(
        (max(start + shift, 0.0), min(end + shift, 360.0))
        for start, end in counted
        for shift in (-360.0, 0.0, 360.0)
        if start + shift < 360.0 and end + shift > 0.0
    )
    edges = [0.0, *(end for span in counted_spans for end in span), 360.0]
    return [(start, end) for start, end in zip(edges[::2], edges[1::2], strict=True) if end - start > 1e-6]
