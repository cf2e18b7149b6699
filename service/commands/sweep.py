"""`slidercrank sweep`: quantities over one or two of crank, rod, offset and speed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, get_args

import typer

from ...model.errors import InputError
from ...objectives.keys import kind_of_key
from ...objectives.kinds import ANGULAR_SPEED, LENGTH
from ..designs.selection import value_of
from ..designs.shown_units import rows_in
from ..render.blocks import Table, Value, column, recorded
from ..render.terminal import print_blocks
from ..runs.result import Row, rows_of
from ..text.options import Dimensions, Figures, JobFile, Json, Units, length_option
from ..text.screen import answer, say, write_figure
from .job_or_run import turning_problem

if TYPE_CHECKING:
    from ...objectives.quantity import Quantity
    from ...objectives.tables.sweep import Axis

_FORM = re.compile(r"\s*(\w+)\s*=\s*(\S.*?)\s*\.\.\s*(\S.*?)\s*:\s*(\d+)\s*", re.ASCII | re.DOTALL)
_LIST = re.compile(r"\s*(\w+)\s*=\s*([^.:]*(?:\.\d[^.:]*)*)", re.ASCII | re.DOTALL)
_EXAMPLE = '--over "offset=0 mm..20 mm:5" or --over "offset=0 mm, 10 mm, 20 mm"'
MOST_VALUES = 10_000


def sweep(
    job: Annotated[JobFile, "A job file, .toml or .json."],
    over: Annotated[
        list[str], typer.Option(metavar="RANGE"), 'What to sweep: "offset=0 mm..20 mm:5" (5 values). Twice for a grid.'
    ],
    of: Annotated[
        list[str],
        typer.Option(metavar="QUANTITY"),
        'Quantity or formula to compute, such as peak_torque or "crank + rod". Repeatable.',
    ],
    *,
    size: Dimensions,
    figures: Annotated[Figures, "Draw the sweep into sweep.png there."] = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Sweep quantities over one or two of crank, rod, offset and speed.

    Where the linkage does not turn there is no value, nor of torques and forces where friction locks it; the reason
    is given instead.
    """
    import numpy as np

    from ...objectives.tables.sweep import sweep as all_rows

    problem = turning_problem(job, "sweep")
    axes = [parse_axis(text) for text in over]
    if len(axes) > 2:
        raise InputError(f"a sweep is over one or two parameters; got {len(axes)} --over; leave out some")
    swept = {axis.parameter for axis in axes}
    for name, text in vars(size).items():
        if name in swept and text is not None:
            raise InputError(f"{name} is swept by --over and given by --{name}; leave out one of the two")
    lengths = [1.0 if name in swept else length_option(name, text, problem) for name, text in vars(size).items()]
    names = [name for text in of for name in _names(text)]
    quantities = [problem.quantity(name) for name in names]
    swept_table = all_rows(problem.mechanism.nominal, np.array(lengths), axes, names, own=problem.own)
    rows = rows_of(swept_table.to_dict("list"))
    shown = [_table(rows, axes, quantities)]
    answer(json, rows_in(rows, units), lambda screen: print_blocks(screen, shown, units))
    if (stuck := [row["reason"] for row in rows if row["reason"]]) and not json:
        say(f"{len(stuck)} of {len(rows)} without a value; the first: {stuck[0]}")
    if figures is not None:
        from ..questions.sweep.figure import sweep_figure

        file = figures / "sweep.png"
        write_figure(file, lambda: sweep_figure(swept_table, axes, quantities, title=problem.name, system=units))


def _names(text: str) -> list[str]:
    """Return the parts between commas; those within brackets are of a function."""
    parts, depth = [""], 0
    for sign in text:
        depth += (sign == "(") - (sign == ")")
        if sign == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += sign
    return [part.strip() for part in parts if part.strip()]


def _value(row: Row, quantity: Quantity) -> Value:
    number = row[quantity.field]
    assert isinstance(number, float)
    return Value(number / quantity.unit.factor, quantity.kind, missing="-")


def _table(rows: Sequence[Row], axes: Sequence[Axis], quantities: Sequence[Quantity]) -> Table:
    """Return a row for each point, from metric rows."""
    keys = [f"{axis.parameter}_{'rpm' if axis.parameter == 'speed' else 'mm'}" for axis in axes]
    heads = [column(axis.parameter, kind_of_key(key)[1]) for axis, key in zip(axes, keys, strict=True)]
    heads += [column(item.title, item.kind) for item in quantities]
    cells = (
        (
            *(recorded(row, key) for key in keys),
            *(_value(row, item) for item in quantities),
        )
        for row in rows
    )
    return Table(tuple(heads), tuple(cells))


def parse_axis(text: str) -> Axis:
    """Return the axis of a sweep from "offset=0 mm..20 mm:5", or from a list of values. Raises `InputError`."""
    import numpy as np

    from ...objectives.tables.sweep import Axis, Parameter
    from ...objectives.units import closest

    known, asked = get_args(Parameter), text.partition("=")[0].strip()
    if "=" in text and asked and asked not in known:
        near = closest(asked, known)
        meant = f"; did you mean {near}?" if near else ""
        raise InputError(
            f"a sweep is over {', '.join(known)}; got {asked!r}{meant}; another number of a job is set by analyse "
            "--set, or varies in [variables]"
        )
    match, several = _FORM.fullmatch(text), _LIST.fullmatch(text)
    if match is None and (several is None or not several[2].strip()):
        raise InputError(
            f"a sweep is a name, its ends with units and the number of values; got {text!r}; write it like {_EXAMPLE}"
        )
    name = (match or several)[1]  # type: ignore[index]
    kind = ANGULAR_SPEED if name == "speed" else LENGTH
    sign = "positive" if name in ("crank", "rod") else "any"
    option = f"--over {name}"
    if match is None:
        assert several is not None
        values = [value_of(option, part, kind, sign=sign) for part in several[2].split(",")]
        return Axis(name, tuple(values))  # type: ignore[arg-type]
    first, last = (value_of(option, part, kind, sign=sign) for part in match.group(2, 3))
    count = int(match[4])
    if not 2 <= count <= MOST_VALUES or first == last:
        raise InputError(
            f"a range has two different ends and 2 to {MOST_VALUES:,} values; got {text!r}; write it like {_EXAMPLE}"
        )
    return Axis(name, tuple(float(value) for value in np.linspace(first, last, count)))  # type: ignore[arg-type]
