"""Tolerances of least cost as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


_TITLES = {"crank": "crank", "rod": "rod", "offset": "offset", "crank_angle": "crank angle"}


def show(screen: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    from rich.table import Table

    from ...text.tables import print_table

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
