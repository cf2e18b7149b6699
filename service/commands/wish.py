"""`slidercrank wish`: the optimal design that comes nearest to what is wished."""

from __future__ import annotations

import contextlib
import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError, StoreError
from ...model.file_names import path_text
from ...objectives.kinds import System
from ..designs.columns import find_column
from ..designs.shown_units import row_in
from ..designs.wishing import told_wishes, wished_record, words_of
from ..jobs.made_wishes import keep_wish, made_wishes
from ..render.terminal import print_table, table
from ..runs.result import json_text, rows_of
from ..text.options import Json, Run, Runs, Units
from ..text.screen import console, give, waiting
from .ending import end_without_design
from .run_choice import front_of_run

if TYPE_CHECKING:
    from ...optimise.decisions.wished import Wished
    from ...optimise.front.front import ParetoFront
    from ..store.wishes import MadeWish

_EXAMPLE = '--at "peak_torque=110 N m"'


def wish(
    run: Run,
    at: Annotated[
        list[str] | None,
        typer.Option(metavar="WISH"),
        'An objective, =, and a value, which is no bound, such as "peak_torque=110 N m"; or one of improve, keep, '
        '"may worsen to 120 N m" and free. May be repeated.',
    ] = None,
    number: Annotated[
        int | None,
        typer.Argument(metavar="NO", show_default=False),
        "The design that improve, keep and worsen speak of: its number in `slidercrank front RUN`.",
    ] = None,
    earlier: Annotated[
        bool,
        typer.Option("--list"),
        "List the wishes that were made of the run, here and on the page, each with its answer.",
    ] = False,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the optimal design that comes nearest to wished values of the objectives, solved anew.

    Where all of it can be had, the design is better in all of it; otherwise what binds gives way by the same share of
    its range over the front. Objectives that are not named are free. The exit code is 3 where no design stays within
    what may worsen. The wish is noted among those of the run, which --list shows.
    """
    from ...optimise.decisions.wish import wish as nearest

    if earlier == bool(at):
        raise InputError(f"either a wish or --list; got {'both' if at else 'neither'}; write it like {_EXAMPLE}")
    folder, result, front = front_of_run(run, runs, number)
    if earlier:
        _list(folder, result.name, front, units, json=json)
        return
    wishes = _wishes(at or [])
    with waiting("wishing"):
        answer = nearest(front, wishes, row=None if number is None else number - 1)
    with contextlib.suppress(StoreError):  # a store that cannot be written keeps nobody from the answer
        keep_wish(folder, told_wishes(front, answer.wishes), number)
    if json:
        give(json_text({"run": path_text(folder), "wishes": wishes} | wished_record(answer, units)))
    elif len(answer):
        _show(result.name, wishes, answer, units)
    if not len(answer):
        end_without_design(answer.message)


def _list(folder: Path, title: str, front: ParetoFront, units: System, *, json: bool) -> None:
    """Write the wishes that were made of a run, the latest first, each solved again."""
    from ...optimise.decisions.wish import Wishes

    made = made_wishes(folder)
    with waiting("wishing"):
        solver = Wishes(front) if made else None
        found: list[tuple[MadeWish, dict[str, str], Wished]] = []
        for one in made:
            assert solver is not None
            words = words_of(front, one.wishes)
            found.append((one, words, solver.wish(words, row=None if one.design is None else one.design - 1)))
    records = [{"at": one.at, "wishes": words} | wished_record(answer, units) for one, words, answer in found]
    if json:
        give(json_text({"run": path_text(folder), "made": records}))
        return
    screen = console()
    if not made:
        screen.print(f"{title}: no wish was made of it yet; make one with {_EXAMPLE}", soft_wrap=True)
    for place, (one, words, answer) in enumerate(found):
        asked = ", ".join(f"{name} {value}" for name, value in words.items())
        from_ = "" if one.design is None else f", from design {one.design}"
        screen.print(
            f"{time.strftime('%Y-%m-%d %H:%M', time.localtime(one.at))}  {asked}{from_}", style="bold", soft_wrap=True
        )
        for sentence in answer.sentences(units):
            screen.print(f"  {sentence}", soft_wrap=True)
        if place < len(found) - 1:
            screen.print()


def _wishes(at: list[str]) -> dict[str, str]:
    """Return the wishes by the objectives as they are named."""
    found: dict[str, str] = {}
    for text in at:
        name, equals, value = (part.strip() for part in text.rpartition("="))
        if not (equals and name and value):
            raise InputError(
                f"a wish is an objective, =, and a value or a class; got {text!r}; write it like {_EXAMPLE}"
            )
        if name in found:
            raise InputError(f"one wish for each objective; got two for {name}; leave out one")
        found[name] = value
    return found


def _show(title: str, wishes: dict[str, str], answer: Wished, units: System) -> None:
    """Write the answer in words, then the design as a table."""
    screen = console()
    from_ = "" if answer.row is None else f", from design {answer.row + 1}"
    asked = ", ".join(f"{name} {value}" for name, value in wishes.items())
    screen.print(f"{title}: wished {asked}{from_}", style="bold", soft_wrap=True)
    head, *outcomes = answer.sentences(units)
    screen.print(f"\n{head[0].upper()}{head[1:]}:", soft_wrap=True)
    for sentence in outcomes:
        screen.print(f"  {sentence}", soft_wrap=True)
    screen.print()
    row: Any = row_in(rows_of(answer.found.columns)[0], units)
    objectives = {outcome.quantity.title for outcome in answer.outcomes}
    rows = table("quantity", "unit", ">value", ruled=True, padding=(0, 2, 0, 0), pad_edge=True)
    for key, value in row.items():
        undefined = isinstance(value, float) and not math.isfinite(value)
        if undefined or key.startswith("slack_") or key in ("residual", "status"):
            continue
        column = find_column(key, row)
        shown = f"{value:.6g}" if isinstance(value, float) else str(value)
        rows.add_row(column.title, column.unit, shown, style="bold" if column.title in objectives else "")
    print_table(screen, rows)
    screen.print(f"\n{row['status']}: residual {row['residual']:.1e}", soft_wrap=True)
