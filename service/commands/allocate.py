"""`slidercrank allocate`: tolerances of least cost within a limit of the position error."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ..runs.result import json_text
from ..runs.run_folder import disk
from .options import length_option, value_option
from .screen import console, give, say, waiting

if TYPE_CHECKING:
    from rich.console import Console

    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...optimise.problem.costs import Costs
    from ...optimise.sizing.tolerance_allocation import Allocation

_TITLES = {"crank": "crank", "rod": "rod", "offset": "offset", "crank_angle": "crank angle"}


def allocate(
    job: Annotated[Path, typer.Argument(metavar="JOB", help="A job file with [costs].")],
    limit: Annotated[str, typer.Option(metavar="LENGTH", help='Position error that is allowed, such as "0.1 mm".')],
    crank: Annotated[str | None, typer.Option(metavar="LENGTH", help="Crank, unless fixed by JOB.")] = None,
    rod: Annotated[str | None, typer.Option(metavar="LENGTH", help="Connecting rod, likewise.")] = None,
    offset: Annotated[str | None, typer.Option(metavar="LENGTH", help="Offset, likewise.")] = None,
    kind: Annotated[
        str, typer.Option(metavar="KIND", help='How errors add up: "worst case" or "rss" (root-sum-square).')
    ] = "worst case",
    figures: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Draw error and costs into allocation.png there.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print only JSON on standard output.")] = False,
) -> None:
    """Find the tolerances of least manufacturing cost that keep the position error within a limit.

    At every crank angle of the part of the stroke that [tolerances] counts. What has no cost in [costs] keeps its
    tolerance, and takes its part of the limit; so do the clearances.
    """
    from ...model.linkage.linkage import Linkage
    from ...objectives.kinds import LENGTH
    from ...optimise.job import load_job
    from ...optimise.sizing import tolerance_allocation as convex

    problem = load_job(job)
    if problem.costs is None:
        raise InputError(
            "an allocation needs what the tolerances cost; got a job without [costs]; "
            'add for example [costs] crank = { cost = 8.0, at = "0.05 mm" }'
        )
    lengths = [
        length_option(name, text, problem) for name, text in (("crank", crank), ("rod", rod), ("offset", offset))
    ]
    most = value_option("--limit", limit, LENGTH, sign="positive")
    mechanism = problem.mechanism
    linkage = Linkage(lengths[0], lengths[1], lengths[2], mechanism.branch)
    words: Any = kind.strip().casefold().replace("-", " ").replace("_", " ")
    found = convex.allocate(linkage, problem.costs, most, words, mechanism=mechanism)
    numbers = allocation_numbers(found, linkage, problem.costs, mechanism)
    if json:
        give(json_text(numbers))
    else:
        show(console(), numbers)
    if not found.converged:
        say(f"not proven to be the cheapest: the optimality conditions are met to {found.residual:.1e} only")
    if figures is not None:
        from ..figures.allocation import draw_allocation

        with disk(figures), waiting("drawing the figure"):
            figures.mkdir(parents=True, exist_ok=True)
            file = draw_allocation(found, linkage, problem.costs, mechanism, figures / "allocation.png")
        say(f"figure: {file}")


def allocation_numbers(found: Allocation, linkage: Linkage, costs: Costs, before: Mechanism) -> dict[str, Any]:
    """Return an allocation ready for JSON.

    before: the mechanism as it was; cost and error of its own tolerances are None unless it has all that have a cost.
    The exact worst case is None where a linkage within the tolerances does not turn.
    """
    import numpy as np

    from ...model.errors import AssemblyError
    from ...model.tolerance.exact import worst

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
    """Return what the tolerances of a mechanism cost, by name; None if one that has a cost is zero."""
    from ...model.tolerance.sources import limits
    from ...optimise.problem.costs import NAMES

    reach = dict(zip(NAMES, limits(before, linkage)[: len(NAMES)], strict=True))
    if not all(reach[name] > 0.0 for name in costs.given):
        return None
    return {name: cost.of(float(reach[name])) for name, cost in costs.given.items()}


def error_of(found: Allocation, linkage: Linkage, mechanism: Mechanism) -> float:
    """Return the greatest first-order error, m, of a mechanism, added up as in an allocation."""
    import numpy as np

    from ...model.signals.peaks import find_peaks
    from ...model.signals.signals import Signal

    kind = Signal.POSITION_ERROR if found.kind == "worst case" else Signal.POSITION_ERROR_RSS
    design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    return float(find_peaks(mechanism, kind, design, kept=1).values[0, 0])


def show(screen: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    from rich.table import Table

    from .tables import print_table

    kind = "worst case" if numbers["kind"] == "worst case" else "root-sum-square"
    screen.print(f"Tolerances of least cost for {numbers['limit_mm']:.6g} mm of position error, {kind}", style="bold")
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column("tolerance of")
    for title in ("±", "costs", "share"):
        table.add_column(title, justify="right", no_wrap=True)
    table.add_column("")
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
        table.add_row(_TITLES[row["name"]], size, f"{row['cost']:.5g}", share, note)
    table.add_row("together", "", f"{numbers['cost']:.5g}", "", _before(numbers))
    print_table(screen, table)
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
