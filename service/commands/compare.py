"""`slidercrank compare`: comparison of the fronts of several runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from ...model.errors import InputError
from ..designs.display_units import result_in
from ..questions.compare.runs import ComparedRun, compared_run
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.terminal import print_blocks
from ..runs.result import Result
from ..runs.run_folder import disk
from ..text.options import Figures, Json, Runs, Units
from ..text.screen import print_message, print_record
from .ending import NoDesigns
from .input_options import options_of, with_question_help
from .run_choice import run_of

QUESTION = FRONT_OR_JOB_QUESTIONS["compare"]


@with_question_help(QUESTION)
def compare(
    run: Annotated[list[str], typer.Argument(metavar="RUN..."), "Two or more runs, named as in `front`."],
    inputs: Annotated[dict[str, Any], options_of(QUESTION)],
    figures: Annotated[Figures, "Also draw the fronts, in this folder."] = None,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question for runs with designs, and draw their fronts."""
    compared = [compared_run(*run_of(name, runs)) for name in run]
    for one in compared:
        if not one.result.designs:
            raise NoDesigns(replace(one.result, message=f"{one.name}: {one.result.message}; leave it out"))
    answer = QUESTION.ask(compared, inputs, words=QUESTION.flags)
    if not answer.is_satisfied:
        raise InputError(answer.message)
    picture = None if figures is None else _draw([(one, result_in(one.result, units)) for one in compared], figures)
    print_record(json, answer.record(units), lambda screen: print_blocks(screen, answer.blocks, units))
    if picture is not None:
        print_message(f"{picture}")


def _draw(compared: Sequence[tuple[ComparedRun, Result]], folder: Path) -> Path:
    """Draw the results of runs, in the requested units, in a folder."""
    import numpy as np

    from ..figures.comparison import MOST_RUNS, PlottedRun, comparison_matrix
    from ..figures.style import save

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
    with disk(folder):
        folder.mkdir(parents=True, exist_ok=True)
        save(comparison_matrix(drawn, objectives), folder / "comparison.png")
    return folder / "comparison.png"
