"""`slidercrank round`: the best designs of round numbers near one of a run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.file_names import path_text
from ...objectives.keys import key_in, split_unit
from ...objectives.kinds import System
from ..designs.columns import find_column
from ..designs.rounding import allowed_of, rounded_record, rounded_record_in, steps_of
from ..render.terminal import print_table, table
from ..runs.result import json_text
from ..text.options import Json, Number, Run, Runs, Units
from ..text.screen import console, give, say, waiting
from .ending import end_without_design
from .run_choice import front_of_run

if TYPE_CHECKING:
    from ...optimise.front.rounded import Rounded
    from ...optimise.front.rounding_search import Stage


def round(
    run: Run,
    number: Number,
    to: Annotated[
        list[str],
        typer.Option(metavar="STEP"),
        'Step of crank, rod and offset, such as "0.5 mm" or "1/32 in", or of one number that varies: "rod=1 mm". May '
        "be repeated.",
    ],
    allow: Annotated[
        list[str] | None,
        typer.Option(metavar="MISS"),
        'A requirement, =, and by how much designs may miss it, such as "stroke=0.1 mm". May be repeated.',
    ] = None,
    count: Annotated[int, typer.Option(metavar="N", min=1), "Designs to list at most."] = 5,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the best designs of round numbers near one of a run, and what each costs.

    All combinations of multiples of the steps around the design are judged exactly. Listed are those that meet every
    requirement, or miss it by no more than --allow says, and that no other one beats in every objective, least loss
    first: the greatest over the objectives, each by its range over the front. If the best loses much, those that miss
    little and lose clearly less follow. Where none meets all, the nearest are listed, each with what it misses and by
    how much; the exit code is then 3. Ctrl-C ends the search.
    """
    folder, front = front_of_run(run, runs, number)
    steps = steps_of(to, front.part(number - 1), key="--to")
    allowed = allowed_of(allow or (), key="--allow")
    from ...optimise.front.progress import standing

    with waiting("rounding") as status:

        def tell(at: Stage) -> None:
            if status is not None:
                status.update(standing(vars(at)))

        found = front.rounded(number - 1, steps, count=count, allow=allowed, progress=tell)
    record = rounded_record_in(units, {"run": path_text(folder), "number": number} | rounded_record(found), found)
    if json:
        give(json_text(record))
    elif len(found):
        _show(f"{front.problem.name}: design {number}", record, found, units)
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


def _show(title: str, record: dict[str, Any], found: Rounded, units: System) -> None:
    """Write the designs as the columns of a table, and what the first costs. record: in the units."""
    screen = console()
    given, designs = record["given"], record["designs"]
    steps = (f"{find_column(key, given).title} {_told(key, value)}" for key, value in record["steps"].items())
    screen.print(f"{title}, rounded: {', '.join(steps)}", style="bold", soft_wrap=True)
    screen.print()
    heads = [f">{number}" for number in range(1, len(designs) + 1)]
    rows = table("quantity", "unit", ">given", *heads, ruled=True, padding=(0, 2, 0, 0), pad_edge=True)
    wanted = [found.problem.quantity(item.quantity) for item in found.problem.objectives]
    objectives = {key_in(of.field, units)[0]: of for of in wanted}
    for key in given:
        column = find_column(key, given)
        numbers = [f"{row[key]:.6g}" for row in designs]
        title = objectives[key].title if key in objectives else column.title  # of a formula as it is written
        rows.add_row(title, column.unit, f"{given[key]:.6g}", *numbers)
        if key in objectives:
            percents = [row[f"change_{objectives[key].stem}_percent"] for row in designs]
            rows.add_row("  change", column.unit, "", *(f"{row[f'change_{key}']:+.3g}" for row in designs))
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
        screen.print(f"\n{record['message']}", soft_wrap=True)
    for note in found.notes:
        say(f"note: {note}")


def _percent(value: float) -> str:
    return f"{value:+.2g}" if math.isfinite(value) else "-"


def _requirements(row: dict[str, Any], found: Rounded, units: System) -> str:
    """Return in words what a design misses, or which requirement is tightest."""
    if row["misses"]:
        return f"misses {' and '.join(_missed(miss) for miss in row['misses'])}"
    if row["tightest"] is None:
        return "keeps every requirement"
    of = found.problem.quantity(row["tightest"])
    if any(item.equality for item in found.constraints if item.quantity == row["tightest"]):
        return f"tightest is {of.title}, which is required exactly"
    key = key_in(f"slack_{of.field}", units)[0]
    return f"tightest is {of.title}, slack {_told(key, row[key])}"


def _missed(miss: dict[str, Any]) -> str:
    allowed = f"; {miss['allowed']:.4g} {miss['unit']}".rstrip() + " is allowed" if miss["allowed"] else ""
    amount = f"{miss['amount']:.4g} {miss['unit']}".rstrip()
    return f"{miss['title']} by {amount} ({miss['side']}{allowed})"


def _told(key: str, value: float) -> str:
    """Return a value with the unit of its key."""
    return f"{value:.4g} {split_unit(key)[1]}".strip()
