"""`slidercrank round`: the best designs of round numbers near one of a run."""

from __future__ import annotations

import contextlib
import math
import re
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...objectives.kinds import System
from ..designs.columns import DIMENSIONS, find_column, key_in, metric_key, split_unit
from ..designs.picking_options import require_alone
from ..designs.shown_units import record_in
from ..runs.result import json_text
from ..runs.stored_runs import problem_of
from ..text.options import Json, Run, Runs, Units, value_option
from ..text.screen import console, give, say, waiting
from ..text.tables import print_table, table
from .ending import end_without_design
from .run_choice import run_of

if TYPE_CHECKING:
    from ...optimise.front.rounded import Rounded
    from ...optimise.problem.problem import Problem

_FRACTION = re.compile(r"\s*([+-]?\d+)\s*/\s*(\d+)\s*([A-Za-z].*)")
_EXAMPLE = '--to "0.5 mm" or --to "rod=1 mm"'


def round(
    run: Run,
    number: Annotated[int, typer.Argument(metavar="NO"), "The design: its number in `slidercrank front RUN`."],
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
    requirement, least loss first: the greatest over the objectives, each by its range over the front. Where none keeps
    all, the nearest are told, with what they miss; the exit code is then 3.
    """
    from ..designs.stored_designs import front_of

    folder, result = run_of(run, runs)
    require_alone(number, result, run, others=False)
    problem = problem_of(folder, result)
    front = front_of(problem, result)
    steps = _steps(to, front.part(number - 1))
    with waiting("rounding"):
        found = front.rounded(number - 1, steps, count=count)
        record = {"run": str(folder), "number": number} | _record(found)
    if json:
        give(json_text(_in(units, record, found)))
    elif len(found):
        _show(f"{result.name}: design {number}", record, found, units)
    if not found.met:
        end_without_design(found.message)


def _steps(to: list[str], part: Problem) -> dict[str, float]:
    """Return the steps by name, SI; one without a name is that of every length without its own."""
    from ...model.machine.numbers import unit_of
    from ...objectives.kinds import LENGTH
    from ...objectives.tables.varying_column import varying_column
    from ...optimise.job.units import kind_of

    kinds = dict.fromkeys(DIMENSIONS, LENGTH)
    names = {name: name for name in DIMENSIONS} | {f"{name}_mm": name for name in DIMENSIONS}
    for item in part.mechanism.varying:
        column = varying_column(item)[0]
        kinds[item.name] = kind_of(unit_of(item.paths[0]))
        names |= {item.name: item.name, column: item.name, split_unit(column)[0]: item.name}
    found: dict[str, float] = {}
    for text in to:
        name, equals, value = (piece.strip() for piece in text.rpartition("="))
        name = metric_key(name)
        if equals and name not in names:
            raise InputError(f"--to is for {', '.join(kinds)}; got {name!r}; name one of them, like {_EXAMPLE}")
        key = names[name] if equals else ""
        if key in found:
            raise InputError(f"--to gives each step once; got {key or 'that of all lengths'} twice; leave out one")
        found[key] = _step(value, kinds[key] if key else LENGTH)
    every = found.pop("", None)
    return (dict.fromkeys(DIMENSIONS, every) if every is not None else {}) | found


def _step(text: str, kind: Any) -> float:
    """Return a step, SI. A fraction of a unit is one of its whole numbers: "1/32 in"."""
    fraction = _FRACTION.fullmatch(text)
    if fraction is not None and int(fraction[2]):
        with contextlib.suppress(InputError):  # told below, with the text as it is
            return value_option("--to", f"{fraction[1]} {fraction[3]}", kind, sign="positive") / int(fraction[2])
    return value_option("--to", text, kind, sign="positive")


def _record(found: Rounded) -> dict[str, Any]:
    """Return the answer as JSON has it, metric."""
    part = found.problem
    given: dict[str, Any] = {column: factor * value for (column, factor), value in _sized(found, found.given)}
    for wanted, value in zip(part.objectives, found.before.tolist(), strict=True):
        of = part.quantity(wanted.quantity)
        given[of.field] = value * of.unit.factor
    rows = [
        {name: values[row].item() for name, values in found.columns.items()}
        | {"tightest": found.tightest(row), "missed": found.missed(row)}
        for row in range(len(found))
    ]
    return {
        "met": found.met,
        "message": found.message,
        "steps": {found.names[name][0]: found.names[name][1] * step for name, step in found.steps.items()},
        "within_steps": found.reach,
        "judged": found.judged,
        "kept": found.kept,
        "given": given,
        "designs": rows,
        "notes": list(found.notes),
    }


def _in(units: System, record: dict[str, Any], found: Rounded) -> dict[str, Any]:
    """Return the answer in a system of units, its round numbers as they are written there."""
    from ...optimise.front.rounded import written

    told: dict[str, Any] = record_in(record, units)
    keys = [key_in(found.names[name][0], units)[0] for name in found.steps]
    for row in (told["steps"], *told["designs"]):
        row.update({key: written(row[key]) for key in keys})
    return told


def _sized(found: Rounded, design: Any) -> list[tuple[tuple[str, float], float]]:
    return list(zip(found.names.values(), design.tolist(), strict=True))


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
    objectives = {of.field: of.stem for of in wanted}
    for key in given:
        name, factor = key_in(key, units)
        column = find_column(name, {key_in(each, units)[0]: None for each in given})
        numbers = [f"{factor * row[key]:.6g}" for row in designs]
        rows.add_row(column.title, column.unit, f"{factor * given[key]:.6g}", *numbers)
        if key in objectives:
            percents = [row[f"change_{objectives[key]}_percent"] for row in designs]
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
