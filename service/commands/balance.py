"""`slidercrank balance`: the counterweight, and a rod balance, of least shaking."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ..analyses.lines import Line, show_lines
from ..runs.result import json_text
from ..runs.run_folder import disk
from .options import length_option, value_option
from .screen import console, give, say, waiting

if TYPE_CHECKING:
    from rich.console import Console

    from ...optimise.sizing.counterweight import Balance, RodSpace, Shaking

_LENGTH = "LENGTH"


def balance(
    job: Annotated[Path, typer.Argument(metavar="JOB", help="A job file: speed and masses come from it.")],
    crank: Annotated[str | None, typer.Option(metavar=_LENGTH, help="Crank, unless fixed by JOB.")] = None,
    rod: Annotated[str | None, typer.Option(metavar=_LENGTH, help="Connecting rod, likewise.")] = None,
    offset: Annotated[str | None, typer.Option(metavar=_LENGTH, help="Offset, likewise.")] = None,
    measure: Annotated[
        str, typer.Option(metavar="MEASURE", help='What is to be least over the cycle: "peak" or "rms".')
    ] = "peak",
    radius: Annotated[
        str | None,
        typer.Option(metavar=_LENGTH, help="Where the counterweight's centre is.  [default: as in JOB, or the crank]"),
    ] = None,
    mass: Annotated[
        str | None, typer.Option(metavar="MASS", help="Greatest mass of the counterweight, such as 2 kg.")
    ] = None,
    rod_radius: Annotated[
        str | None, typer.Option(metavar=_LENGTH, help="Space around the crank pin for a balance mass on the rod.")
    ] = None,
    rod_mass: Annotated[str | None, typer.Option(metavar="MASS", help="Greatest mass of it.")] = None,
    arm: Annotated[
        str | None,
        typer.Option(metavar=_LENGTH, help="Count the shaking moment too, as moment / arm; needs a rod balance."),
    ] = None,
    figures: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Draw the hodograph before and after into balance.png there.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print only JSON on standard output.")] = False,
) -> None:
    """Find the counterweight, instead of that of JOB, of least shaking force, and a balance mass on the rod.

    Inertia forces at constant crank speed, over all crank angles; gravity and load are left out.
    """
    from ...model.linkage.linkage import Linkage
    from ...objectives.kinds import LENGTH, MASS
    from ...optimise.job import load_job
    from ...optimise.sizing import counterweight as balancing

    problem = load_job(job)
    lengths = [
        length_option(name, text, problem) for name, text in (("crank", crank), ("rod", rod), ("offset", offset))
    ]
    mechanism = problem.mechanism
    linkage = Linkage(lengths[0], lengths[1], lengths[2], mechanism.branch)

    def given(option: str, text: str | None, kind: Any) -> float | None:
        return None if text is None else value_option(option, text, kind, sign="positive")

    at = given("--radius", radius, LENGTH) or mechanism.counterweight.radius or lengths[0]
    heaviest = given("--mass", mass, MASS)
    words: Any = measure.strip().casefold()
    found = balancing.balance(
        mechanism,
        linkage,
        measure=words,
        arm=given("--arm", arm, LENGTH),
        radius=at,
        most=None if heaviest is None else heaviest * at,
        rod=_space(given("--rod-radius", rod_radius, LENGTH), given("--rod-mass", rod_mass, MASS)),
    )
    numbers = balance_numbers(found, words)
    if json:
        give(json_text(numbers))
    else:
        show(console(), numbers)
    if not found.converged:
        say(f"not proven to be the best: {found.objective:.6g} N, and no less than {found.bound:.6g} N is possible")
    if figures is not None:
        from ..figures.balancing import draw_balancing

        with disk(figures), waiting("drawing the figure"):
            figures.mkdir(parents=True, exist_ok=True)
            file = draw_balancing(found, figures / "balance.png", title=problem.name)
        say(f"figure: {file}")


def _space(radius: float | None, mass: float | None) -> RodSpace | None:
    from ...optimise.sizing.counterweight import RodSpace

    if radius is None and mass is None:
        return None
    if radius is None or mass is None:
        have, need = ("--rod-mass", "--rod-radius") if radius is None else ("--rod-radius", "--rod-mass")
        raise InputError(f"a rod balance needs --rod-radius and --rod-mass; got {have} alone; add {need}")
    return RodSpace(radius=radius, mass=mass)


def balance_numbers(found: Balance, measure: str) -> dict[str, Any]:
    """Return a balance ready for JSON; the angle of the counterweight is from the crank's direction."""
    import numpy as np

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
    import numpy as np

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
