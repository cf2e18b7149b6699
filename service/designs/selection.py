"""Selection of designs: conditions such as "transmission_angle >= 40 deg", sorting, part of a front."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError
from ...objectives.kinds import Kind, count_with_noun
from ...objectives.units import is_number_with_any_unit, quote, to_si
from ..runs.result import Cell, Result, Row
from .columns import Column, find_column

if TYPE_CHECKING:
    from .row_formulas import RowFormula

_TOLERANCE = 1e-8
"""Relative tolerance of constraints, so that a design exactly at a bound counts as meeting it."""

_FORM = re.compile(r"\s*([^<>=!≥≤]*[^<>=!≥≤\s])\s*(>=|<=|==|=|!=|>|<|≥|≤)\s*(\S.*?)\s*", re.ASCII | re.DOTALL)
_SIGN = re.compile(r"[-+*/^(.\s]")
_OPERATORS: dict[str, Callable[[Any, Any], bool]] = {
    ">=": operator.ge,
    "<=": operator.le,
    ">": operator.gt,
    "<": operator.lt,
    "==": operator.eq,
    "!=": operator.ne,
}
_TURNED = {">=": "<=", "<=": ">=", ">": "<", "<": ">", "==": "==", "!=": "!="}
_SAME = {"=": "==", "≥": ">=", "≤": "<="}
_EXAMPLE = '"transmission_angle >= 40 deg"'


@dataclass(frozen=True)
class Condition:
    """Comparison of a column or a formula with a value in its unit, or of a column with a word.

    column: column of the table, or a new column for the values of the formula, SI.
    """

    column: Column
    comparison: str
    value: float | str
    formula: RowFormula | None = None

    def compared_value(self, row: Row) -> Cell:
        """Return the cell or value of a design that the condition compares."""
        return row[self.column.key] if self.formula is None else self.formula.evaluate(row)

    def holds(self, row: Row) -> bool:
        """Return whether a design meets the condition; a design without a value does not.

        Equality holds to 1e-8 relative.
        """
        cell = self.compared_value(row)
        if isinstance(self.value, str) or isinstance(cell, str) or cell is None:
            return _OPERATORS[self.comparison](cell, self.value)
        if math.isnan(cell):
            return False
        same = cell == self.value or abs(cell - self.value) <= _TOLERANCE * abs(self.value)
        return self.comparison in (">=", "<=", "==") if same else _OPERATORS[self.comparison](cell, self.value)


def parse_condition(text: str, keys: Collection[str], example: Row) -> Condition:
    """Return the condition in a text: quantity, column or formula, then comparison, then value with unit.

    keys: keys of the table. example: one of its rows, which distinguishes text columns from numeric ones. Raises
    `InputError` for any other form.
    """
    match = _FORM.fullmatch(text)
    if match is None:
        raise InputError(
            "a condition must have a quantity or a formula, then one of >= <= > < = !=, then a value with its unit; "
            f"got {text!r}; write it like {_EXAMPLE}"
        )
    name, comparison, value = match.groups()
    comparison = _SAME.get(comparison, comparison)
    _require_name_first(text, name, comparison, value)
    column, formula = _column_and_formula(name, keys)
    if formula is not None:
        return Condition(column, comparison, _number_in_unit(match, column), formula)
    if isinstance(example[column.key], str):
        if comparison not in ("==", "!="):
            raise InputError(
                f"{column.key} is a column of words and may only be compared with = or !=; got {comparison}"
            )
        return Condition(column, comparison, value.strip("\"'"))
    return Condition(column, comparison, _number_in_unit(match, column))


def _require_name_first(text: str, name: str, comparison: str, value: str) -> None:
    """Raise an error for a condition that begins with its value, or has two comparisons."""

    if re.search("[<>=]", value):
        if value[0] in "<>=":
            raise InputError(f"a condition must have one of >= <= > < = !=; got {text!r}; write it like {_EXAMPLE}")
        raise InputError(f"a condition may only have one comparison; got {text!r}; give two conditions")
    if is_number_with_any_unit(name):
        turned = f"{value} {_TURNED[comparison]} {name.strip()}"
        raise InputError(f'a condition must begin with its quantity or formula; got {text!r}; write it like "{turned}"')


def _column_and_formula(name: str, keys: Collection[str]) -> tuple[Column, RowFormula | None]:
    """Return the column for a name, or a new column and the formula."""
    if not _SIGN.search(name.strip()):
        return find_column(name, keys), None

    from .row_formulas import find_formula  # slow import of the computing modules

    formula = find_formula(name, keys)
    if isinstance(formula, Column):
        return formula, None
    plain = None if formula.kind.unit else 1.0
    return Column(formula.text, formula.text, formula.kind.unit, 1.0, plain), formula


def plain_number(text: str) -> float | None:
    """Return the number in a text, or None if it is not a number or has a unit."""
    try:
        return float(text)
    except ValueError:
        return None


def parse_value(key: str, value: object, kind: Kind, *, sign: Any = "any") -> float:
    """Return the SI value of a text with a unit, or of a number in SI.

    Raises `InputError`, whose message begins with the key.
    """

    text = isinstance(value, str)
    if text and kind.unit and plain_number(str(value)) is not None:
        raise InputError(f'{key} must be {kind.name} with its unit; got {quote(value)}; write it like "{kind.example}"')
    try:
        return to_si(value, kind, sign=sign, plain=not text)
    except InputError as error:
        raise InputError(f"{key} {error}") from None


def _number_in_unit(match: re.Match[str], column: Column) -> float:
    """Return the value in the column's unit; the unit may be omitted only if the column's name has it."""
    from ...objectives.catalogue_amount import kind_of_amount
    from ...objectives.formula.formulas import is_formula

    name, comparison, value = match.groups()
    if is_formula(value):
        difference = f"{name.strip()} - ({value}) {comparison} 0 {column.unit}".rstrip()
        raise InputError(
            f'a condition must end with a number; got {match[0]!r}; compare the difference, like "{difference}"'
        )
    number = plain_number(value)
    if column.plain is not None and number is not None and math.isfinite(number):
        return number * column.plain
    try:
        return to_si(value, kind_of_amount(column.unit), plain=False) * column.factor
    except InputError as error:
        raise InputError(f"the value in {match[0].strip()!r} {error}") from None


def select_rows(rows: list[Row], conditions: Collection[str]) -> list[int]:
    """Return the positions of the designs that meet all conditions. Raises `InputError` for an invalid condition."""
    if not rows:
        return []
    parsed = [parse_condition(text, list(rows[0]), rows[0]) for text in conditions]
    chosen = list(range(len(rows)))
    for condition in parsed:
        chosen = [n for n in chosen if condition.holds(rows[n])]
    return chosen


def sort_key(cell: Cell) -> tuple[bool, float, str]:
    """Return a key that sorts numbers by size, words alphabetically, and undefined values last."""
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return True, 0.0, ""
    return (False, 0.0, cell) if isinstance(cell, str) else (False, float(cell), "")


def rows_meeting_conditions(
    result: Result, conditions: Collection[str], *, sort: str | None = None, reverse: bool = False
) -> list[int]:
    """Return the positions of the designs that meet all conditions.

    sort: quantity, column or formula: best first for an objective, otherwise smallest first; None for the order of the
    front. reverse: whether to reverse the order. Raises `InputError` for an invalid condition or an unknown column.
    """
    chosen = select_rows(result.designs, conditions)
    if sort is not None and result.designs:
        column, formula = _column_and_formula(sort, list(result.designs[0]))
        key = column.key
        objective = next((item for item in result.objectives if item.column == key), None)
        if formula is not None:
            chosen.sort(key=lambda row: sort_key(formula.evaluate(result.designs[row])))
        elif objective is not None:
            chosen.sort(key=lambda row: objective.minimised_value(result.designs[row]))
        else:
            chosen.sort(key=lambda row: sort_key(result.designs[row][key]))
    return chosen[::-1] if reverse else chosen


def numbered_rows(rows: Sequence[Row], chosen: Sequence[int] | None = None) -> list[Row]:
    """Return all rows, or the selected ones, each preceded by the number of its design, counted from 1."""
    return [{"number": row + 1, **rows[row]} for row in (range(len(rows)) if chosen is None else chosen)]


def result_with_rows(result: Result, rows: Sequence[int]) -> Result:
    """Return the result with only these designs and the marks among them."""
    place = {row: index for index, row in enumerate(rows)}
    knee = place.get(result.knee) if result.knee is not None else None
    return replace(
        result,
        designs=[result.designs[row] for row in rows],
        exact=None if result.exact is None else result.exact.select(rows),
        extremes={name: place[row] for name, row in result.extremes.items() if row in place},
        knee=knee,
        trade_offs=[] if knee is None else result.trade_offs,
        violated={key: part for key, excess in result.violated.items() if any(part := [excess[row] for row in rows])},
    )


def no_match_message(result: Result, texts: Collection[str]) -> str:
    """Return the message for a front without a design that meets the conditions."""
    rows = result.designs
    conditions = " and ".join(text.strip() for text in texts)
    parsed = (parse_condition(text, list(rows[0]), rows[0]) for text in texts if rows)
    reasons = dict.fromkeys(reason for condition in parsed if (reason := _why_no_value_helps(condition, rows)))
    return "; ".join((f"none of the {count_with_noun(len(rows), 'design')} meets {conditions}", *reasons))


def _why_no_value_helps(condition: Condition, rows: Sequence[Row]) -> str | None:
    """Return why a condition cannot hold for any design, whatever its value; None if another value may help."""
    name, cells = condition.column.key, [condition.compared_value(row) for row in rows]
    if all(sort_key(cell)[0] for cell in cells):
        return f"{name} has no value for any of them"
    words = {cell for cell in cells if isinstance(cell, str)}
    if words and condition.value not in words:
        return f"{name} is {' or '.join(sorted(words))} there"
    return None
