"""The counterweight of least shaking as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...text.lines import Line, show_lines

if TYPE_CHECKING:
    from rich.console import Console


def show(screen: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    mass, radius, angle = (numbers[f"counterweight_{key}"] for key in ("kg", "radius_mm", "angle_deg"))
    saving = numbers["saving_N_per_kg"]
    remark = f"the heaviest that is allowed; each kg more would save {saving:.4g} N" if saving else ""
    lines: list[Line] = [
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
            title = f"{'RMS' if which == 'rms' else which} {name.replace('_', ' ')}"
            before = f"{numbers['before'][key]:.6g} before"
            lines.append((title, numbers["after"][key], "N m" if unit == "Nm" else unit, before))
    show_lines(screen, f"Balance of least {numbers['measure']} shaking (moment about the crank pivot)", lines)
    line = f'counterweight = {{ mass = "{mass:.6g} kg", radius = "{radius:.6g} mm", angle = "{angle:.6g} deg" }}'
    screen.print(f"  in the job: {line}", style="dim", soft_wrap=True)
