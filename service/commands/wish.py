"""`slidercrank wish`: the optimal design that comes nearest to what is wished."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...objectives.kinds import System
from ..designs.columns import find_column
from ..designs.shown_units import row_in
from ..designs.wishing import wished_record
from ..runs.result import json_text, rows_of
from ..text.options import Json, Run, Runs, Units
from ..text.screen import console, give, waiting
from ..text.tables import print_table, table
from .ending import end_without_design
from .run_choice import front_of_run

if TYPE_CHECKING:
    from ...optimise.questions.wished import Wished

_EXAMPLE = '--at "peak_torque=110 N m"'


def wish(
    run: Run,
    at: Annotated[
        list[str],
        typer.Option(metavar="WISH"),
        'An objective, =, and a value, which is no bound, such as "peak_torque=110 N m"; or one of improve, keep, '
        '"may worsen to 120 N m" and free. May be repeated.',
    ],
    number: Annotated[
        int | None,
        typer.Argument(metavar="NO", show_default=False),
        "The design that improve, keep and worsen speak of: its number in `slidercrank front RUN`.",
    ] = None,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the optimal design that comes nearest to wished values of the objectives, solved anew.

    Where all of it can be had, the design is better in all of it; otherwise what binds gives way by the same share of
    its range over the front. Objectives that are not named are free. The exit code is 3 where no design stays within
    what may worsen. Nothing is saved.
    """
    from ...optimise.questions.wish import wish as nearest

    folder, result, front = front_of_run(run, runs, number)
    wishes = _wishes(at)
    with waiting("wishing"):
        answer = nearest(front, wishes, row=None if number is None else number - 1)
    if json:
        give(json_text({"run": str(folder), "wishes": wishes} | wished_record(answer, units)))
    elif len(answer):
        _show(result.name, wishes, answer, units)
    if not len(answer):
        end_without_design(answer.message)


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
