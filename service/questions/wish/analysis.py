"""Answer to a wish: the design, and for each objective the wish and the outcome."""

import math
from collections.abc import Mapping
from typing import Any

from ....objectives.kinds import System, metric_unit_in
from ....optimise.decisions.wish import Wishes
from ....optimise.decisions.wishes import ObjectiveOutcome, Wished
from ....optimise.front.front import ParetoFront
from ...designs.display_units import convert_row
from ...render.blocks import Block, Phrase, Sentence, Table, Text, column, heading, value_from_record, words
from ...runs.result import json_ready, rows_of_columns
from ..design_table import title_and_unit
from ..front_or_job_question import Answer


def analyse(front: ParetoFront, *, row: int | None, at: Mapping[str, object], **_: Any) -> Answer:
    """Return the answer to wishes by objective. row: reference design for improve, keep and worsen.

    Raises the errors of `optimise.decisions.wish.wish`.
    """
    return wish_result(Wishes(front).design_nearest_to_wishes(at, row=row), at)


def wish_result(wished: Wished, at: Mapping[str, object]) -> Answer:
    """Return a solved wish as an answer. at: wishes by objective, as entered.

    Its numbers: possible: whether every wish is met. sentences: the answer in words. achievement: value of the
    achievement function. objectives: wish and outcome of each, in its unit. design: row of a front's table, null if no
    design stays within the allowed limits.
    """
    rows = rows_of_columns(wished.found.columns) if len(wished) else []

    def record(units: System) -> dict[str, Any]:
        return {
            "number": None if wished.row is None else wished.row + 1,
            "possible": wished.possible,
            "sentences": wished.sentences(units),
            "achievement": json_ready(wished.value),
            "objectives": [_outcome_record(outcome, units) for outcome in wished.outcomes],
            "design": json_ready(convert_row(rows[0], units)) if rows else None,
        }

    description = wish_in_words(at, wished.row)
    title = heading("{name}: wished {told}", name=wished.found.problem.name, told=description)
    return Answer(
        record=record,
        blocks=[title, *(_wish_blocks(wished, rows[0]) if rows else [])],
        is_satisfied=bool(rows),
        message=wished.message,
        search_result=wished,
    )


def wish_in_words(at: Mapping[str, object], row: int | None) -> str:
    """Return a wish in words: "time_ratio improve, peak_torque 110 N m, from design 3"."""
    design = [] if row is None else [f"from design {row + 1}"]
    return ", ".join([*(f"{name} {value}" for name, value in at.items()), *design])


def outcome_sentences(wished: Wished) -> list[Phrase]:
    """Return whether a wish can be met, then wish and outcome of each objective, in human-readable form."""
    return [Phrase(*pair) for pair in zip(wished.sentences("metric"), wished.sentences("inch"), strict=True)]


def _wish_blocks(wished: Wished, row: Mapping[str, Any]) -> list[Block]:
    """Return the answer in words, followed by the design as a table."""
    head, *outcomes = outcome_sentences(wished)
    begin = f"{head.metric[0].upper()}{head.metric[1:]}:"
    objectives = {outcome.quantity.title for outcome in wished.outcomes}
    rows: list[tuple[Text, ...]] = []
    for key, value in row.items():
        undefined = isinstance(value, float) and not math.isfinite(value)
        if not undefined and not key.startswith("slack_") and key not in ("residual", "status"):
            cell = value_from_record(row, key) if isinstance(value, float) else str(value)
            rows.append((*title_and_unit(key, row), cell))
    bold = tuple(place for place, (title, *_) in enumerate(rows) if title in objectives)
    columns = (column("quantity", left=True), column("unit", left=True), column("value"))
    return [
        Sentence(begin, space_before=True),
        *(Sentence(words("  {outcome}", outcome=outcome)) for outcome in outcomes),
        Table(columns, tuple(rows), ruled=True, space_before=True, bold=bold),
        Sentence(f"{row['status']}: residual {row['residual']:.1e}"),
    ]


def _outcome_record(outcome: ObjectiveOutcome, units: System) -> dict[str, Any]:
    quantity = outcome.quantity
    unit, factor = metric_unit_in(quantity.unit.symbol, units)
    numbers = {name: getattr(outcome, name) for name in ("wished", "reached", "before", "short", "changed")}
    converted = {
        name: None if value is None else value * quantity.unit.factor * factor for name, value in numbers.items()
    }
    return {
        "quantity": quantity.name,
        "title": quantity.title,
        "unit": unit,
        "wish": outcome.kind,
        "met": outcome.is_met,
        **converted,
    }
