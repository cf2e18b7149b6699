"""`slidercrank round`: the best designs of round numbers near one of a run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.file_names import path_text
from ...objectives.kinds import System
from ..designs.columns import find_column, key_in, split_unit
from ..designs.rounding import rounded_record, rounded_record_in, steps_of
from ..runs.result import json_text
from ..text.options import Json, Number, Run, Runs, Units
from ..text.screen import console, give, say, waiting
from ..text.tables import print_table, table
from .ending import end_without_design
from .run_choice import front_of_run

if TYPE_CHECKING:
    from ...optimise.front.rounded import Rounded


def round(
    run: Run,
    number: Number,
    to: Annotated[
        list[str],
        typer.Option(metavar="STEP"),
        'Step of crank, rod and offset, such as "0.5 mm" or "1/32 in", or of one number that varies: "rod=1 mm". May '
        "be repeated.",
    ],
    count: Annotated[int, typer.Option(metavar="N", min=1), "Designs to tell at most."] = 5,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the best designs of round numbers near one of a run, and what each costs.

    All combinations of multiples of the steps around the design are judged exactly. Told are those that keep every
    requirement and that no other one beats in every objective, least loss first: the greatest over the objectives,
    each by its range over the front. Where none keeps all, the nearest are told, with what they miss; the exit code is
    then 3.
    """
    folder, result, front = front_of_run(run, runs, number)
    steps = steps_of(to, front.part(number - 1), key="--to")
    with waiting("rounding"):
        found = front.rounded(number - 1, steps, count=count)
        record = {"run": path_text(folder), "number": number} | rounded_record(found)
    if json:
        give(json_text(rounded_record_in(units, record, found)))
    elif len(found):
        _show(f"{result.name}: design {number}", record, found, units)
    if not found.met:
        end_without_design(found.message)


def _show(title: str, record: dict[str, Any], found: Rounded, units: System) -> None:
    """Write the designs as the columns of a table, and what the first costs."""
    screen = console()
    steps = ", ".join(_told(key, value, units) for key, value in record["steps"].items())
    screen.print(f"{title}, rounded: {steps}", style="bold", soft_wrap=True)
    screen.print()
    given, designs = record["given"], record["designs"]
    heads = [f">{number}" for number in range(1, len(designs) + 1)]
    rows = table("quantity", "unit", ">given", *heads, ruled=True, padding=(0, 2, 0, 0), pad_edge=True)
    wanted = [found.problem.quantity(item.quantity) for item in found.problem.objectives]
    objectives = {of.field: of for of in wanted}
    for key in given:
        name, factor = key_in(key, units)
        column = find_column(name, {key_in(each, units)[0]: None for each in given})
        numbers = [f"{factor * row[key]:.6g}" for row in designs]
        title = objectives[key].title if key in objectives else column.title  # of a formula as it is written
        rows.add_row(title, column.unit, f"{factor * given[key]:.6g}", *numbers)
        if key in objectives:
            percents = [row[f"change_{objectives[key].stem}_percent"] for row in designs]
            rows.add_row("  change", column.unit, "", *(f"{factor * row[f'change_{key}']:+.3g}" for row in designs))
            rows.add_row("", "%", "", *(_percent(percent) for percent in percents))
    rows.add_row(
        "greatest loss",
        "% of range" if len(wanted) > 1 else "% of value",
        "",
        *(_percent(row["loss_percent"]) for row in designs),
    )
    print_table(screen, rows)
    screen.print()
    for number, row in enumerate(designs, 1):
        screen.print(f"{number}: {_requirements(row, found, units)}", soft_wrap=True)
    if found.met:
        screen.print(f"\n{found.message}", soft_wrap=True)
    for note in found.notes:
        say(f"note: {note}")


def _percent(value: float) -> str:
    return f"{value:+.2g}" if math.isfinite(value) else "-"


def _requirements(row: dict[str, Any], found: Rounded, units: System) -> str:
    """Return in words what a design misses, or which requirement is tightest."""
    if row["missed"]:
        parts = []
        for name in row["missed"]:
            of = found.problem.quantity(name)
            parts.append(f"{of.title} by {_told(f'slack_{of.field}', abs(row[f'slack_{of.field}']), units, bare=True)}")
        return f"misses {' and '.join(parts)}"
    if row["tightest"] is None:
        return "keeps every requirement"
    of = found.problem.quantity(row["tightest"])
    return f"tightest is {of.title}, slack {_told(f'slack_{of.field}', row[f'slack_{of.field}'], units, bare=True)}"


def _told(key: str, value: float, units: System, *, bare: bool = False) -> str:
    """Return a metric value with its unit in a system, after its name unless bare."""
    name, factor = key_in(key, units)
    plain, unit, _ = split_unit(name)
    number = f"{factor * value:.4g} {unit}".strip()
    return number if bare else f"{plain.replace('_', ' ')} {number}"
