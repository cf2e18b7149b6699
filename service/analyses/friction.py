"""Friction of one design: self-locking, what friction adds to torque and forces, where the work of a turn goes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from .lines import Line, plain, show_lines

if TYPE_CHECKING:
    from rich.console import Console

    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return verdict, torque with and without friction, energies of a turn and efficiency of one linkage.

    What is not defined is None: torques and energies of a linkage that locks, the efficiency if the load takes no net
    work.
    """
    import numpy as np

    from ...model.cycle.efficiency import energies
    from ...model.cycle.locked_angles import verdict
    from ...model.machine.friction import Friction
    from ...model.signals.averages import average_torque
    from ...model.signals.peaks import find_peaks
    from ...model.signals.signals import Signal

    design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    friction = mechanism.friction
    found = verdict(mechanism, linkage)
    smooth = replace(mechanism, friction=Friction())
    circles = friction.crank_pin.circle + friction.slider_pin.circle
    pins = circles / float(linkage.rod)

    def peak(of: Mechanism, kind: Signal) -> float | None:
        return plain(find_peaks(of, kind, design, kept=1).values[0, 0])

    values: dict[str, Any] = {
        "verdict": "drives" if found.holds is None and not found.locks else _word(found.holds),
        "self_locking_margin_deg": plain(math.degrees(found.margin)),
        "least_transmission_angle_deg": math.degrees(float(linkage.least_transmission_angle)),
        "guide_friction_angle_deg": math.degrees(math.atan(friction.guide)),
        "pin_friction_angle_deg": math.degrees(math.asin(pins)) if pins < 1.0 else None,
        "locked_angles_deg": [[math.degrees(a) % 360.0, math.degrees(b) % 360.0] for a, b in found.locked],
        "peak_torque_Nm": peak(mechanism, Signal.TORQUE),
        "peak_torque_without_friction_Nm": peak(smooth, Signal.TORQUE),
        "mean_torque_Nm": plain(average_torque(mechanism, design).mean[0]),
        "mean_torque_without_friction_Nm": plain(average_torque(smooth, design).mean[0]),
        "peak_guide_force_N": peak(mechanism, Signal.GUIDE_FORCE),
        "peak_guide_force_without_friction_N": peak(smooth, Signal.GUIDE_FORCE),
    }
    work = None if found.locks else energies(mechanism, linkage)
    for key, name in (
        ("input_work_J", "input"),
        ("useful_work_J", "useful"),
        ("friction_heat_J", "heat"),
        ("guide_heat_J", "guide_heat"),
        ("crank_pivot_heat_J", "crank_pivot_heat"),
        ("crank_pin_heat_J", "crank_pin_heat"),
        ("slider_pin_heat_J", "slider_pin_heat"),
        ("efficiency", "efficiency"),
    ):
        values[key] = None if work is None else getattr(work, name)
    return values


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


def _word(holds: float | None) -> str:
    if holds is None:  # a single angle, at a margin of exactly zero
        return "may jam"
    return "locks" if holds == 1.0 else "may jam" if holds == 0.0 else "locks or may jam"
