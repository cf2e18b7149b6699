"""`slidercrank certify`: a proof of how far the front of a run can be from the true one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.file_names import path_text
from ..questions.discovery import WIDER
from ..render.terminal import print_blocks
from ..runs.result import csv_text, json_text
from ..runs.run_folder import write_file
from ..text.options import Json, Run, Runs, Units
from ..text.screen import answer
from .ending import INTERRUPTED, NOT_PROVEN, Interruption
from .input_options import helped, options_of, watching
from .run_choice import front_of_run

if TYPE_CHECKING:
    from rich.console import Console

QUESTION = WIDER["certify"]


@helped(
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
    with Interruption() as interruption, watching("bounding the design box", interruption.asked) as watch:
        found = QUESTION.ask(front, inputs, words=QUESTION.flags, watch=watch)
    place, kept = {"run": path_text(folder)}, list[str]()
    if len(front):
        record = place | found.record("metric")
        write_file(folder / "certificate.json", json_text(record))
        write_file(folder / "certificate.csv", csv_text(record["added"]))
        added = len(record["added"])
        kept = [f"Files: {folder / 'certificate.json'}"]
        kept += [f"       {folder / 'certificate.csv'} ({added} added designs)"] if added else []

    def show(screen: Console) -> None:
        print_blocks(screen, found.blocks, units)
        for line in kept:
            screen.print(line, soft_wrap=True)

    answer(json, place | found.record(units), show)
    if interruption.asked() and len(front):
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if found.met else NOT_PROVEN)
