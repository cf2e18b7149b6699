"""`slidercrank analyse`: all numbers for one design, and its figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...objectives.kinds import System
from ..questions.design_analysis import analysis_of, judge_design, quantities_of_design, show_analysis
from ..questions.design_question import BoundQuestion
from ..questions.discovery import ALL, INPUTS, TOPIC_OF_INPUT, TOPICS, chosen_topics
from ..runs.result import Row, json_text
from ..runs.run_folder import translate_disk_errors, write_file
from ..text.options import (
    DesignOfRun,
    Dimensions,
    Figures,
    File,
    JobOrRun,
    Json,
    Runs,
    Speed,
    Units,
    require_ending,
    speed_option,
)
from ..text.screen import console, print_message, print_output, show_activity
from .design_of_job_or_run import machine_from_arguments
from .exit_and_interruption import INTERRUPTED, Interruption
from .question_options import option_of_input

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...optimise.problem.problem import Problem

_TOPIC_HELP = f"Topics to show in addition: {', '.join(TOPICS)}, or {ALL}."
_INPUT_OPTIONS = tuple(map(option_of_input, INPUTS.values()))


@dataclass(frozen=True)
class Setting(Dimensions):
    """Dimensions of a design, and changes to the machine in JOB."""

    speed: Annotated[Speed, 'Crank speed, such as "300 rpm"; negative is clockwise.'] = None
    replaced_values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE"),
        'Another value for a number in JOB, such as "mechanism.slider.mass=1.2 kg". May be repeated.',
    ] = None
    design: DesignOfRun = None


@dataclass(frozen=True)
class Files:
    """Files read and written in addition to the numbers."""

    measured: Annotated[
        File,
        "CSV file of measured curves to compare with: a column crank_angle_deg, or time_s counted from crank angle 0, "
        "and columns such as slider_position_mm or torque_Nm.",
    ] = None
    figures: Annotated[Figures, "Save the design as design.png in this folder, and one figure per topic."] = None
    cycle: Annotated[File, "Write motion, forces and torque over the cycle as CSV."] = None


def analyse(
    job: Annotated[
        JobOrRun, "Job file that supplies masses, loads, tolerances and speed; with --design, a run."
    ] = None,
    *,
    setting: Setting,
    show: Annotated[list[str] | None, typer.Option(metavar="TOPIC"), _TOPIC_HELP] = None,
    inputs: Annotated[dict[str, str | None], _INPUT_OPTIONS],
    files: Files,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Analyse one design.

    Without JOB there are no masses, loads or tolerances, and only motion and proportions are analysed. The offset then
    defaults to zero, and results that depend on speed need --speed. Dimensions that JOB fixes need not be repeated.
    With --design, name a run instead of JOB; the dimensions are then those of the design. If a topic does not apply to
    the design, the reason is printed at the end; the exit code is then 2 if the topic was named, and 0 with `--show
    all`.
    """
    require_ending("--cycle", files.cycle, ".csv")
    topics = chosen_topics(show or (), job=job is not None)
    options = _topic_options(inputs, topics)
    mechanism, linkage, problem = machine_from_arguments(
        "analyse", job, setting, setting.design, runs, replaced_values=setting.replaced_values or (), turning=True
    )
    if setting.speed is not None:
        mechanism = replace(mechanism, speed=speed_option(setting.speed))
    custom = () if problem is None else problem.own
    row, undefined = quantities_of_design(mechanism, linkage, custom)
    notes = _remove_undefined_numbers(row, mechanism, alone=problem is None)
    with Interruption() as interruption:
        analysis = analysis_of(
            row,
            mechanism,
            linkage,
            topics,
            further_topics=() if files.measured is None else (_measured_question(files.measured, mechanism, linkage),),
            options=options,
            notes=notes,
            cancelled=interruption.is_requested,
            lenient=True,
            undefined=None if problem is None else undefined,
        )
    if files.cycle is not None:
        _write_cycle_csv(mechanism, linkage, files.cycle, units, machine=problem is not None)
    judgement = None if problem is None else judge_design(problem, mechanism, linkage, row, units)
    if json:
        print_output(json_text(analysis.record(units, judgement)))
    else:
        screen = console()
        hint = f"\nMore about this design with --show: {', '.join(TOPICS)}, or {ALL}."
        hint = "" if problem is None or topics else hint
        show_analysis(screen, analysis, judgement, units, custom=custom, hint=hint)
    for note in analysis.notes + (analysis.refused if ALL in (show or ()) else []):
        print_message(note)
    if files.figures is not None and not interruption.is_requested():
        _draw_design_figures(problem, mechanism, linkage, row, analysis.topics, files.figures, units)
    if interruption.is_requested():
        raise typer.Exit(INTERRUPTED)
    if analysis.refused and ALL not in (show or ()):
        raise InputError("; ".join(analysis.refused))


