"""Friction of one design as text: self-locking, torque, forces, and the work of a turn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...text.lines import Line, show_lines

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    words = {
        "drives": "drives at every crank angle, whatever the load",
        "locks": "LOCKS: no crank torque drives the slider",
        "locks or may jam": "LOCKS at some crank angles, may jam at others",
        "may jam": "MAY JAM: the forces are not determined",
    }
    where = ", ".join(f"{a:.2f} to {b:.2f} deg" for a, b in numbers["locked_angles_deg"])
    heat, share = numbers["friction_heat_J"], ""
    if heat:
        joints = ("guide", "crank_pivot", "crank_pin", "slider_pin")
        parts = [(name, numbers[f"{name}_heat_J"] / heat) for name in joints if numbers[f"{name}_heat_J"]]
        share = ", ".join(f"{name.replace('_', ' ')} {100.0 * part:.3g} %" for name, part in parts)
    lines: list[Line] = [
        (
            "self-locking margin",
            numbers["self_locking_margin_deg"],
            "deg",
            f"least transmission angle {numbers['least_transmission_angle_deg']:.4g} less angles of friction",
        ),
        ("angle of friction, guide", numbers["guide_friction_angle_deg"], "deg", ""),
        ("angle of friction, pins", numbers["pin_friction_angle_deg"], "deg", ""),
    ]
    for name, key, unit in (
        ("peak torque", "torque", "Nm"),
        ("mean torque", "torque", "Nm"),
        ("peak guide force", "guide_force", "N"),
    ):
        stem = f"{name.split()[0]}_{key}"
        lines.append(
            (
                name,
                numbers[f"{stem}_{unit}"],
                "N m" if unit == "Nm" else unit,
                f"{numbers[f'{stem}_without_friction_{unit}']:.6g} without friction",
            )
        )
    lines += [
        ("input work a turn", numbers["input_work_J"], "J", ""),
        ("useful work a turn", numbers["useful_work_J"], "J", "against the load"),
        ("friction heat a turn", heat, "J", share),
    ]
    efficiency = numbers["efficiency"]
    remark = (
        "" if efficiency is not None else "the load takes no net work" if heat is not None else "nothing is determined"
    )
    lines.append(("efficiency", None if efficiency is None else 100.0 * efficiency, "%", remark))
    show_lines(console, f"Friction: {words[numbers['verdict']]}{f' ({where})' if where else ''}", lines)
