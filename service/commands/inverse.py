"""`slidercrank inverse`: crank angles, speeds and accelerations that move the slider as given."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...objectives.kinds import ACCELERATION, LENGTH, SPEED, System
from ..designs.columns import key_in, split_unit
from ..designs.shown_units import record_in
from ..runs.result import json_text
from ..text.options import DesignOfRun, Dimensions, Json, Runs, Units, value_option
from ..text.screen import console, give, say
from ..text.tables import print_table, table
from .job_or_run import design_of_run, problem_of_job

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage

_GIVEN = ("slider_position_mm", "slider_velocity_m_s", "slider_acceleration_m_s2")


def inverse(
    position: Annotated[
        str,
        typer.Option("--slider-position", metavar="LENGTH"),
        'Slider position from the crank pivot along the slider line, such as "240 mm".',
    ],
    job: Annotated[
        Path | None,
        typer.Argument(metavar="JOB"),
        "A job file: what the branch and fixed dimensions come from. A run with --design.",
    ] = None,
    *,
    size: Dimensions,
    velocity: Annotated[
        str | None,
        typer.Option("--slider-velocity", metavar="SPEED"),
        'Slider velocity, such as "-1 m/s": gives the crank speed.',
    ] = None,
    acceleration: Annotated[
        str | None,
        typer.Option("--slider-acceleration", metavar="ACCELERATION"),
        'Slider acceleration, such as "3 m/s^2": gives the crank acceleration. Needs --slider-velocity.',
    ] = None,
    design: DesignOfRun = None,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find every crank angle that puts the slider at a position.

    Most positions have two, one on each stroke, named as for a crank that turns counter-clockwise. With the
    slider's velocity and acceleration, each has the crank speed and the crank acceleration that give them. Crank
    angle, speed and acceleration are positive counter-clockwise. Linkages that do not turn fully are accepted.
    Without JOB the branch is the open one. Dimensions that JOB fixes need not be repeated. With --design, a run
    stands in place of JOB, and the design has its dimensions.
    """
    from ..designs.inverse import SliderMotion, inverse_record

    linkage = _linkage(job, size, design, runs)
    motion = SliderMotion(
        value_option("--slider-position", position, LENGTH),
        None if velocity is None else value_option("--slider-velocity", velocity, SPEED),
        None if acceleration is None else value_option("--slider-acceleration", acceleration, ACCELERATION),
    )
    record = inverse_record(linkage, motion)
    if json:
        give(json_text(record_in(record, units)))
    else:
        _show(record, units)


def _linkage(job: Path | None, size: Dimensions, design: int | None, runs: Path | None) -> Linkage:
    from ...model.linkage.linkage import Linkage

    if design is not None:
        return design_of_run("inverse", job, design, runs, vars(size)).linkage
    problem = problem_of_job(job)
    if problem is not None:
        return size.linkage(problem)
    crank, rod, offset = size.lengths(None)
    return Linkage(crank, rod, offset)


def _show(record: dict[str, Any], units: System) -> None:
    screen = console()
    given = []
    for key in _GIVEN:
        name, factor = key_in(key, units)
        title, unit, _ = split_unit(name)
        if record[key] is not None:
            given.append(f"{title.removeprefix('slider_')} {factor * record[key]:.6g} {unit}")
    screen.print(f"slider: {', '.join(given)}", soft_wrap=True)
    rates = [">crank speed, rpm"] * (record["slider_velocity_m_s"] is not None)
    rates += [">crank acceleration, rad/s^2"] * (record["slider_acceleration_m_s2"] is not None)
    rows = table(">crank angle, deg", "stroke, counter-clockwise", *rates, ruled=True)
    for solution in record["solutions"]:
        angle, stroke, *values = solution.values()
        shown = ["undefined" if value is None else f"{value:.6g}" for value in values[: len(rates)]]
        rows.add_row(f"{angle:.6g}", stroke or "dead centre", *shown)
    print_table(screen, rows)
    if record["note"]:
        say(record["note"])
