"""The flywheel of a machine as text: one sentence and a short table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers as a sentence and a short table."""
    from rich.table import Table

    wanted, inertia = numbers["wanted_fluctuation"], numbers["flywheel_kgm2"]
    bare, steady = numbers["fluctuation_without_flywheel"], numbers["steady"]
    slowest = numbers["least_speed_without_flywheel_rpm"]
    if bare is None:
        without = "no steady running was found"
    elif slowest:
        without = f"it is {bare:.4g} (least speed {slowest:.4g} rpm)"
    else:
        without = f"it is {bare:.4g}: the crank all but stops, below a millionth of its greatest speed"
    console.print(
        f"Flywheel on the crank shaft for a speed fluctuation of {wanted:g}: {inertia:.5g} kg m² "
        f"(classical estimate {numbers['classical_estimate_kgm2']:.5g}); without one {without}."
        if inertia
        else f"No flywheel is needed for a speed fluctuation of {wanted:g}: without one {without}.",
        soft_wrap=True,
    )
    console.print(
        "Fluctuation: (greatest - least speed) / mean speed; mean speed: a turn over its time.", soft_wrap=True
    )
    console.print(
        f"{'With it' if inertia else 'So'}: mean speed {steady['mean_speed_rpm']:.5g} rpm, motor torque up to "
        f"{steady['peak_motor_torque_Nm']:.4g} N m on the crank, mean power {steady['mean_power_W']:.4g} W.",
        soft_wrap=True,
    )
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for title in ("fluctuation", "flywheel, kg m²", "classical, kg m²"):
        table.add_column(title, justify="right")
    for row in zip(
        numbers["fluctuations"], numbers["flywheels_kgm2"], numbers["classical_estimates_kgm2"], strict=True
    ):
        table.add_row(*(f"{value:.4g}" for value in row))
    console.print(table)
