"""`slidercrank like`: a design similar to one of a run, under further conditions."""

from __future__ import annotations

from typing import Annotated, Any

from ...model.file_names import path_text
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.terminal import print_blocks
from ..runs.result import json_text
from ..text.options import Json, Number, Run, Runs, Units
from ..text.screen import console, print_output, show_activity
from .ending import end_without_design
from .input_options import options_of, with_question_help
from .run_choice import front_of_run

QUESTION = FRONT_OR_JOB_QUESTIONS["like"]


@with_question_help(QUESTION)
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
    with show_activity("searching"):
        nearest = QUESTION.ask(front, inputs, row=number - 1, words=QUESTION.flags)
    if json:
        print_output(json_text({"run": path_text(folder), "number": number} | nearest.record(units)))
    elif nearest.is_satisfied:
        print_blocks(console(), nearest.blocks, units)
    if not nearest.is_satisfied:
        end_without_design(nearest.message)
