"""`slidercrank inverse`: crank angles, speeds and accelerations that move the slider as given."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from ...objectives.keys import kind_of_key
from ...objectives.kinds import ACCELERATION, ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, LENGTH, SPEED
from ..designs.selection import value_of
from ..designs.shown_units import record_in
from ..render.blocks import Block, Table, column, joined, recorded, sentence, words
from ..render.terminal import print_blocks
from ..text.options import DesignOfRun, Dimensions, JobOrRun, Json, Runs, Units, given_value
from ..text.screen import answer, say
from .job_or_run import machine_of

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
    answer(json, record_in(record, units), lambda screen: print_blocks(screen, _blocks(record), units))
    if record["note"] and not json:
        say(record["note"])


def _blocks(record: dict[str, Any]) -> list[Block]:
    given = [
        words(f"{kind_of_key(key)[0].removeprefix('slider_')} {{value}}", value=recorded(record, key))
        for key in _GIVEN
        if record[key] is not None
    ]
    asked = [
        (key, column(title, kind))
        for key, title, kind, of in (
            ("crank_speed_rpm", "crank speed", ANGULAR_SPEED, "slider_velocity_m_s"),
            ("crank_acceleration_rad_s2", "crank acceleration", ANGULAR_ACCELERATION, "slider_acceleration_m_s2"),
        )
        if record[of] is not None
    ]
    rows = []
    for solution in record["solutions"]:
        _, stroke, *_ = solution.values()
        rates = (recorded(solution, key) for key, _ in asked)
        rows.append((recorded(solution, "crank_angle_deg"), stroke or "dead centre", *rates))
    heads = (column("crank angle", ANGLE), column("stroke, counter-clockwise", left=True))
    return [
        sentence("slider: {given}", given=joined(given)),
        Table((*heads, *(head for _, head in asked)), tuple(rows), ruled=True),
    ]