def _measured_question(file: Path, mechanism: Mechanism, linkage: Linkage) -> BoundQuestion:
    from ..designs.measured_curves_file import parse_measured_curves, text_of_measured_file
    from ..questions.measured import MEASURED

    return MEASURED.bind_to_design(
        mechanism, linkage, {"measured": parse_measured_curves(text_of_measured_file(file), mechanism, linkage)}
    )


def _topic_options(texts: Mapping[str, str | None], topics: tuple[str, ...]) -> dict[str, dict[str, Any]]:
    """Return the options for each topic. Raises `InputError` for an option whose topic is not shown."""
    options: dict[str, dict[str, Any]] = {topic: {} for topic in topics}
    for name, text in texts.items():
        if text is not None:
            item, topic = INPUTS[name], TOPIC_OF_INPUT[name]
            if topic not in topics:
                raise InputError(
                    f"{item.flag} needs --show {topic}, which is missing; add it, or leave {item.flag} out"
                )
            options[topic][name] = item.read(text, item.flag)
    return options


def _draw_design_figures(
    problem: Problem | None,
    mechanism: Mechanism,
    linkage: Linkage,
    row: Row,
    topics: Sequence[BoundQuestion],
    folder: Path,
    units: System,
) -> None:
    from ..figures.datasheet import design_datasheet
    from ..figures.style import save_png

    title = "Design" if problem is None else problem.name
    with translate_disk_errors(folder), show_activity("drawing the figures"):
        folder.mkdir(parents=True, exist_ok=True)
        datasheet = design_datasheet(mechanism, linkage, row, title=title, torque=problem is not None, system=units)
        save_png(datasheet, folder / "design.png")
        files = [folder / "design.png", *(topic.draw(folder, units) for topic in topics)]
    for file in files:
        print_message(f"figure: {file}")


def _write_cycle_csv(mechanism: Mechanism, linkage: Linkage, file: Path, units: System, *, machine: bool) -> None:
    from ..designs.design_curves import cycle_csv

    text = cycle_csv(mechanism, linkage, units, machine=machine)
    write_file(file, text)
    print_message(f"{file}: the cycle at {len(text.splitlines()) - 1} crank angles")


def _remove_undefined_numbers(row: Row, mechanism: Mechanism, *, alone: bool) -> list[str]:
    """Remove numbers that are undefined without a job or a speed; return the reasons in words."""
    from ...objectives.registry import QUANTITIES
    from ...objectives.torque_and_power import PEAK_TORQUE

    if not alone:
        return []
    missing = [
        quantity for quantity in QUANTITIES.values() if any(not need.is_met(mechanism) for need in quantity.needs)
    ]
    undefined_columns = ("loaded_stroke", f"{PEAK_TORQUE.name}_angle_deg")
    row.update(dict.fromkeys((*undefined_columns, *(quantity.field for quantity in missing))))
    notes = ["torque, forces and position error need masses, loads and tolerances; give a JOB"]
    if not mechanism.speed:
        notes.append("slider speed and acceleration need a crank speed; give --speed")
    return notes
