"""`slidercrank like`: a design of a run, but with something else."""

from __future__ import annotations

from typing import Annotated, Any

from ...model.file_names import path_text
from ..questions.discovery import WIDER
from ..render.terminal import print_blocks
from ..runs.result import json_text
from ..text.options import Json, Number, Run, Runs, Units
from ..text.screen import console, give, waiting
from .ending import end_without_design
from .input_options import helped, options_of
from .run_choice import front_of_run

QUESTION = WIDER["like"]


@helped(QUESTION)
def like(
    run: Run,
    number: Number,
    inputs: Annotated[dict[str, Any], options_of(QUESTION)],
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question; end without a design where none meets the conditions."""
    folder, front = front_of_run(run, runs, number)
    with waiting("searching"):
        found = QUESTION.ask(front, inputs, row=number - 1, words=QUESTION.flags)
    if json:
        give(json_text({"run": path_text(folder), "number": number} | found.record(units)))
    elif found.met:
        print_blocks(console(), found.blocks, units)
    if not found.met:
        end_without_design(found.message)
