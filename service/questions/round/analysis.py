"""Rounded neighbours of a design on a front: their losses and missed requirements, and the parsing of steps."""

import math
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from typing import Any

from ....model.errors import InputError
from ....model.linkage.dimensions import DIMENSIONS
from ....objectives.kinds import (
    LENGTH,
    SMALL_LENGTH,
    Kind,
    System,
    column_key_in_system,
    metric_key,
    metric_unit_in,
    name_unit_and_factor_of_key,
)
from ....objectives.units import kind_of_symbol, quote
from ....optimise.front.front import ParetoFront
from ....optimise.front.progress import stage_text
from ....optimise.front.rounded_design import Rounded, drop_conversion_rounding
from ....optimise.front.rounding_search import Stage
from ....optimise.problem.problem import Problem
from ...designs.columns import find_column
from ...designs.display_units import convert_record
from ...designs.selection import parse_value
from ...render.blocks import (
    Block,
    Phrase,
    Sentence,
    Table,
    Text,
    Value,
    column,
    heading,
    joined,
    value_from_record,
    words,
)
from ..design_table import title_and_unit
from ..front_or_job_question import Answer, SearchListener
from ..inputs import PlainInput, texts_by_name
from . import QUESTION

_TO, _ALLOW = (one for one in QUESTION.inputs if isinstance(one, PlainInput) and one.example)


def analyse(front: ParetoFront, *, row: int, watch: SearchListener, words: Mapping[str, str], **inputs: Any) -> Answer:
    """Return the rounded neighbours of a design. Raises the errors of `search_rounded_neighbours`."""
    for at in search_rounded_neighbours(front, row, words, **inputs):
        if isinstance(at, Answer):
            return at
        watch.report(stage_text(vars(at)))
    raise AssertionError("the search ends with its answer")


def search_rounded_neighbours(
    front: ParetoFront,
    row: int,
    words: Mapping[str, str],
    *,
    to: Sequence[str],
    allow: Sequence[str] = (),
    count: int = 5,
) -> Iterator[Stage | Answer]:
    """Yield the search progress several times a second, and finally the answer; closing the generator ends the search.

    to: steps, "0.5 mm" for all lengths, "rod=1 mm" for one number. allow: requirements that may be missed, each as
    "stroke=0.1 mm". count: maximum number of designs. words: the interface's names for these. Raises `InputError`.
    """
    steps = steps_of(to, front.part(row), words["to"])
    named = texts_by_name(allow, words["allow"], _ALLOW.form, _ALLOW.example)
    allowed = {metric_key(name): amount for name, amount in named.items()}
    for at in front.rounding(row, steps, count=count, allow=allowed):
        yield _record_of_rounding(at, row) if isinstance(at, Rounded) else at


def _record_of_rounding(rounded: Rounded, row: int) -> Answer:
    record = _rounding_record(rounded)
    return Answer(
        record=lambda units: _record_in_units(units, record, rounded),
        blocks=_rounding_blocks(rounded, record, row) if len(rounded) else [],
        is_satisfied=rounded.is_met,
        message=rounded.message,
        notes=rounded.notes,
        search_result=rounded,
    )


def steps_of(texts: Sequence[str], part: Problem, key: str) -> dict[str, float]:
    """Return the steps by name, SI. key: name of the input, for messages. Raises `InputError`."""
    from ....model.machine.raw_numbers_of_designs import unit_of_number
    from ....objectives.tables.design_input import column_of_variable

    kinds = dict.fromkeys(DIMENSIONS, LENGTH)
    names = {name: name for name in DIMENSIONS} | {f"{name}_mm": name for name in DIMENSIONS}
    for item in part.mechanism.varying:
        column_key = column_of_variable(item)[0]
        kinds[item.name] = kind_of_symbol(unit_of_number(item.paths[0]))
        names |= {item.name: item.name, column_key: item.name, name_unit_and_factor_of_key(column_key)[0]: item.name}
    steps: dict[str, float] = {}
    for text in texts:
        name, equals, value = (piece.strip() for piece in text.rpartition("="))
        name = metric_key(name)
        if not value:
            raise InputError(f"{key} must be STEP or NAME=STEP; got {quote(text)}; write it like {_TO.example}")
        if equals and name not in names:
            raise InputError(f"{key} must name {', '.join(kinds)}; got {name!r}; name one of them, like {_TO.example}")
        variable = names[name] if equals else ""
        if variable in steps:
            raise InputError(
                f"{key} may give each step only once; got {variable or 'that of all lengths'} twice; leave out one"
            )
        steps[variable] = _read_step(value, kinds[variable] if variable else LENGTH, key)
    every = steps.pop("", None)
    return (dict.fromkeys(DIMENSIONS, every) if every is not None else {}) | steps


def _read_step(text: str, kind: Kind, key: str) -> float:
    """Return a step, SI, parsed as in a job."""
    from ....optimise.job.value_grids import read_step

    small = SMALL_LENGTH if kind is LENGTH else kind
    return read_step(text, lambda given: parse_value(key, str(given), small, sign="positive"))


