"""`slidercrank wish`: the optimal design nearest to a wish."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError, StoreError
from ...model.file_name_encoding import path_text
from ...objectives.kinds import System
from ..jobs.front_wish_history import record_wish, wishes_as_entered, wishes_by_objective, wishes_of_run
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.terminal import print_blocks
from ..runs.result import json_text
from ..text.options import Json, Run, Runs, Units
from ..text.screen import console, print_output, show_activity
from .design_of_job_or_run import front_of_run
from .exit_and_interruption import exit_without_design
from .question_options import options_of_question, with_question_help

if TYPE_CHECKING:
    from ...optimise.front.front import ParetoFront

QUESTION = FRONT_OR_JOB_QUESTIONS["wish"]
_EXAMPLE = f"--at {QUESTION.inputs[0].example}"


@with_question_help(
    QUESTION,
    "The exit code is 3 if no design stays within what may worsen. The wish is saved with the run; --list shows "
    "all its wishes.",
)
def wish(
    run: Run,
    number: Annotated[
        int | None,
        typer.Argument(metavar="NO", show_default=False),
        "Reference design for improve, keep and worsen: its number in `slidercrank front RUN`.",
    ] = None,
    *,
    inputs: Annotated[dict[str, Any], options_of_question(QUESTION, optional=True)],
    earlier: Annotated[
        bool,
        typer.Option("--list"),
        "List the wishes made for the run, here and on the page, with their answers.",
    ] = False,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question and record the wish, or list the recorded wishes."""
    if earlier == bool(inputs["at"]):
        received = "both" if earlier else "neither"
        raise InputError(f"give either a wish or --list; got {received}; write it like {_EXAMPLE}")
    folder, front = front_of_run(run, runs, number)
    if earlier:
        _print_recorded_wishes(folder, front, units, json=json)
        return
    with show_activity("wishing"):
        row = None if number is None else number - 1
        solved = QUESTION.ask(front, inputs, row=row, words=QUESTION.flags)
    with contextlib.suppress(StoreError):  # the answer is shown even if the store cannot be written
        record_wish(folder, wishes_by_objective(front, solved.search_result.wishes), number)
    if json:
        wishes = QUESTION.read(inputs, row, QUESTION.flags)["at"]
        print_output(json_text({"run": path_text(folder), "wishes": wishes} | solved.record(units)))
    elif solved.is_satisfied:
        print_blocks(console(), solved.blocks, units)
    if not solved.is_satisfied:
        exit_without_design(solved.message)


def _print_recorded_wishes(folder: Path, front: ParetoFront, units: System, *, json: bool) -> None:
    """Print the wishes recorded for a run, newest first, each solved again."""
    from ...optimise.decisions.wish import Wishes
    from ..questions.wish.analysis import wish_in_words, wish_result

    wishes = wishes_of_run(folder)
    with show_activity("wishing"):
        solver = Wishes(front) if wishes else None
        solved_wishes = []
        for made_wish in wishes:
            assert solver is not None
            words = wishes_as_entered(front, made_wish.wishes)
            row = None if made_wish.design is None else made_wish.design - 1
            solved_wishes.append(
                (made_wish.time, words, wish_result(solver.design_nearest_to_wishes(words, row=row), words))
            )
    if json:
        records = [{"at": at, "wishes": words} | solved.record(units) for at, words, solved in solved_wishes]
        print_output(json_text({"run": path_text(folder), "made": records}))
        return
    screen = console()
    if not wishes:
        screen.print(f"{front.problem.name}: no wishes yet; make one with {_EXAMPLE}", soft_wrap=True)
    for place, (at, words, solved) in enumerate(solved_wishes):
        when = time.strftime("%Y-%m-%d %H:%M", time.localtime(at))
        screen.print(f"{when}  {wish_in_words(words, solved.search_result.row)}", style="bold", soft_wrap=True)
        for sentence in solved.search_result.sentences(units):
            screen.print(f"  {sentence}", soft_wrap=True)
        if place < len(solved_wishes) - 1:
            screen.print()
