"""Start from rest and steady running as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers as a short table."""
    from rich.table import Table

    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column("quantity")
    table.add_column("value", justify="right")
    table.add_column("unit")
    console.print(f"Start from rest: {numbers['message']}.", soft_wrap=True)
    rows = [
        ("speed reached", "final_speed_rpm", "rpm"),
        ("peak motor torque, on the crank", "peak_motor_torque_Nm", "N m"),
        ("peak torque into the mechanism", "peak_torque_Nm", "N m"),
        ("peak motor power", "peak_power_W", "W"),
        ("work of the motor", "motor_work_J", "J"),
        ("work on the loads", "load_work_J", "J"),
        ("kinetic energy gained", "kinetic_energy_gained_J", "J"),
        ("error of the energy balance", "energy_imbalance", ""),
    ]
    for title, key, unit in rows:
        table.add_row(title, f"{numbers[key]:.4g}", unit)
    steady = numbers["steady"]
    if steady is not None:
        for title, key, unit in (
            ("steady running: mean speed", "mean_speed_rpm", "rpm"),
            ("coefficient of speed fluctuation", "fluctuation", ""),
            ("peak motor torque", "peak_motor_torque_Nm", "N m"),
            ("mean motor power", "mean_power_W", "W"),
        ):
            table.add_row(title, f"{steady[key]:.4g}", unit)
    console.print(table)
    if steady is None:
        console.print(f"No steady running: {numbers['why_not_steady']}.", soft_wrap=True)
