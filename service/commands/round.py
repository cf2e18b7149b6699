"""`slidercrank round`: the best designs of round numbers near one of a run."""

from __future__ import annotations

import math
from typing import Annotated, Any

from ...model.file_names import path_text
from ..questions.discovery import WIDER
from ..render.terminal import print_blocks
from ..runs.result import json_text
from ..text.options import Json, Number, Run, Runs, Units
from ..text.screen import console, give, say
from .ending import end_without_design
from .input_options import helped, options_of, watching
from .run_choice import front_of_run

QUESTION = WIDER["round"]


@helped(QUESTION, "The exit code is then 3. Ctrl-C ends the search.")
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
    with watching("rounding") as watch:
        found = QUESTION.ask(front, inputs, row=number - 1, words=QUESTION.flags, watch=watch)
    record: dict[str, Any] = {"run": path_text(folder), "number": number} | found.record(units)
    if json:
        give(json_text(record))
    elif found.blocks:
        print_blocks(console(), found.blocks, units)
        for note in found.notes:
            say(f"note: {note}")
    if not found.met:
        end_without_design(record["message"] + _remedy(record["designs"]))


def _remedy(designs: list[dict[str, Any]]) -> str:
    """Return the options with which the designs would do, amounts rounded up; nothing without designs."""
    most: dict[str, tuple[float, str]] = {}
    for miss in (miss for row in designs for miss in row["misses"] if miss["amount"] > miss["allowed"]):
        most[miss["quantity"]] = max(most.get(miss["quantity"], (0.0, "")), (miss["amount"], miss["unit"]))
    options = [
        f'--allow "{name}={f"{_rounded_up(amount):g} {unit}".rstrip()}"' for name, (amount, unit) in most.items()
    ]
    return f", such as {' '.join(options)}" if options else ""


def _rounded_up(amount: float) -> float:
    """Return an amount with one digit, never less."""
    size = 10.0 ** math.floor(math.log10(amount))
    return math.ceil(amount / size) * size
