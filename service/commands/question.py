"""Commands that ask one design a question of their own name: `slidercrank inverse`, `slidercrank swing`."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from ..designs.shown_units import record_in
from ..questions.discovery import COMMANDS, QUESTIONS
from ..runs.result import csv_text
from ..runs.run_folder import write_file
from ..text.options import DesignOfRun, Dimensions, JobOrRun, Json, Runs, Units, drawable, require_ending
from ..text.screen import answer, say, write_figure
from .input_options import option_of
from .job_or_run import machine_of


def command_of(name: str) -> Callable[..., None]:
    """Return the command of a question, for `for_typer`."""
    question, says = QUESTIONS[name], COMMANDS[name]

    def command(
        job: JobOrRun = None,
        *,
        size: Dimensions,
        inputs: dict[str, str | None],
        design: DesignOfRun = None,
        files: dict[str, Path],
        runs: Runs = None,
        units: Units = "metric",
        json: Json = False,
    ) -> None:
        from ..render.terminal import print_blocks

        curves, figure = files.get("curves"), drawable(files.get("figure"))
        require_ending("--curves", curves, ".csv")
        require_ending("--figure", figure, ".png")
        mechanism, linkage, problem = machine_of(name, job, size, design, runs)
        words = {one.name: one.flag for one in question.inputs}
        asked = question.asked(mechanism, linkage, None if problem is None else problem.motion, inputs, words)
        record = asked.numbers()
        answer(json, record_in(record, units), lambda screen: print_blocks(screen, asked.blocks(record), units))
        for note in () if json else filter(None, record.get("notes", [record.get("note")])):
            say(note)
        if curves is not None:
            write_file(curves, csv_text(asked.written("curves", units)))
            say(f"{curves}: {says.curves}")
        if figure is not None:
            write_figure(figure, lambda: asked.written("figure", units))

    helps = {"curves": f"Write {says.curves} as CSV.", "figure": "Draw the curves, into a PNG."} if says.curves else {}
    written = (_file_option(file, help) for file, help in helps.items())
    command.__doc__ = f"{says.help} {says.alone}"
    command.__annotations__ |= {
        "job": Annotated[JobOrRun, says.job],
        "inputs": Annotated[dict[str, Any], tuple(map(option_of, question.inputs))],
        "files": Annotated[dict[str, Any], tuple(written)],
    }
    return command


def _file_option(name: str, help: str) -> inspect.Parameter:
    hint = Annotated[Path | None, typer.Option(metavar="FILE", help=help)]
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=hint)


inverse, swing = map(command_of, ("inverse", "swing"))
