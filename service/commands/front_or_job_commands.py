"""Commands for questions about a front, several runs or a job: `like`, `round`, `certify`, `compare`, `sweep`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...model.file_name_encoding import path_text
from ..designs.display_units import convert_result
from ..questions.compare.runs import ComparedRun, compared_run
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.terminal import print_blocks
from ..runs.result import Result, csv_text, json_text
from ..runs.run_folder import translate_disk_errors, write_file
from ..text.options import Figures, JobFile, Json, Number, Run, Runs, Units
from ..text.screen import console, print_message, print_output, print_record, show_activity, write_figure
from .design_of_job_or_run import folder_and_result, front_of_run, rotating_problem
from .exit_and_interruption import INTERRUPTED, NOT_PROVEN, Interruption, NoDesigns, exit_without_design
from .question_options import options_of_question, search_listener, with_question_help

if TYPE_CHECKING:
    from rich.console import Console

LIKE, ROUND, CERTIFY, COMPARE, SWEEP = (
    FRONT_OR_JOB_QUESTIONS[name] for name in ("like", "round", "certify", "compare", "sweep")
)


@with_question_help(LIKE)
def like(
    run: Run,
    number: Number,
    inputs: Annotated[dict[str, Any], options_of_question(LIKE)],
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question; exit without a design if none meets the conditions."""
    folder, front = front_of_run(run, runs, number)
    with show_activity("searching"):
        nearest = LIKE.ask(front, inputs, row=number - 1, words=LIKE.flags)
    if json:
        print_output(json_text({"run": path_text(folder), "number": number} | nearest.record(units)))
    elif nearest.is_satisfied:
        print_blocks(console(), nearest.blocks, units)
    if not nearest.is_satisfied:
        exit_without_design(nearest.message)


@with_question_help(ROUND, "The exit code is then 3. Ctrl-C ends the search.")
def round(
    run: Run,
    number: Number,
    inputs: Annotated[dict[str, Any], options_of_question(ROUND)],
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question; if no design meets all requirements, report which options would be sufficient."""
    folder, front = front_of_run(run, runs, number)
    with search_listener("rounding") as watch:
        rounded = ROUND.ask(front, inputs, row=number - 1, words=ROUND.flags, listener=watch)
    record: dict[str, Any] = {"run": path_text(folder), "number": number} | rounded.record(units)
    if json:
        print_output(json_text(record))
    elif rounded.blocks:
        print_blocks(console(), rounded.blocks, units)
        for note in rounded.notes:
            print_message(f"note: {note}")
    if not rounded.is_satisfied:
        exit_without_design(record["message"] + _allowance_options(record["designs"]))


def _allowance_options(designs: list[dict[str, Any]]) -> str:
    """Return the options that would accept the designs, amounts rounded up; empty if there are no designs."""
    largest_miss: dict[str, tuple[float, str]] = {}
    for miss in (miss for row in designs for miss in row["misses"] if miss["amount"] > miss["allowed"]):
        largest_miss[miss["quantity"]] = max(
            largest_miss.get(miss["quantity"], (0.0, "")), (miss["amount"], miss["unit"])
        )
    options = [
        f'--allow "{name}={f"{_rounded_up_to_one_digit(amount):g} {unit}".rstrip()}"'
        for name, (amount, unit) in largest_miss.items()
    ]
    return f", such as {' '.join(options)}" if options else ""


def _rounded_up_to_one_digit(amount: float) -> float:
    """Return an amount rounded up to one significant digit."""
    size = 10.0 ** math.floor(math.log10(amount))
    return math.ceil(amount / size) * size


@with_question_help(
    CERTIFY,
    "Keeps certificate.json, and the added designs as certificate.csv, in the run's folder. Exit code 4 if the budget "
    "does not suffice; Ctrl-C stops and reports what is proven so far.",
)
def certify(
    run: Run,
    inputs: Annotated[dict[str, Any], options_of_question(CERTIFY)],
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question, save the certificate, and set the exit code to whether the accuracy is proven."""
    folder, front = front_of_run(run, runs, empty=True)
    with Interruption() as interruption, search_listener("bounding the design box", interruption.is_requested) as watch:
        certificate = CERTIFY.ask(front, inputs, words=CERTIFY.flags, listener=watch)
    place, file_lines = {"run": path_text(folder)}, list[str]()
    if len(front):
        record = place | certificate.record("metric")
        write_file(folder / "certificate.json", json_text(record))
        write_file(folder / "certificate.csv", csv_text(record["added"]))
        added = len(record["added"])
        file_lines = [f"Files: {folder / 'certificate.json'}"]
        file_lines += [f"       {folder / 'certificate.csv'} ({added} added designs)"] if added else []

    def show(screen: Console) -> None:
        print_blocks(screen, certificate.blocks, units)
        for line in file_lines:
            screen.print(line, soft_wrap=True)

    print_record(json, place | certificate.record(units), show)
    if interruption.is_requested() and len(front):
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if certificate.is_satisfied else NOT_PROVEN)


