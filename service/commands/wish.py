"""`slidercrank wish`: the optimal design that comes nearest to what is wished."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError, StoreError
from ...model.file_names import path_text
from ...objectives.kinds import System
from ..jobs.wish_history import keep_wish, told_wishes, wishes_of_run, words_of
from ..questions.discovery import WIDER
from ..render.terminal import print_blocks
from ..runs.result import json_text
from ..text.options import Json, Run, Runs, Units
from ..text.screen import console, give, waiting
from .ending import end_without_design
from .input_options import helped, options_of
from .run_choice import front_of_run

if TYPE_CHECKING:
    from ...optimise.front.front import ParetoFront

QUESTION = WIDER["wish"]
_EXAMPLE = f"--at {QUESTION.inputs[0].example}"


@helped(
    QUESTION,
    "The exit code is 3 where no design stays within what may worsen. The wish is noted among those of the run, which "
    "--list shows.",
)
def wish(
    run: Run,
    number: Annotated[
        int | None,
        typer.Argument(metavar="NO", show_default=False),
        "Reference design for improve, keep and worsen: its number in `slidercrank front RUN`.",
    ] = None,
    *,
    inputs: Annotated[dict[str, Any], options_of(QUESTION, optional=True)],
    earlier: Annotated[
        bool,
        typer.Option("--list"),
        "List the wishes made for the run, here and on the page, with their answers.",
    ] = False,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question and note the wish, or list those that were noted."""
    if earlier == bool(inputs["at"]):
        got = "both" if earlier else "neither"
        raise InputError(f"give either a wish or --list; got {got}; write it like {_EXAMPLE}")
    folder, front = front_of_run(run, runs, number)
    if earlier:
        _list(folder, front, units, json=json)
        return
    with waiting("wishing"):
        row = None if number is None else number - 1
        found = QUESTION.ask(front, inputs, row=row, words=QUESTION.flags)
    with contextlib.suppress(StoreError):  # a store that cannot be written keeps nobody from the answer
        keep_wish(folder, told_wishes(front, found.found.wishes), number)
    if json:
        wishes = QUESTION.read(inputs, row, QUESTION.flags)["at"]
        give(json_text({"run": path_text(folder), "wishes": wishes} | found.record(units)))
    elif found.met:
        print_blocks(console(), found.blocks, units)
    if not found.met:
        end_without_design(found.message)


def _list(folder: Path, front: ParetoFront, units: System, *, json: bool) -> None:
    """Write the wishes that were made of a run, the latest first, each solved again."""
    from ...optimise.decisions.wish import Wishes
    from ..questions.wish.analysis import answered, told_wish

    made = wishes_of_run(folder)
    with waiting("wishing"):
        solver = Wishes(front) if made else None
        found = []
        for one in made:
            assert solver is not None
            words = words_of(front, one.wishes)
            row = None if one.design is None else one.design - 1
            found.append((one.at, words, answered(solver.wish(words, row=row), words)))
    if json:
        records = [{"at": at, "wishes": words} | each.record(units) for at, words, each in found]
        give(json_text({"run": path_text(folder), "made": records}))
        return
    screen = console()
    if not made:
        screen.print(f"{front.problem.name}: no wishes yet; make one with {_EXAMPLE}", soft_wrap=True)
    for place, (at, words, each) in enumerate(found):
        when = time.strftime("%Y-%m-%d %H:%M", time.localtime(at))
        screen.print(f"{when}  {told_wish(words, each.found.row)}", style="bold", soft_wrap=True)
        for sentence in each.found.sentences(units):
            screen.print(f"  {sentence}", soft_wrap=True)
        if place < len(found) - 1:
            screen.print()
