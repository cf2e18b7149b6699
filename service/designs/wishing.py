"""Answers to wishes as JSON has them, in a system of units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ...objectives.kinds import System, shown_in
from ..runs.result import json_ready, rows_of
from .shown_units import row_in

if TYPE_CHECKING:
    from ...optimise.decisions.wished import Outcome, Wished
    from ...optimise.decisions.wishes import Wish
    from ...optimise.front.front import ParetoFront


def wished_record(answer: Wished, units: System = "metric") -> dict[str, Any]:
    """Return the answer to a wish as JSON has it.

    possible: whether everything wished is reached. sentences: the answer in words. achievement: value of the
    achievement function. objectives: of each, wish and outcome, in its unit. design: the row of a front's table, null
    where no design stays within what is allowed.
    """
    rows = rows_of(answer.found.columns) if len(answer) else []
    return {
        "number": None if answer.row is None else answer.row + 1,
        "possible": answer.possible,
        "sentences": answer.sentences(units),
        "achievement": json_ready(answer.value),
        "objectives": [_outcome(outcome, units) for outcome in answer.outcomes],
        "design": json_ready(row_in(rows[0], units)) if rows else None,
    }


def told_wishes(front: ParetoFront, wishes: Sequence[Wish]) -> dict[str, tuple[str, float | None]]:
    """Return wishes by their objectives, free ones left out, with values in the metric units of these."""
    told: dict[str, tuple[str, float | None]] = {}
    for objective, wish in zip(front.objectives, wishes, strict=True):
        factor = front.problem.quantity(objective.quantity).unit.factor
        if wish.kind != "free":
            told[objective.quantity] = (wish.kind, None if wish.value is None else wish.value * factor)
    return told


def words_of(front: ParetoFront, told: Mapping[str, tuple[str, float | None]]) -> dict[str, str]:
    """Return wishes of `told_wishes` as they are asked for: "110 N m", "improve", "may worsen to 40 deg"."""
    words = {}
    for name, (kind, value) in told.items():
        unit = front.problem.quantity(name).unit.symbol
        number = "" if value is None else f"{value!r} {unit}".rstrip()
        words[name] = {"value": number, "limit": f"may worsen to {number}"}.get(kind, kind)
    return words


def _outcome(outcome: Outcome, units: System) -> dict[str, Any]:
    of = outcome.quantity
    unit, factor = shown_in(of.unit.symbol, units)
    numbers = {name: getattr(outcome, name) for name in ("wished", "reached", "before", "short", "changed")}
    told = {name: None if value is None else value * of.unit.factor * factor for name, value in numbers.items()}
    return {"quantity": of.name, "title": of.title, "unit": unit, "wish": outcome.kind, "met": outcome.met, **told}