def _rounding_record(rounded: Rounded) -> dict[str, Any]:
    """Return the answer as JSON, metric."""
    part = rounded.problem
    original: dict[str, Any] = {
        name: factor * value
        for (name, factor), value in zip(rounded.names.values(), rounded.design.tolist(), strict=True)
    }
    for objective, value in zip(part.objectives, rounded.design_objectives.tolist(), strict=True):
        quantity = part.quantity(objective.quantity)
        original[quantity.field] = value * quantity.unit.factor
    allowed = {part.quantity(name): value for name, value in rounded.allowed.items()}
    rows = [
        {name: values[row].item() for name, values in rounded.columns.items()}
        | {
            "tightest": rounded.tightest(row),
            "missed": rounded.missed(row),
            "misses": [dict(vars(miss)) for miss in rounded.misses(row)],
        }
        for row in range(len(rounded))
    ]
    return {
        "met": rounded.is_met,
        "message": rounded.message,
        "steps": {rounded.names[name][0]: rounded.names[name][1] * step for name, step in rounded.steps.items()},
        "allowed": {
            quantity.field: drop_conversion_rounding(value * quantity.unit.factor)
            for quantity, value in allowed.items()
        },
        "within_steps": rounded.steps_tried,
        "judged": rounded.judged,
        "kept": rounded.feasible_count,
        "given": original,
        "designs": rows,
        "notes": list(rounded.notes),
    }


def _record_in_units(units: System, record: dict[str, Any], rounded: Rounded) -> dict[str, Any]:
    """Return the answer in a unit system, with round numbers as entered in that system."""
    converted: dict[str, Any] = convert_record(deepcopy(record), units) | {"message": rounded.message_in(units)}
    keys = [column_key_in_system(rounded.names[name][0], units)[0] for name in rounded.steps]
    for row in (converted["steps"], *converted["designs"]):
        row.update({key: drop_conversion_rounding(row[key]) for key in keys})
    converted["allowed"] = {key: drop_conversion_rounding(value) for key, value in converted["allowed"].items()}
    for miss in (miss for row in converted["designs"] for miss in row["misses"]):
        miss["unit"], factor = metric_unit_in(miss["unit"], units)
        miss.update(amount=factor * miss["amount"], allowed=drop_conversion_rounding(factor * miss["allowed"]))
    return converted


def _rounding_blocks(rounded: Rounded, record: dict[str, Any], row: int) -> list[Block]:
    """Return the designs as the columns of a table, and the requirements that each misses or nearly misses."""
    original, designs, steps = record["given"], record["designs"], record["steps"]
    step_texts = [
        words("{title} {step}", title=find_column(key, original).title, step=value_from_record(steps, key, digits=4))
        for key in steps
    ]
    objectives = {
        (quantity := rounded.problem.quantity(item.quantity)).field: quantity for item in rounded.problem.objectives
    }
    rows: list[tuple[Text, ...]] = []
    for key in original:
        title, unit = title_and_unit(key, original)
        if key in objectives:
            title = objectives[key].title  # of a formula, as written
        rows.append(
            (title, unit, value_from_record(original, key), *(value_from_record(design, key) for design in designs))
        )
        if key in objectives:
            stem = objectives[key].column_stem
            changes = (value_from_record(design, f"change_{key}", digits=3, sign=True) for design in designs)
            rows.append(("  change", unit, "", *changes))
            rows.append(("", "%", "", *(_format_loss(design[f"change_{stem}_percent"]) for design in designs)))
    range_ = "% of range" if len(objectives) > 1 else "% of value"
    rows.append(("greatest loss", range_, "", *(_format_loss(design["loss_percent"]) for design in designs)))
    heads = (column("quantity", left=True), column("unit", left=True), column("given"))
    numbers = tuple(column(str(number)) for number in range(1, len(designs) + 1))
    name = rounded.problem.name
    return [
        heading(f"{{name}}: design {row + 1}, rounded: {{steps}}", name=name, steps=joined(step_texts)),
        Table((*heads, *numbers), tuple(rows), ruled=True, space_before=True),
        *(
            Sentence(words(f"{number}: {{requirements}}", requirements=_requirements_text(design, rounded)))
            for number, design in enumerate(designs, 1)
        ),
        *([Sentence(Phrase(rounded.message, rounded.message_in("inch")), space_before=True)] if rounded.is_met else []),
    ]


def _format_loss(value: float) -> Value:
    return Value(value if math.isfinite(value) else None, digits=2, sign=True, missing="-")


def _requirements_text(design: Mapping[str, Any], rounded: Rounded) -> Text:
    """Return in words the requirements that a design misses, or else the tightest one."""
    if design["misses"]:
        missed = joined([_format_miss(miss, rounded.problem) for miss in design["misses"]], " and ")
        return words("misses {missed}", missed=missed)
    if design["tightest"] is None:
        return "meets every requirement"
    quantity = rounded.problem.quantity(design["tightest"])
    if any(item.equality for item in rounded.constraints if item.quantity == design["tightest"]):
        return f"tightest is {quantity.title}, which is required exactly"
    slack = value_from_record(design, f"slack_{quantity.field}", digits=4)
    return words("tightest is {title}, slack {slack}", title=quantity.title, slack=slack)


def _format_miss(miss: Mapping[str, Any], problem: Problem) -> Text:
    quantity = problem.quantity(miss["quantity"])
    amount, allowance = (Value(miss[name] / quantity.unit.factor, quantity.kind, 4) for name in ("amount", "allowed"))
    allowed = words("; {most} is allowed", most=allowance) if miss["allowed"] else ""
    side = miss["side"]
    return words(
        "{title} by {amount} ({side}{allowed})", title=quantity.title, amount=amount, side=side, allowed=allowed
    )
