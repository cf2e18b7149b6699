"""The counterweight of least shaking, and the shaking before and after it: numbers, text and figure."""

from __future__ import annotations

from typing import Any

import numpy as np
from rich.console import Console

from ....optimise.sizing.counterweight import Balance, Shaking
from ...figures.numerals import shown
from ...figures.sheets import Line, Panel, Sheet, over_turn
from ...text import tables as text

_SAMPLES = 1441


def numbers(found: Balance, measure: str) -> dict[str, Any]:
    """Return a balance ready for JSON; the angle of the counterweight is from the crank's direction."""
    rod = found.rod
    weighs = rod is not None and rod.mass > 0.0
    return {
        "measure": measure,
        "counterweight_moment_kg_m": found.moment,
        "counterweight_angle_deg": float(np.degrees(found.angle)),
        "counterweight_radius_mm": 1e3 * found.radius,
        "counterweight_kg": found.mass,
        "rod_balance": None
        if rod is None
        else {
            "mass_kg": rod.mass,
            "moment_along_kg_m": rod.along,
            "moment_across_kg_m": rod.across,
            "inertia_kg_m2": rod.inertia,
            "centre_along_mm": 1e3 * rod.along / rod.mass if weighs else None,
            "centre_across_mm": 1e3 * rod.across / rod.mass if weighs else None,
        },
        "before": _shaking(found.shaking_before),
        "after": _shaking(found.shaking_after),
        "objective_N": found.objective,
        "least_possible_N": found.bound,
        "saving_N_per_kg": found.saving * found.radius,
        "rounds": found.rounds,
        "converged": found.converged,
    }


def _shaking(shaking: Shaking) -> dict[str, float]:
    return {
        "peak_shaking_force_N": shaking.peak_force,
        "peak_shaking_force_angle_deg": float(np.degrees(shaking.peak_force_angle)),
        "rms_shaking_force_N": shaking.rms_force,
        "peak_shaking_moment_Nm": shaking.peak_moment,
        "peak_shaking_moment_angle_deg": float(np.degrees(shaking.peak_moment_angle)),
        "rms_shaking_moment_Nm": shaking.rms_moment,
    }


def show(screen: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    mass, radius, angle = (numbers[f"counterweight_{key}"] for key in ("kg", "radius_mm", "angle_deg"))
    saving = numbers["saving_N_per_kg"]
    remark = f"the heaviest that is allowed; each kg more would save {saving:.4g} N" if saving else ""
    lines: list[text.Line] = [
        ("counterweight: mass times radius", numbers["counterweight_moment_kg_m"], "kg m", remark),
        ("its angle from the crank", angle, "deg", "180 deg is opposite to the crank pin"),
        ("its mass", mass, "kg", f"at {radius:.6g} mm from the crank pivot"),
    ]
    rod = numbers["rod_balance"]
    if rod is not None:
        place = ""
        if rod["centre_along_mm"] is not None:
            along, across = (round(rod[f"centre_{name}_mm"], 3) + 0.0 for name in ("along", "across"))  # no "-0"
            place = f"centre {along:g} mm along, {across:g} mm across the rod"
        lines += [
            ("added to the rod", rod["mass_kg"], "kg", place),
            ("its inertia about the crank pin", rod["inertia_kg_m2"], "kg m^2", ""),
        ]
    for name, unit in (("shaking_force", "N"), ("shaking_moment", "Nm")):
        for which in ("peak", "rms"):
            key = f"{which}_{name}_{unit}"
            words = name.replace("_", " ")
            title = f"RMS {words} over time" if which == "rms" else f"{which} {words}"
            before = text.compared(numbers["before"], key, "before")
            lines.append((title, numbers["after"][key], "N m" if unit == "Nm" else unit, before))
    text.show_lines(screen, f"Balance of least {numbers['measure']} shaking (moment about the crank pivot)", lines)
    line = f'counterweight = {{ mass = "{mass:.6g} kg", radius = "{radius:.6g} mm", angle = "{angle:.6g} deg" }}'
    screen.print(f"  in the job: {line}", style="dim", soft_wrap=True)


def figure(found: Balance, *, title: str) -> Sheet:
    """Return hodograph, force and, where a rod balance changes it, moment before and after, N and N m."""
    theta = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    degrees = np.degrees(theta)
    curves = list(enumerate(zip(("before", "after"), found.hodograph(theta), strict=True)))
    hodographs = tuple(Line(name, each.force_x, each.force_y, n) for n, (name, each) in curves)
    sizes = (Line(name, degrees, np.hypot(each.force_x, each.force_y), n) for n, (name, each) in curves)
    across = "along the slider line, N; upward: across it, N"
    panels = [
        Panel("hodograph of the shaking force", across, hodographs, equal=True),
        over_turn("size of the shaking force, N", *sizes),
    ]
    angle = shown(float(np.degrees(found.angle)) % 360.0)
    parts = [f"counterweight {shown(found.mass)} kg at {shown(1e3 * found.radius)} mm, {angle}° from the crank"]
    if found.rod is not None:
        moments = (Line(name, degrees, each.moment, n) for n, (name, each) in curves)
        panels.append(over_turn("moment about the pivot, N m", *moments))
        parts.append(f"{shown(found.rod.mass)} kg added to the rod" if found.rod.mass else "nothing added to the rod")
    subtitle, count = ", ".join(parts), len(panels)
    return Sheet(f"{title}: balance", subtitle, tuple(panels), columns=count, width=5.0, height=4.4)
