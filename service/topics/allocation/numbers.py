"""Tolerances of least cost as numbers, and the cost and error of those that a mechanism has."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism
    from ....optimise.problem.costs import Costs
    from ....optimise.sizing.tolerance_allocation import Allocation


def allocation_numbers(found: Allocation, linkage: Linkage, costs: Costs, before: Mechanism) -> dict[str, Any]:
    """Return an allocation ready for JSON.

    before: the mechanism as it was; cost and error of its own tolerances are None unless it has all that have a cost.
    The exact worst case is None where a linkage within the tolerances does not turn.
    """
    import numpy as np

    from ....model.errors import AssemblyError
    from ....model.tolerance.exact import worst

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
        "error_before_mm": None if was is None else 1e3 * error_of(found, linkage, before),
        "rounds": found.rounds,
        "residual": found.residual,
        "converged": found.converged,
    }


def costs_before(costs: Costs, linkage: Linkage, before: Mechanism) -> dict[str, float] | None:
    """Return the cost of each tolerance of a mechanism, by name; None if one with a cost is zero."""
    from ....model.tolerance.sources import limits
    from ....optimise.problem.costs import NAMES

    reach = dict(zip(NAMES, limits(before, linkage)[: len(NAMES)], strict=True))
    if not all(reach[name] > 0.0 for name in costs.given):
        return None
    return {name: cost.of(float(reach[name])) for name, cost in costs.given.items()}


def error_of(found: Allocation, linkage: Linkage, mechanism: Mechanism) -> float:
    """Return the greatest first-order error, m, of a mechanism, added up as in an allocation."""
    import numpy as np

    from ....model.signals.peaks import find_peaks
    from ....model.signals.signals import Signal

    kind = Signal.POSITION_ERROR if found.kind == "worst case" else Signal.POSITION_ERROR_RSS
    design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    return float(find_peaks(mechanism, kind, design, kept=1).values[0, 0])
