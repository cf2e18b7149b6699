"""Selection of designs of a front: those that meet conditions, in an order, and the front of only these."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from ..runs.result import Result, Row
from .columns import find_column
from .conditions import order_key, select


def chosen_rows(result: Result, where: Collection[str], *, sort: str | None = None, reverse: bool = False) -> list[int]:
    """Return the positions of the designs that meet all conditions.

    sort: a quantity or column: best first for an objective, else smallest first; None for the order of the front.
    reverse: turn the order round. Raises `InputError` for a wrong condition and for an unknown column.
    """
    chosen = select(result.designs, where)
    if sort is not None and result.designs:
        key = find_column(sort, list(result.designs[0])).key
        wanted = next((item for item in result.objectives if item.column == key), None)
        if wanted is not None:
            chosen.sort(key=lambda row: wanted.rank(result.designs[row]))
        else:
            chosen.sort(key=lambda row: order_key(result.designs[row][key]))
    return chosen[::-1] if reverse else chosen


def numbered(rows: Sequence[Row], chosen: Sequence[int] | None = None) -> list[Row]:
    """Return the rows, each with the number of its design first, counted from 1; of all, or of those chosen."""
    return [{"number": row + 1, **rows[row]} for row in (range(len(rows)) if chosen is None else chosen)]


def part_of(result: Result, rows: Sequence[int]) -> Result:
    """Return the result with only these designs, and only those marks that are among them."""
    place = {row: index for index, row in enumerate(rows)}
    knee = place.get(result.knee) if result.knee is not None else None
    return replace(
        result,
        designs=[result.designs[row] for row in rows],
        exact=None if result.exact is None else result.exact.of(rows),
        extremes={name: place[row] for name, row in result.extremes.items() if row in place},
        knee=knee,
        trade_offs=[] if knee is None else result.trade_offs,
    )


def none_meets(result: Result, where: Collection[str]) -> str:
    """Return the message for a front where no design meets the conditions."""
    conditions = " and ".join(text.strip() for text in where)
    return f"none of the {len(result.designs)} designs meets {conditions}"
