"""`slidercrank analyse`: all numbers of one design, and its figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...objectives.kinds import System
from ..designs.requirements import judged
from ..questions.design_analysis import analysis_of, numbers_of
from ..questions.discovery import ALL, INPUTS, TOPIC_OF, TOPICS, chosen_topics
from ..questions.question import QuestionOfDesign
from ..runs.result import Row, json_text
from ..runs.run_folder import disk, write_file
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
from ..text.screen import console, give, say, waiting
from .ending import INTERRUPTED, Interruption
from .input_options import option_of
from .job_or_run import machine_of

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...optimise.problem.problem import Problem

_TOPIC_HELP = f"Topics to show in addition: {', '.join(TOPICS)}, or {ALL}."
_INPUT_OPTIONS = tuple(map(option_of, INPUTS.values()))


@dataclass(frozen=True)
class Setting(Dimensions):
    """A design as it is given, and what its machine has other than JOB says."""

    speed: Annotated[Speed, 'Crank speed, such as "300 rpm"; negative is clockwise.'] = None
    put: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE"),
        'Another value for a number in JOB, such as "mechanism.slider.mass=1.2 kg". May be repeated.',
    ] = None
    design: DesignOfRun = None


@dataclass(frozen=True)
class Files:
    """Files that are read and written besides the numbers."""

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
    With --design, give a run instead of JOB; the dimensions are those of the design. If a topic does not apply to the
    design, the reason is printed at the end; the exit code is then 2 if the topic was named, and 0 with `--show all`.
    """
    require_ending("--cycle", files.cycle, ".csv")
    topics = chosen_topics(show or (), job=job is not None)
    options = _topic_options(inputs, topics)
    mechanism, linkage, problem = machine_of(
        "analyse", job, setting, setting.design, runs, put=setting.put or (), turning=True
    )
    if setting.speed is not None:
        mechanism = replace(mechanism, speed=speed_option(setting.speed))
    own = () if problem is None else problem.own
    row, undefined = numbers_of(mechanism, linkage, own)
    notes = _leave_out(row, mechanism, alone=problem is None)
    with Interruption() as interruption:
        found = analysis_of(
            row,
            mechanism,
            linkage,
            topics,
            more=() if files.measured is None else (_measured(files.measured, mechanism, linkage),),
            options=options,
            notes=notes,
            cancelled=interruption.asked,
            lenient=True,
            undefined=None if problem is None else undefined,
        )
    if files.cycle is not None:
        _write_cycle(mechanism, linkage, files.cycle, units, machine=problem is not None)
    rules = [] if problem is None else judged(problem, row, units)
    if json:
        give(json_text(found.record(units, None if problem is None else rules)))
    else:
        from ..questions.analysis_text import show_analysis

        screen = console()
        more = f"\nMore about this design with --show: {', '.join(TOPICS)}, or {ALL}."
        show_analysis(screen, found, rules, units, own=own, more="" if problem is None or topics else more)
    for note in found.notes + (found.refused if ALL in (show or ()) else []):
        say(note)
    if files.figures is not None and not interruption.asked():
        _draw(problem, mechanism, linkage, row, found.topics, files.figures, units)
    if interruption.asked():
        raise typer.Exit(INTERRUPTED)
    if found.refused and ALL not in (show or ()):
        raise InputError("; ".join(found.refused))


def _measured(file: Path, mechanism: Mechanism, linkage: Linkage) -> QuestionOfDesign:
    from ..designs.measured_file import measured_text, read_measured
    from ..questions.measured import MEASURED

    return MEASURED.of(mechanism, linkage, {"measured": read_measured(measured_text(file), mechanism, linkage)})


def _topic_options(given: Mapping[str, str | None], topics: tuple[str, ...]) -> dict[str, dict[str, Any]]:
    """Return the options of each topic. Raises `InputError` for one whose topic is not shown."""
    options: dict[str, dict[str, Any]] = {topic: {} for topic in topics}
    for name, text in given.items():
        if text is not None:
            one, topic = INPUTS[name], TOPIC_OF[name]
            if topic not in topics:
                raise InputError(f"{one.flag} needs --show {topic}, which is missing; add it, or leave {one.flag} out")
            options[topic][name] = one.read(text, one.flag)
    return options


def _draw(
    problem: Problem | None,
    mechanism: Mechanism,
    linkage: Linkage,
    row: Row,
    topics: Sequence[QuestionOfDesign],
    folder: Path,
    units: System,
) -> None:
    from ..figures.sheet import design_sheet
    from ..figures.style import save

    title = "Design" if problem is None else problem.name
    with disk(folder), waiting("drawing the figures"):
        folder.mkdir(parents=True, exist_ok=True)
        sheet = design_sheet(mechanism, linkage, row, title=title, torque=problem is not None, system=units)
        save(sheet, folder / "design.png")
        files = [folder / "design.png", *(topic.draw(folder, units) for topic in topics)]
    for file in files:
        say(f"figure: {file}")


def _write_cycle(mechanism: Mechanism, linkage: Linkage, file: Path, units: System, *, machine: bool) -> None:
    from ..designs.cycle_table import cycle_csv

    text = cycle_csv(mechanism, linkage, units, machine=machine)
    write_file(file, text)
    say(f"{file}: the cycle at {len(text.splitlines()) - 1} crank angles")


def _leave_out(row: Row, mechanism: Mechanism, *, alone: bool) -> list[str]:
    """Take out what is not defined without a job or a speed; return why, in words."""
    from ...objectives.peak_torque import PEAK_TORQUE
    from ...objectives.registry import QUANTITIES

    if not alone:
        return []
    missing = [of for of in QUANTITIES.values() if any(not need.is_met(mechanism) for need in of.needs)]
    more = ("loaded_stroke", f"{PEAK_TORQUE.name}_angle_deg")
    row.update(dict.fromkeys((*more, *(of.field for of in missing))))
    notes = ["torque, forces and position error need masses, loads and tolerances; give a JOB"]
    if not mechanism.speed:
        notes.append("slider speed and acceleration need a crank speed; give --speed")
    return notes
