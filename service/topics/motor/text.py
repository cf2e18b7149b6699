"""Torque, power and reflected inertia for sizing the motor, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...text.lines import Line, show_lines

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""

    def at(key: str) -> str:
        return "" if numbers[key] is None else f"at {numbers[key]:.2f} deg"

    lines: list[Line] = [
        ("peak torque", numbers["peak_torque_Nm"], "N m", at("peak_torque_angle_deg")),
        ("RMS torque", numbers["rms_torque_Nm"], "N m", "what heats the motor"),
        ("mean torque", numbers["mean_torque_Nm"], "N m", ""),
        ("peak power", numbers["peak_power_W"], "W", at("peak_power_angle_deg")),
        ("mean power", numbers["mean_power_W"], "W", ""),
    ]
    for which in ("greatest", "least"):
        key = f"{which}_reflected_inertia"
        lines.append((f"{which} reflected inertia", numbers[f"{key}_kg_m2"], "kg m²", at(f"{key}_angle_deg")))
    lines.append(("mean reflected inertia", numbers["mean_reflected_inertia_kg_m2"], "kg m²", ""))
    title = (
        "Motor"
        if numbers["peak_torque_Nm"] is not None
        else "Motor: friction locks or jams the linkage, no torque is determined"
    )
    show_lines(console, title, lines)
