"""Design similar to one on a front under further conditions, and the change of every number."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ....model.errors import InputError
from ....model.linkage.dimensions import DIMENSIONS
from ....optimise.decisions.similar_design import Ends, distance_to_design, intersect_ranges, nearest_optimal_design
from ....optimise.front.front import ParetoFront
from ....optimise.front.hypervolume import ideal_and_range
from ....optimise.problem.problem import Problem
from ....optimise.problem.requirements import Constraint
from ...designs.display_units import convert_record
from ...designs.judged_requirements import quantity_names
from ...designs.selection import Condition, parse_condition
from ...render.blocks import Block, Sentence, Table, Text, Value, column, heading, value_from_record
from ...runs.result import Row, rows_of_columns
from ..design_table import title_and_unit
from ..front_or_job_question import Answer
from . import QUESTION

_EXAMPLE = f"{QUESTION.inputs[0].flag} {QUESTION.inputs[0].example}"


def analyse(front: ParetoFront, *, row: int, where: Sequence[str], **_: Any) -> Answer:
    """Return the nearest design that meets the conditions. Raises the errors of `like.nearest_optimal_design`."""
    front.part(row)  # raises an error for an invalid row
    before = rows_of_columns(front.columns)[row]
    constraints, ranges = _added_constraints(where, before, front.problem)
    values, span = front.values[row], ideal_and_range(front.values)[1]
    similar = nearest_optimal_design(front.problem, before, values, span, constraints, ranges)
    record: dict[str, Any] = {"status": similar.status, "message": similar.message}
    if not len(similar):
        return Answer(
            record=lambda _: record, blocks=[Sentence(similar.message)], is_satisfied=False, message=similar.message
        )
    after = rows_of_columns(similar.columns)[0]
    record |= {
        "distance": float(distance_to_design(similar.values, values, span)[0]),
        "design": after,
        "before": before,
    }
    record["moved"] = {key: value for key in after if (value := _change_of(before, after, key)) is not None}
    title = heading(
        f"{{name}}: like design {row % len(front) + 1}, with {{where}}",
        name=front.problem.name,
        where=" and ".join(text.strip() for text in where),
    )
    return Answer(
        record=lambda units: convert_record(record, units),
        blocks=[title, *_like_blocks(front, record, row)],
        message=similar.message,
    )


def _added_constraints(texts: Sequence[str], row: Row, problem: Problem) -> tuple[list[Constraint], dict[str, Ends]]:
    """Return conditions as constraints, and those on dimensions as ranges, m; both bounds of a quantity are merged."""
    names = quantity_names(problem) | {f"{dimension}_mm": dimension for dimension in DIMENSIONS}
    ends_by_name: dict[str, Ends] = {}
    for text in texts:
        condition = parse_condition(text, list(row), row)
        formula = condition.formula
        name = names.get(condition.column.key) if formula is None else formula.text
        if name is None or isinstance(condition.value, str):
            raise InputError(
                f"a condition must begin with a quantity, a dimension or a formula of these; got {text!r}; write it "
                f"like {_EXAMPLE}"
            )
        factor = 1e3 if name in DIMENSIONS else 1.0 if formula else problem.quantity(name).unit.factor
        ends = intersect_ranges(ends_by_name.get(name, (None, None)), _ends_of_condition(condition, factor, text))
        if ends is None:
            raise InputError(
                f"the conditions on {name} must not contradict each other; got {text!r} last; leave one out"
            )
        ends_by_name[name] = ends
    ranges = {name: ends for name, ends in ends_by_name.items() if name in DIMENSIONS}
    constraints = [
        Constraint(quantity=name, lower=lower, upper=upper)
        for name, (lower, upper) in ends_by_name.items()
        if name not in DIMENSIONS
    ]
    return constraints, ranges


def _ends_of_condition(condition: Condition, factor: float, text: str) -> Ends:
    """Return the bounds in a condition, SI. factor: one SI unit in the column's unit."""
    assert not isinstance(condition.value, str)
    value = condition.value / factor
    ends = {">=": (value, None), "<=": (None, value), "==": (value, value)}.get(condition.comparison)
    if ends is None:
        raise InputError(f"a condition must use >=, <= or =; got {text!r}; write it like {_EXAMPLE}")
    return ends


def _change_of(before: Row, after: Row, key: str) -> float | None:
    """Return the change of a number; None if it is not a quantity or has no finite change."""
    old, new = before.get(key), after[key]
    if key == "residual" or not isinstance(old, float) or not isinstance(new, float):
        return None
    change = new - old
    return change if math.isfinite(change) else None


def _like_blocks(front: ParetoFront, record: Mapping[str, Any], row: int) -> list[Block]:
    before, after, moved = record["before"], record["design"], record["moved"]
    objectives = {front.problem.quantity(item.quantity).field for item in front.objectives}
    keys = [key for key in moved if not key.startswith("slack_")]
    rows: list[tuple[Text, ...]] = []
    for key in keys:
        span = float(np.ptp(front.columns[key])) if key in objectives else 0.0
        share: Text = Value(100.0 * moved[key] / span, decimals=2, sign=True) if span else ""
        change = value_from_record(moved, key, digits=3, sign=True)
        rows.append(
            (*title_and_unit(key, after), value_from_record(before, key), value_from_record(after, key), change, share)
        )
    heads = (f"design {row % len(front) + 1}", "now", "change", "% of range")
    columns = (column("quantity", left=True), column("unit", left=True), *map(column, heads))
    bold = tuple(place for place, key in enumerate(keys) if key in objectives)
    distance_text = f"distance {record['distance']:.4g} of the objectives' ranges"
    return [
        Table(columns, tuple(rows), ruled=True, space_before=True, bold=bold),
        Sentence(f"{after['status']}: residual {after['residual']:.1e}; {distance_text}"),
    ]
