"""Tolerances of least cost as numbers and text, and the cost and error of those that a mechanism has."""

from __future__ import annotations

from typing import Any

import numpy as np
from rich.console import Console

from ....model.errors import AssemblyError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.signals.signals import Signal
from ....model.tolerance.exact import worst
from ....model.tolerance.sources import limits
from ....optimise.problem.costs import NAMES, Costs
from ....optimise.sizing.tolerance_allocation import Allocation
from ...text.tables import print_table, table
from ..peaks import peak


def numbers(found: Allocation, linkage: Linkage, costs: Costs, before: Mechanism) -> dict[str, Any]:
    """Return an allocation ready for JSON.

    before: the mechanism as it was; cost and error of its own tolerances are None unless it has all that have a cost.
    The exact worst case is None where a linkage within the tolerances does not turn.
    """
    try:
        exact = 1e3 * worst(found.mechanism, linkage).size
    except AssemblyError:
        exact = None
    tolerances = []
    for part in found.parts:
        angle = part.name == "crank_angle"
        unit = float(np.degrees(1.0)) if angle else 1e3
        tolerances.append(
            {
                "name": part.name,
                "tolerance_mm": None if angle else unit * part.tolerance,
                "tolerance_deg": unit * part.tolerance if angle else None,
                "cost": part.cost,
                "share_of_cost_percent": 100.0 * part.cost / found.cost,
                "bound": part.bound,
                "bound_saving_per_um": None if angle else 1e-6 * part.saving,
                "bound_saving_per_mdeg": 1e-3 * part.saving / unit if angle else None,
            }
        )
    was = costs_before(costs, linkage, before)
    error = Signal.POSITION_ERROR if found.kind == "worst case" else Signal.POSITION_ERROR_RSS
    return {
        "kind": found.kind,
        "limit_mm": 1e3 * found.limit,
        "cost": found.cost,
        "error_mm": 1e3 * found.error,
        "exact_worst_case_mm": exact,
        "saving_per_um": 1e-6 * found.saving,
        "tolerances": tolerances,
        "active_angles": [
            {"crank_angle_deg": float(np.degrees(angle)), "saving_per_um": 1e-6 * float(saving)}
            for angle, saving in zip(found.angles, found.savings, strict=True)
        ],
        "cost_before": None if was is None else sum(was.values()),
        "error_before_mm": None if was is None else 1e3 * peak(before, error, linkage).value,
        "rounds": found.rounds,
        "residual": found.residual,
        "converged": found.converged,
    }


def costs_before(costs: Costs, linkage: Linkage, before: Mechanism) -> dict[str, float] | None:
    """Return the cost of each tolerance of a mechanism, by name; None if one with a cost is zero."""
    reach = dict(zip(NAMES, limits(before, linkage)[: len(NAMES)], strict=True))
    if not all(reach[name] > 0.0 for name in costs.given):
        return None
    return {name: cost.of(float(reach[name])) for name, cost in costs.given.items()}


def show(screen: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    kind = "worst case" if numbers["kind"] == "worst case" else "root-sum-square"
    screen.print(f"Tolerances of least cost for {numbers['limit_mm']:.6g} mm of position error, {kind}", style="bold")
    rows = table("tolerance of", ">±", ">costs", ">share", "")
    for row in numbers["tolerances"]:
        angle = row["tolerance_mm"] is None
        size = f"{row['tolerance_deg']:.5g} deg" if angle else f"{row['tolerance_mm']:.5g} mm"
        saving = (
            f"{row['bound_saving_per_mdeg']:.4g} for each 0.001 deg"
            if angle
            else f"{row['bound_saving_per_um']:.4g} for each µm"
        )
        note = f"the {row['bound']} that is possible; beyond it would save {saving}" if row["bound"] else ""
        share = f"{row['share_of_cost_percent']:.1f} %"
        rows.add_row(row["name"].replace("_", " "), size, f"{row['cost']:.5g}", share, note)
    rows.add_row("together", "", f"{numbers['cost']:.5g}", "", _before(numbers))
    print_table(screen, rows)
    screen.print()
    exact = numbers["exact_worst_case_mm"]
    also = "" if exact is None else f"; exact worst case {exact:.6g} mm"
    screen.print(f"greatest error {numbers['error_mm']:.6g} mm{also}", soft_wrap=True)
    if numbers["active_angles"]:
        at = ", ".join(f"{row['crank_angle_deg']:.4g}" for row in numbers["active_angles"])
        saving = numbers["saving_per_um"]
        screen.print(f"the limit holds at {at} deg; one µm more of it saves {saving:.4g}", soft_wrap=True)
    else:
        screen.print("the limit holds nothing back: every tolerance is the greatest that is allowed")


def _before(numbers: dict[str, Any]) -> str:
    if numbers["cost_before"] is None:
        return ""
    return f"in the job: {numbers['cost_before']:.5g}, for {numbers['error_before_mm']:.4g} mm"
