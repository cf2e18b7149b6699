"""`slidercrank round`: the best designs with round numbers near one of a run."""

from __future__ import annotations

import math
from typing import Annotated, Any

from ...model.file_names import path_text
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.terminal import print_blocks
from ..runs.result import json_text
from ..text.options import Json, Number, Run, Runs, Units
from ..text.screen import console, print_message, print_output
from .ending import end_without_design
from .input_options import options_of, search_listener, with_question_help
from .run_choice import front_of_run

QUESTION = FRONT_OR_JOB_QUESTIONS["round"]


@with_question_help(QUESTION, "The exit code is then 3. Ctrl-C ends the search.")
def round(
    run: Run,
    number: Number,
    inputs: Annotated[dict[str, Any], options_of(QUESTION)],
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question; where no design meets all, tell which options would do."""
    folder, front = front_of_run(run, runs, number)
    with search_listener("rounding") as watch:
        rounded = QUESTION.ask(front, inputs, row=number - 1, words=QUESTION.flags, listener=watch)
    record: dict[str, Any] = {"run": path_text(folder), "number": number} | rounded.record(units)
    if json:
        print_output(json_text(record))
    elif rounded.blocks:
        print_blocks(console(), rounded.blocks, units)
        for note in rounded.notes:
            print_message(f"note: {note}")
    if not rounded.is_satisfied:
        end_without_design(record["message"] + _remedy(record["designs"]))


def _remedy(designs: list[dict[str, Any]]) -> str:
    """Return the options that would accept the designs, amounts rounded up; empty without designs."""
    largest_miss: dict[str, tuple[float, str]] = {}
    for miss in (miss for row in designs for miss in row["misses"] if miss["amount"] > miss["allowed"]):
        largest_miss[miss["quantity"]] = max(
            largest_miss.get(miss["quantity"], (0.0, "")), (miss["amount"], miss["unit"])
        )
    options = [
        f'--allow "{name}={f"{_rounded_up(amount):g} {unit}".rstrip()}"'
        for name, (amount, unit) in largest_miss.items()
    ]
    return f", such as {' '.join(options)}" if options else ""


def _rounded_up(amount: float) -> float:
    """Return an amount with one digit, never less."""
    size = 10.0 ** math.floor(math.log10(amount))
    return math.ceil(amount / size) * size