@with_question_help(COMPARE)
def compare(
    run: Annotated[list[str], typer.Argument(metavar="RUN..."), "Two or more runs, named as in `front`."],
    inputs: Annotated[dict[str, Any], options_of_question(COMPARE)],
    figures: Annotated[Figures, "Also draw the fronts, in this folder."] = None,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question for runs with designs, and draw their fronts."""
    compared = [compared_run(*folder_and_result(name, runs)) for name in run]
    for one in compared:
        if not one.result.designs:
            raise NoDesigns(replace(one.result, message=f"{one.name}: {one.result.message}; leave it out"))
    answer = COMPARE.ask(compared, inputs, words=COMPARE.flags)
    if not answer.is_satisfied:
        raise InputError(answer.message)
    picture = (
        None
        if figures is None
        else _draw_comparison([(one, convert_result(one.result, units)) for one in compared], figures)
    )
    print_record(json, answer.record(units), lambda screen: print_blocks(screen, answer.blocks, units))
    if picture is not None:
        print_message(f"{picture}")


def _draw_comparison(compared: Sequence[tuple[ComparedRun, Result]], folder: Path) -> Path:
    """Draw the results of runs in a unit system into a folder."""
    import numpy as np

    from ..figures.comparison import MOST_RUNS, PlottedRun, comparison_matrix
    from ..figures.style import save_png

    objectives = compared[0][1].objectives
    if len(objectives) < 2:
        raise InputError("a figure needs at least two objectives; these runs have one; leave out --figures")
    if len(compared) > MOST_RUNS:
        raise InputError(f"a figure may show at most {MOST_RUNS} runs; got {len(compared)}; leave out some")
    drawn = [
        PlottedRun(
            f"{run.name} ({run.method})",
            np.array([[row[objective.column] for objective in objectives] for row in result.designs], dtype=np.float64),
        )
        for run, result in compared
    ]
    with translate_disk_errors(folder):
        folder.mkdir(parents=True, exist_ok=True)
        save_png(comparison_matrix(drawn, objectives), folder / "comparison.png")
    return folder / "comparison.png"


@with_question_help(SWEEP)
def sweep(
    job: Annotated[JobFile, "Job file, .toml or .json."],
    *,
    inputs: Annotated[dict[str, Any], options_of_question(SWEEP)],
    figures: Annotated[Figures, "Save a figure of the sweep as sweep.png in this folder."] = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question and draw the answer."""
    problem = rotating_problem(job, "sweep")
    swept = SWEEP.ask(problem, inputs, words=SWEEP.flags)
    print_record(json, swept.record(units)["rows"], lambda screen: print_blocks(screen, swept.blocks, units))
    for note in () if json else swept.notes:
        print_message(note)
    if figures is not None:
        from ..questions.sweep.figure import sweep_figure

        write_figure(
            figures / "sweep.png", lambda: sweep_figure(*swept.search_result, title=problem.name, system=units)
        )
