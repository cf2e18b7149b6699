"""`slidercrank front`: runs on the disk."""

from __future__ import annotations

from typing import Annotated

import typer

from ...objectives.column_keys import key_in
from ...objectives.count_text import counted
from ..designs.columns import find_columns
from ..designs.selection import no_match_message, result_part
from ..runs.result import json_text
from ..text.design_options import Selection
from ..text.options import Json, Rows, Run, Runs, Units
from ..text.screen import console, print_output
from ..text.tables import ROWS, show_design, show_front, show_result, show_violated
from .ending import NoDesigns, end_without_design
from .optimise import show_files
from .run_choice import Choice, result_in_units, run_of


def front(
    run: Run,
    *,
    selection: Selection,
    columns: Annotated[
        str | None, typer.Option(metavar="NAMES"), "Quantities or columns to show, separated by commas."
    ] = None,
    rows: Rows = ROWS,
    choice: Choice,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Show the front of a run, part of it, or one design chosen from it.

    --knee, --topsis and --lexicographic choose among the designs that meet --where; --design names one.
    """
    folder, result = run_of(run, runs)
    if not result.designs:
        raise NoDesigns(result)
    chosen_columns = find_columns(columns, list(result.designs[0])) if columns else None
    chosen, conditions = selection.rows(result), selection.where
    picked = choice.row(result, chosen) if choice.design is None else choice.number(result, run, conditions) - 1
    if picked is not None:
        chosen = [picked]
    shows_trade_offs = not conditions and (
        json or not (selection.sorts or columns or picked is not None or rows != ROWS)
    )
    result = result_in_units(result, units, folder if shows_trade_offs else None)
    listed_columns = names = None
    if chosen_columns is not None:
        listed_columns = find_columns(
            ",".join(key_in(column.key, units)[0] for column in chosen_columns), list(result.designs[0])
        )
        names = [column.key for column in listed_columns]
    if json:
        record = result_part(result, chosen).record(names)
        print_output(json_text(record if picked is None else {**record, "number": picked + 1}))
    elif picked is not None:
        screen = console()
        screen.print(f"{result.name}: design {picked + 1} of {len(result.designs)}", style="bold", soft_wrap=True)
        show_design(screen, result.designs[picked], only=names)
        of_one = {key: excess[picked] for key, excess in result.violated.items() if excess[picked] > 0.0}
        show_violated(screen, of_one, result.designs[picked])
    elif not (conditions or selection.sorts or columns or rows != ROWS):
        show_result(console(), result)
        show_files(folder)
    elif chosen:
        screen = console()
        count = "" if len(chosen) == len(result.designs) else f"{len(chosen)} of "
        screen.print(f"{result.name}: {count}{counted(len(result.designs), 'design')}", style="bold", soft_wrap=True)
        show_front(screen, result, chosen, columns=listed_columns, limit=rows)
    if not chosen:
        end_without_design(no_match_message(result, conditions or []))
