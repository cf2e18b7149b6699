"""`slidercrank like`: a design of a run, but with something else."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError
from ...model.file_names import path_text
from ...model.linkage.dimensions import DIMENSIONS
from ..designs.columns import find_column
from ..designs.selection import Condition, parse_condition
from ..designs.shown_units import record_in, result_in, row_in
from ..render.terminal import print_table, table
from ..runs.result import Result, Row, json_text, rows_of
from ..runs.stored_runs import read_run
from ..text.options import Json, Number, Run, Runs, Units
from ..text.screen import answer, give, waiting
from .ending import end_without_design
from .run_choice import front_of_run

if TYPE_CHECKING:
    from rich.console import Console

    from ...optimise.problem.problem import Problem
    from ...optimise.problem.requirements import Constraint

_EXAMPLE = '--where "transmission_angle >= 45 deg"'
Ends = tuple[float | None, float | None]


def like(
    run: Run,
    number: Number,
    where: Annotated[
        list[str],
        typer.Option(metavar="CONDITION"),
        'What it must also meet: a quantity, a dimension or a formula, >= <= or =, a value, such as "crank = 40 mm". '
        "May be repeated.",
    ],
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the design most like one of a run that also meets further conditions.

    It is Pareto-optimal for the run's job with the conditions added, and of those designs the nearest, objectives by
    their range over the run's front. Nothing is saved.
    """
    from ...optimise.decisions.like import distance, nearest
    from ...optimise.front.hypervolume import scaling

    folder, front = front_of_run(run, runs, number)
    result = read_run(folder)
    problem = replace(front.problem, name=result.name)
    row = result.designs[number - 1]
    constraints, ranges = _added(where, row, problem)
    with waiting("looking for it"):
        given, span = front.values[number - 1], scaling(front.values)[1]
        found = nearest(problem, row, given, span, constraints, ranges)
    if not len(found):
        if json:
            give(
                json_text(
                    {"run": path_text(folder), "number": number, "status": found.status, "message": found.message}
                )
            )
        end_without_design(found.message)
    apart = float(distance(found.values, given, span)[0])
    after = rows_of(found.columns)[0]
    record = {
        "run": path_text(folder),
        "number": number,
        "status": found.status,
        "message": found.message,
        "distance": apart,
        "design": after,
        "before": row,
        "moved": {key: value for key in after if (value := _moved(row, after, key)) is not None},
    }
    rows = row_in(row, units), row_in(after, units)
    answer(
        json,
        record_in(record, units),
        lambda screen: _show(screen, result_in(result, units), number, where, apart, *rows),
    )


def _added(where: list[str], row: Row, problem: Problem) -> tuple[list[Constraint], dict[str, Ends]]:
    """Return conditions as constraints, and those on dimensions as ranges, m; both bounds of one quantity as one."""
    from ...optimise.decisions.like import common
    from ...optimise.problem.requirements import Constraint
    from ..designs.requirements import names_of

    names = names_of(problem) | {f"{dimension}_mm": dimension for dimension in DIMENSIONS}
    found: dict[str, Ends] = {}
    for text in where:
        condition = parse_condition(text, list(row), row)
        formula = condition.formula
        name = names.get(condition.column.key) if formula is None else formula.text
        if name is None or isinstance(condition.value, str):
            raise InputError(
                "a design can be asked for by quantities, dimensions and formulas of these; "
                f"got {text!r}; write it like {_EXAMPLE}"
            )
        factor = 1e3 if name in DIMENSIONS else 1.0 if formula else problem.quantity(name).unit.factor
        ends = common(found.get(name, (None, None)), _ends(condition, factor, text))
        if ends is None:
            raise InputError(f"the conditions on {name} contradict each other; got {text!r} last; leave out one")
        found[name] = ends
    ranges = {name: ends for name, ends in found.items() if name in DIMENSIONS}
    constraints = [
        Constraint(quantity=name, lower=lower, upper=upper)
        for name, (lower, upper) in found.items()
        if name not in DIMENSIONS
    ]
    return constraints, ranges


def _ends(condition: Condition, factor: float, text: str) -> Ends:
    """Return the ends that a condition gives, SI. factor: what one SI unit is in the column's."""
    assert not isinstance(condition.value, str)
    value = condition.value / factor
    ends = {">=": (value, None), "<=": (None, value), "==": (value, value)}.get(condition.comparison)
    if ends is None:
        raise InputError(f"a design is asked for with >=, <= or =; got {text!r}; write it like {_EXAMPLE}")
    return ends


def _moved(before: Row, after: Row, key: str) -> float | None:
    """Return by how much a number changed; None for what is no quantity or has no finite change."""
    old, new = before.get(key), after[key]
    if key == "residual" or not isinstance(old, float) or not isinstance(new, float):
        return None
    change = new - old
    return change if math.isfinite(change) else None


def _show(
    screen: Console, result: Result, number: int, where: list[str], apart: float, before: Row, after: Row
) -> None:
    screen.print(
        f"{result.name}: like design {number}, with {' and '.join(text.strip() for text in where)}",
        style="bold",
        soft_wrap=True,
    )
    heads = ("quantity", "unit", f">design {number}", ">now", ">change", ">% of range")
    rows = table(*heads, ruled=True, padding=(0, 2, 0, 0), pad_edge=True)
    columns = {wanted.column for wanted in result.objectives}
    for key in after:
        change = _moved(before, after, key)
        if change is None or key.startswith("slack_"):
            continue
        column, objective = find_column(key, after), key in columns
        share = f"{100.0 * change / _range(result, key):+.2f}" if objective and _range(result, key) else ""
        numbers = (f"{before[key]:.6g}", f"{after[key]:.6g}", f"{change:+.3g}", share)
        rows.add_row(column.title, column.unit, *numbers, style="bold" if objective else "")
    screen.print()
    print_table(screen, rows)
    screen.print(
        f"\n{after['status']}: residual {after['residual']:.1e}; distance {apart:.4g} of the objectives' ranges",
        soft_wrap=True,
    )


def _range(result: Result, key: str) -> float:
    values = [value for row in result.designs if isinstance(value := row[key], float)]
    return max(values) - min(values)
