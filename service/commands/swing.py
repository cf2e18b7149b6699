"""`slidercrank swing`: a crank that swings between two angles or places of the slider, and what drives it."""

from __future__ import annotations

from typing import Annotated

import typer

from ...model.swing.words import Driver, Law, Side
from ...objectives.kinds import ANGLE, LENGTH, TIME
from ..designs.shown_units import record_in, rows_in
from ..runs.result import csv_text
from ..runs.run_folder import disk, write_file
from ..text.options import (
    DesignOfRun,
    Dimensions,
    File,
    JobOrRun,
    Json,
    Length,
    Runs,
    Units,
    drawable,
    given_value,
    require_ending,
)
from ..text.screen import answer, say, waiting
from .job_or_run import machine_of

_OPTIONS = {
    "start": "--from",
    "end": "--to",
    "slider_start": "--slider-from",
    "slider_end": "--slider-to",
    "law": "--law",
}
"""What the fields of a swing that is asked for are called here."""


def swing(
    job: Annotated[
        JobOrRun,
        "A job file: what masses, loads, friction and tolerances come from, and the swing of its [motion]. A run with "
        "--design.",
    ] = None,
    *,
    size: Dimensions,
    start: Annotated[
        str | None,
        typer.Option("--from", metavar="ANGLE"),
        'Crank angle at which the way forth starts, such as "11 deg".',
    ] = None,
    end: Annotated[
        str | None, typer.Option("--to", metavar="ANGLE"), "Crank angle at which it ends; less is clockwise."
    ] = None,
    slider_from: Annotated[
        str | None,
        typer.Option(metavar="LENGTH"),
        'Slider position at which the way forth starts, such as "3.1 m", instead of crank angles.',
    ] = None,
    slider_to: Annotated[str | None, typer.Option(metavar="LENGTH"), "Slider position at which it ends."] = None,
    crank_side: Annotated[
        Side | None,
        "With slider positions: side of the line from crank pivot to slider pin, looking along it, that the crank pin "
        "is on; left if not said.",
    ] = None,
    driver: Annotated[Driver | None, "What is driven: the crank by a torque, or the slider by a force."] = None,
    law: Annotated[Law | None, "How the driver moves over time; slow is without inertia."] = None,
    duration: Annotated[
        str | None, typer.Option(metavar="TIME"), 'Time of one way, such as "4 s": for a law other than slow.'
    ] = None,
    actuator_tolerance: Annotated[Length, "How far the driven slider may be off: adds to the crank's error."] = None,
    design: DesignOfRun = None,
    curves: Annotated[File, "Write the curves of both ways as CSV."] = None,
    figure: Annotated[File, "Draw the curves, into a PNG."] = None,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Analyse a swing of the crank between two angles, or two slider positions, forth and back.

    The linkage need not turn through: it must close over the whole swing, and may not pass a dead point where the
    slider drives. Drive forces and torques are along +x and counter-clockwise; peaks are of the continuous crank
    angle. Without JOB nothing has mass. Loads that act on the slider are those of JOB; its speed does not matter. What
    is not given is as in [motion] of JOB; without it the crank drives, slowly.
    """
    from ...model.swing.asked import AskedSwing, asked_swing
    from ...model.swing.summary import summarise
    from ..designs.swing_curves import swing_rows
    from ..render.terminal import print_blocks
    from ..swing.record import swing_blocks, swing_record

    drawable(figure)
    require_ending("--curves", curves, ".csv")
    require_ending("--figure", figure, ".png")
    mechanism, linkage, problem = machine_of("swing", job, size, design, runs)
    given = AskedSwing(
        start=given_value("--from", start, ANGLE),
        end=given_value("--to", end, ANGLE),
        slider_start=given_value("--slider-from", slider_from, LENGTH),
        slider_end=given_value("--slider-to", slider_to, LENGTH),
        side=crank_side,
        driver=driver,
        law=law,
        duration=given_value("--duration", duration, TIME, sign="positive"),
        actuator_tolerance=given_value("--actuator-tolerance", actuator_tolerance, LENGTH, sign="zero or more"),
    )
    mechanism, asked = asked_swing(mechanism, None if problem is None else problem.motion, given, _OPTIONS)
    record = swing_record(mechanism, summarise(mechanism, linkage, asked))
    answer(json, record_in(record, units), lambda screen: print_blocks(screen, swing_blocks(record), units))
    for note in () if json else record["notes"]:
        say(note)
    if curves is not None:
        write_file(curves, csv_text(rows_in(swing_rows(mechanism, linkage, asked), units)))
        say(f"{curves}: the curves of both ways")
    if figure is not None:
        from ..figures.panels import save_sheet
        from ..figures.swing import swing_figure

        with disk(figure.parent), waiting("drawing the figure"):
            figure.parent.mkdir(parents=True, exist_ok=True)
            save_sheet(swing_figure(mechanism, linkage, asked, units), figure)
        say(f"figure: {figure}")
