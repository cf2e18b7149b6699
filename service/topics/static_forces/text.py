"""Static forces over the cycle as a table: peaks, and values every 30 deg."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the peaks and the forces every 30 deg."""
    from rich import box
    from rich.table import Table

    from ...text.tables import print_table

    console.print(f"Static forces, without masses and friction ({numbers['load']})", style="bold", soft_wrap=True)
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1), show_edge=False, pad_edge=False)
    columns = (
        ("crank angle\ndeg", "crank_angle_deg"),
        ("load\nN", "load_N"),
        ("rod force\nN", "rod_force_N"),
        ("guide\nN", "guide_reaction_N"),
        ("crank torque\nN m", "crank_torque_Nm"),
        ("mechanical\nadvantage", "mechanical_advantage"),
    )
    for title, _ in columns:
        table.add_column(title, justify="right", no_wrap=True)
    for row in zip(*(numbers[key] for _, key in columns), strict=True):
        table.add_row(*("unbounded" if value is None else f"{value:.4g}" for value in row))
    print_table(console, table)
    for what, key, unit in (
        ("rod force", "peak_rod_force_N", " N"),
        ("guide reaction", "peak_guide_reaction_N", " N"),
        ("crank torque", "peak_crank_torque_Nm", " N m"),
    ):
        at = numbers[f"{key.rpartition('_')[0]}_angle_deg"]
        console.print(f"greatest {what} {numbers[key]:.6g}{unit} at {at:.2f} deg", soft_wrap=True)
    console.print(
        f"least mechanical advantage {numbers['least_mechanical_advantage']:.6g} at "
        f"{numbers['least_mechanical_advantage_angle_deg']:.2f} deg (slider load over tangential crank pin force)",
        soft_wrap=True,
    )
