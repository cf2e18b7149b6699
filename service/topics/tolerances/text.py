"""Position error from tolerances as text: worst case, root-sum-square, Monte Carlo, contributions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    from rich.table import Table

    from ...text.tables import print_table

    exact, angle = numbers["exact_worst_case_mm"], numbers["exact_worst_case_angle_deg"]
    console.print("Position error from tolerances, greatest over the counted part of the cycle", style="bold")
    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    for _ in range(2):
        table.add_column(no_wrap=True)
    table.add_row("worst case, first order", _at(numbers["worst_case_mm"], numbers["worst_case_angle_deg"]))
    table.add_row(
        "worst case, exact",
        "not defined: a linkage within the tolerances does not turn fully" if exact is None else _at(exact, angle),
    )
    table.add_row("root-sum-square", _at(numbers["root_sum_square_mm"], numbers["root_sum_square_angle_deg"]))
    simulation = numbers["monte_carlo"]
    spread = ", ".join(
        f"{percent} % within {value:.4g} mm" for percent, value in simulation["percentiles_greatest_mm"].items()
    )
    table.add_row(f"{simulation['samples']:,} random machines", spread or "-")
    if simulation["stuck"]:
        table.add_row("", f"{simulation['stuck']:,} of them do not turn fully")
    for found in numbers["yields"]:
        low, high = found["yield_low_percent"], found["yield_high_percent"]
        table.add_row(
            f"yield at {found['limit_mm']:.4g} mm ({found['limit']})",
            f"{found['yield_percent']:.2f} %, between {low:.2f} and {high:.2f} % "
            f"at {found['confidence_percent']:g} % confidence",
        )
    print_table(console, table)
    if any(row["source"].endswith("clearance") for row in numbers["contributions"]):
        note = (
            "The root-sum-square takes a clearance for three standard deviations; pins pressed to either side scatter"
        )
        console.print(f"{note} wider, as the random machines show.", style="dim", soft_wrap=True)
    console.print()
    shares = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    shares.add_column("where it comes from")
    for title in ("limit", "adds, mm", "of worst case", "of variance"):
        shares.add_column(title, justify="right", no_wrap=True)
    for row in numbers["contributions"]:
        limit = f"{row['limit_deg']:.4g} deg" if row["limit_mm"] is None else f"{row['limit_mm']:.4g} mm"
        of_worst, of_variance = row["share_of_worst_case_percent"], row["share_of_variance_percent"]
        shares.add_row(
            row["source"], limit, f"{row['contribution_mm']:.4g}", f"{of_worst:.1f} %", f"{of_variance:.1f} %"
        )
    print_table(console, shares)


def _at(size: float, angle: float) -> str:
    return f"{size:.4g} mm at {angle:.4g} deg"
