"""Textbook approximations next to the exact model, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write one line for each approximation."""
    from rich import box
    from rich.table import Table

    from ...text.tables import print_table

    console.print("Approximate models, inertia alone, at constant speed", style="bold", soft_wrap=True)
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1), show_edge=False, pad_edge=False)
    table.add_column("model")
    table.add_column("peak", justify="right", no_wrap=True)
    table.add_column("error", justify="right", no_wrap=True)
    for offset in numbers["offset_mm"]:
        table.add_column(f"e = {offset:.4g} mm", justify="right", no_wrap=True)
    for what, unit, key, exact in (
        ("slider acceleration", "m/s^2", "accelerations", "exact_peak_acceleration_m_s2"),
        ("inertia torque", "N m", "torques", "exact_peak_torque_Nm"),
    ):
        table.add_row(f"{what}, {unit}, exact", f"{numbers[exact]:.5g}", style="bold")
        for entry in numbers[key]:
            peak = next(value for name, value in entry.items() if name.startswith("peak_"))
            errors = (entry["error_percent"], *entry["error_over_offset_percent"])
            table.add_row(f"  {entry['name']}", f"{peak:.5g}", *map(_shown, errors))
    print_table(console, table)
    console.print("Errors: greatest over the cycle, share of the exact peak; right: with other offsets.", style="dim")


def _shown(percent: float | None) -> str:
    return "-" if percent is None else f"{percent:.3g} %"
