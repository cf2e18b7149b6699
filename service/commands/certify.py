"""`slidercrank certify`: a proven bound on the distance of a run's front from the true one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.file_names import path_text
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.terminal import print_blocks
from ..runs.result import csv_text, json_text
from ..runs.run_folder import write_file
from ..text.options import Json, Run, Runs, Units
from ..text.screen import print_record
from .ending import INTERRUPTED, NOT_PROVEN, Interruption
from .input_options import options_of, search_listener, with_question_help
from .run_choice import front_of_run

if TYPE_CHECKING:
    from rich.console import Console

QUESTION = FRONT_OR_JOB_QUESTIONS["certify"]


@with_question_help(
    QUESTION,
    "Keeps certificate.json, and the added designs as certificate.csv, in the run's folder. Exit code 4 if the budget "
    "does not suffice; Ctrl-C gives what is proven so far.",
)
def certify(
    run: Run,
    inputs: Annotated[dict[str, Any], options_of(QUESTION)],
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question, keep the certificate, and tell by the exit code whether it is proven."""
    folder, front = front_of_run(run, runs, empty=True)
    with Interruption() as interruption, search_listener("bounding the design box", interruption.requested) as watch:
        certificate = QUESTION.ask(front, inputs, words=QUESTION.flags, listener=watch)
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
    if interruption.requested() and len(front):
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if certificate.is_satisfied else NOT_PROVEN)
