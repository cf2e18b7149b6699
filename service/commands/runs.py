"""`slidercrank front`: runs that are on the disk."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Annotated

import typer

from ...model.errors import SlidercrankError
from ...objectives.kinds import System
from ..jobs.find_run import find_run
from ..runs.result import Result, json_text
from ..runs.run_folder import runs_place
from ..runs.stored_runs import problem_of, read_run
from ..text.options import Units
from ..text.screen import console, give, say
from ..text.tables import ROWS, show_design, show_front
from .optimise import NOTHING_FEASIBLE, Json, Runs, show_result

Run = Annotated[
    str,
    typer.Argument(
        metavar="RUN",
        help='The run: its folder, its name in the place of runs, the start of the name, or "latest".',
    ),
]


def front(
    run: Run,
    where: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CONDITION",
            help='Only designs that meet it, such as "transmission_angle >= 40 deg" or "slow_stroke = inward". '
            "May be repeated.",
        ),
    ] = None,
    sort: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Sort by a quantity or column: best first for an objective, else smallest first.",
        ),
    ] = None,
    reverse: Annotated[bool, typer.Option("--reverse", help="Turn the order round.")] = False,
    columns: Annotated[
        str | None,
        typer.Option(metavar="NAMES", help="Quantities or columns to show, separated by commas."),
    ] = None,
    rows: Annotated[int, typer.Option(min=0, help="Show at most so many designs; 0 shows all.")] = ROWS,
    design: Annotated[
        int | None, typer.Option(metavar="NO", help="Show one design by its number in the front.")
    ] = None,
    knee: Annotated[
        bool, typer.Option("--knee", help="Choose one design: the nearest to the ideal, objectives by their range.")
    ] = False,
    topsis: Annotated[
        str | None,
        typer.Option(
            metavar="WEIGHTS",
            help='Choose one design by weights of the objectives, such as "peak_torque=2, transmission_angle=1".',
        ),
    ] = None,
    lexicographic: Annotated[
        str | None,
        typer.Option(
            metavar="RANKING",
            help="Choose one design by ranked objectives, each with what it may give up for the next, such as "
            '"peak_torque: 5 %, time_ratio: 0.02, transmission_angle"; % is of its range.',
        ),
    ] = None,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Show the front of a run again, a part of it, or one design chosen from it.

    --knee, --topsis and --lexicographic choose among the designs that meet --where; --design names one.
    """
    from ..designs.columns import find_columns, key_in
    from ..designs.picking_options import picked_row, require_alone
    from ..designs.selection import chosen_rows, none_meets, part_of

    folder = find_run(run, runs_place(runs))
    result = read_run(folder)
    if not result.designs:
        if json:
            give(json_text(result.record()))
        say(f"slidercrank: {result.message}")
        raise typer.Exit(NOTHING_FEASIBLE)
    keys = list(result.designs[0])
    wanted = find_columns(columns, keys) if columns else None
    chosen = chosen_rows(result, where or [], sort=sort, reverse=reverse)
    if design is None:
        one = picked_row(result, chosen, knee=knee, topsis=topsis, lexicographic=lexicographic)
    else:
        require_alone(design, result, run, others=bool(knee or topsis or lexicographic or where))
        one = design - 1
    if one is not None:
        chosen = [one]
    told = not where and (json or not (sort or reverse or columns or one is not None or rows != ROWS))
    result = shown_result(result, units, folder if told else None)
    shown = None
    if wanted is not None:
        shown = find_columns(",".join(key_in(column.key, units)[0] for column in wanted), list(result.designs[0]))
    if json:
        picked = part_of(result, chosen)
        record = picked.record()
        if shown is not None:
            names = [column.key for column in shown]
            record["designs"] = [{name: row[name] for name in names} for row in record["designs"]]
        give(json_text(record if one is None else {**record, "number": one + 1}))
    elif one is not None:
        screen = console()
        screen.print(f"{result.name}: design {one + 1} of {len(result.designs)}", style="bold", soft_wrap=True)
        show_design(screen, result.designs[one], only=[column.key for column in shown] if shown else None)
    elif not (where or sort or reverse or columns or rows != ROWS):
        show_result(result)
    elif chosen:
        screen = console()
        screen.print(f"{result.name}: {_count(chosen, result)}", style="bold", soft_wrap=True)
        show_front(screen, result, chosen, columns=shown, most=rows)
    if not chosen:
        say(f"slidercrank: {none_meets(result, where or [])}")
        raise typer.Exit(NOTHING_FEASIBLE)


def shown_result(result: Result, units: System, folder: Path | None) -> Result:
    """Return the result of a run in the units that are asked for.

    folder: of the run, where its trade-offs are told; None where they are not.
    """
    if units == "metric":
        return result
    from ..designs.shown_units import result_in

    problem = None
    if folder is not None and result.trade_offs:
        with contextlib.suppress(SlidercrankError):  # its job is of another version
            problem = problem_of(folder, result)
    return result_in(result, units, problem)


def _count(chosen: list[int], result: Result) -> str:
    if len(chosen) == len(result.designs):
        return f"{len(chosen)} designs"
    return f"{len(chosen)} of {len(result.designs)} designs"
