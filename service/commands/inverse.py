"""`slidercrank inverse`: crank angles, speeds and accelerations that move the slider as given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...objectives.kinds import ACCELERATION, LENGTH, SPEED, System
from ..designs.columns import key_in, split_unit
from ..designs.selection import value_of
from ..designs.shown_units import record_in
from ..text.options import DesignOfRun, Dimensions, JobOrRun, Json, Runs, Units, given_value
from ..text.screen import answer, say
from ..text.tables import print_table, table
from .job_or_run import machine_of

if TYPE_CHECKING:
    from rich.console import Console

_GIVEN = ("slider_position_mm", "slider_velocity_m_s", "slider_acceleration_m_s2")


def inverse(
    position: Annotated[
        str,
        typer.Option("--slider-position", metavar="LENGTH"),
        'Slider position from the crank pivot along the slider line, such as "240 mm".',
    ],
    job: Annotated[JobOrRun, "A job file: what the branch and fixed dimensions come from. A run with --design."] = None,
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
    angle, speed and acceleration are positive counter-clockwise. Linkages that do not turn fully are accepted;
    of a job whose crank swings, the crank angles are those of its swing. Without JOB the branch is the open one.
    Dimensions that JOB fixes need not be repeated. With --design, a run stands in place of JOB, and the design
    has its dimensions.
    """
    from ..designs.inverse import SliderMotion, inverse_record

    mechanism, linkage, problem = machine_of("inverse", job, size, design, runs)
    motion = SliderMotion(
        value_of("--slider-position", position, LENGTH),
        given_value("--slider-velocity", velocity, SPEED),
        given_value("--slider-acceleration", acceleration, ACCELERATION),
    )
    record = inverse_record(mechanism, linkage, None if problem is None else problem.motion, motion)
    answer(json, record_in(record, units), lambda screen: _show(screen, record, units))


def _show(screen: Console, record: dict[str, Any], units: System) -> None:
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
