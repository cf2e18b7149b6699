"""Quantities of a job over one or two of crank, rod, offset and speed: a row for each point."""

import re
from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np

from ....model.errors import InputError
from ....model.linkage.dimensions import DIMENSIONS
from ....objectives.kinds import ANGULAR_SPEED, LENGTH, name_and_kind_of_key
from ....objectives.quantity import Quantity
from ....objectives.registry import FACTS
from ....objectives.tables.sensitivity import Axis, Parameter, sweep
from ....objectives.units import closest_word
from ....optimise.problem.problem import Problem
from ...designs.display_units import convert_rows
from ...designs.rotating_crank import require_rotating_crank
from ...designs.selection import parse_value
from ...render.blocks import Table, Value, column, value_from_record
from ...runs.result import Row, rows_of_columns
from ...text.options import length_option
from ..front_or_job_question import Answer

_FORM = re.compile(r"\s*(\w+)\s*=\s*(\S.*?)\s*\.\.\s*(\S.*?)\s*:\s*(\d+)\s*", re.ASCII | re.DOTALL)
_LIST = re.compile(r"\s*(\w+)\s*=\s*([^.:]*(?:\.\d[^.:]*)*)", re.ASCII | re.DOTALL)
MOST_VALUES = 10_000


def analyse(
    problem: Problem, *, words: Mapping[str, str], over: Sequence[str], of: Sequence[str], **given: Any
) -> Answer:
    """Return the rows of the sweep. given: lengths that are not swept, m.

    over: one or two texts such as "offset=0 mm..20 mm:5". of: names and formulas, comma-separated within a text. Raises
    `InputError`, also for a swing problem.
    """
    require_rotating_crank(problem.motion, "sweep")
    axes = [parse_axis(text, words["over"]) for text in over]
    if len(axes) > 2:
        raise InputError(f"a sweep must have one or two parameters; got {len(axes)} {words['over']}; leave out some")
    swept = {axis.parameter for axis in axes}
    for name in DIMENSIONS:
        if name in swept and given.get(name) is not None:
            raise InputError(f"{name} may be set by {words['over']} or by {words[name]}; got both; leave out one")
    usual = dict.fromkeys(swept, 1.0) | given
    lengths = [
        usual[name] if name in usual else length_option(name, None, problem, words.__getitem__) for name in DIMENSIONS
    ]
    names = [name for text in of for name in _split_names(text)]
    quantities = [problem.quantity(name) for name in names]
    table = sweep(problem.mechanism.nominal, np.array(lengths), axes, names, custom=problem.own)
    rows = rows_of_columns(table.to_dict("list"))
    stuck = [row["reason"] for row in rows if row["reason"]]
    return Answer(
        record=lambda units: {"rows": convert_rows(rows, units)},
        blocks=[_sweep_table(rows, axes, quantities)],
        notes=[f"{len(stuck)} of {len(rows)} have no value; the first: {stuck[0]}"] if stuck else [],
        search_result=(table, axes, quantities),
    )


def _split_names(text: str) -> list[str]:
    """Return the parts between commas; commas within brackets belong to a function."""
    parts, depth = [""], 0
    for sign in text:
        depth += (sign == "(") - (sign == ")")
        if sign == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += sign
    return [part.strip() for part in parts if part.strip()]


def _sweep_table(rows: Sequence[Row], axes: Sequence[Axis], quantities: Sequence[Quantity]) -> Table:
    """Return a row for each point, from metric rows."""

    def value(row: Row, quantity: Quantity) -> Value:
        number = row[quantity.field]
        assert isinstance(number, float)
        return Value(number / quantity.unit.factor, quantity.kind, missing="-")

    keys = [f"{axis.parameter}_{'rpm' if axis.parameter == 'speed' else 'mm'}" for axis in axes]
    heads = [column(axis.parameter, name_and_kind_of_key(key)[1]) for axis, key in zip(axes, keys, strict=True)]
    heads += [column(quantity.title, quantity.kind) for quantity in quantities]
    cells = (
        (*(value_from_record(row, key) for key in keys), *(value(row, quantity) for quantity in quantities))
        for row in rows
    )
    return Table(tuple(heads), tuple(cells))


def parse_axis(text: str, word: str = "over") -> Axis:
    """Return the axis of a sweep from "offset=0 mm..20 mm:5", or from a list of values. Raises `InputError`.

    word: the interface's name for the parameter.
    """
    parameters, parameter = get_args(Parameter), text.partition("=")[0].strip()
    example = f'{word} "offset=0 mm..20 mm:5" or {word} "offset=0 mm, 10 mm, 20 mm"'
    if "=" in text and parameter and parameter not in parameters:
        remedy = "set other numbers in the job or with analyse --set, or let them vary in [variables]"
        if parameter in FACTS:
            remedy = f"{parameter} follows from these: sweep one of them, and compute {parameter} as a quantity"
        elif near := closest_word(parameter, parameters):
            remedy = f"did you mean {near}?"
        raise InputError(f"a sweep must be over one of {', '.join(parameters)}; got {parameter!r}; {remedy}")
    match, several = _FORM.fullmatch(text), _LIST.fullmatch(text)
    if match is None and (several is None or not several[2].strip()):
        raise InputError(
            f"a sweep needs a name, two ends with units and the number of values; got {text!r}; write it like {example}"
        )
    name = (match or several)[1]  # type: ignore[index]
    kind = ANGULAR_SPEED if name == "speed" else LENGTH
    sign = "positive" if name in ("crank", "rod") else "any"
    option = f"{word} {name}"
    if match is None:
        assert several is not None
        values = [parse_value(option, part, kind, sign=sign) for part in several[2].split(",")]
        return Axis(name, tuple(values))  # type: ignore[arg-type]
    first, last = (parse_value(option, part, kind, sign=sign) for part in match.group(2, 3))
    count = int(match[4])
    if not 2 <= count <= MOST_VALUES or first == last:
        raise InputError(
            f"a range must have two different ends and 2 to {MOST_VALUES:,} values; got {text!r}; write it like "
            f"{example}"
        )
    return Axis(name, tuple(float(value) for value in np.linspace(first, last, count)))  # type: ignore[arg-type]
