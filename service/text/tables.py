"""Tables as readable text: a front, one design, the numbers of an analysis."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import count_with_noun, metric_key
from ..designs.columns import Column, choice_column_keys, find_column
from ..designs.display_units import row_without_noise
from ..designs.judged_requirements import front_violations_in_words, violations_in_words
from ..render.terminal import empty_table, print_table
from ..runs.result import Cell, Result, Row, StoredObjective

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from ...objectives.quantity import Quantity
    from ..designs.judged_requirements import JudgedRule, Judgement

ROWS = 15
"""Default number of designs shown for a front."""
_DIGITS = 4
_CHOICES = 6  # named


def show_result(screen: Console, result: Result) -> None:
    """Write the result of a run: the front as a table, and the trade-offs at the knee."""
    screen.print(f"{result.name}: {result.message}, in {result.seconds:.1f} s", style="bold", soft_wrap=True)
    if len(result.designs) == 1:
        show_design(screen, result.designs[0])
    elif result.designs:
        show_front(screen, result, range(len(result.designs)))
    if result.trade_offs:
        screen.print("\nAt the knee:")
        for sentence in result.trade_offs:
            screen.print(f"  {sentence}", soft_wrap=True)
    violations = [f"Beyond the allowable value: {sentence}" for sentence in front_violations_in_words(result)]
    for sentence in (*violations, *(f"Warning: {sentence}" for sentence in result.warnings)):
        screen.print(f"\n{sentence}.", style="yellow", soft_wrap=True)


def show_front(
    screen: Console,
    result: Result,
    rows: Sequence[int],
    *,
    columns: Sequence[Column] | None = None,
    limit: int = ROWS,
) -> None:
    """Write designs of a front, given by position, as a table; at most `limit` of them, evenly spread.

    columns: dimensions, stroke and objectives if None; values shared by all designs then appear once above the table.
    """
    chosen = marked_and_evenly_spread_rows(result, rows, limit)
    if columns is None:
        columns, constant = _varying_usual_columns(result)
        if constant:
            screen.print(f"In every design: {', '.join(constant)}.", soft_wrap=True)
    screen.print()
    print_table(screen, _front_table(result, chosen, columns))
    notes = []
    if len(chosen) < len(rows):
        notes.append(f"{len(chosen)} of {count_with_noun(len(rows), 'design')} shown")
    if any(result.extremes[objective.quantity] in chosen for objective in result.objectives):
        notes.append("* best in an objective")
    if result.knee in chosen and len(result.objectives) > 1:
        notes.append("knee: nearest to the ideal")
    if notes:
        screen.print(f" {';  '.join(notes)}", style="dim")


def show_design(
    screen: Console, row: Row, *, only: Sequence[str] | None = None, custom: Sequence[Quantity] = ()
) -> None:
    """Write all defined quantities of one design, one per line.

    custom: custom quantities of its job, whose titles and units are more informative than their column keys.
    """
    row, custom_by_column = row_without_noise(row), {quantity.field: quantity for quantity in custom}
    rows = empty_table("", ">", "")
    for key in only or row:
        value = row[key]
        if value is None or (isinstance(value, float) and math.isnan(value)):
            continue
        column, quantity = find_column(key, row), custom_by_column.get(key)
        text = value if isinstance(value, str) else f"{value:.6g}"
        rows.add_row(
            quantity.title if quantity else column.title, text, quantity.unit.symbol if quantity else column.unit
        )
    print_table(screen, rows)


def show_undefined(screen: Console, reasons: Mapping[str, str], custom: Sequence[Quantity] = ()) -> None:
    """Write why quantities of a design have no value, grouped by rule. reasons: reasons by column."""
    custom_titles = {quantity.field: quantity.title for quantity in custom}
    together: dict[str, list[str]] = {}
    for key, reason in reasons.items():
        together.setdefault(reason.partition(";")[0], []).append(
            custom_titles.get(key) or find_column(key, reasons).title
        )
    if together:
        screen.print("\nNot defined here:", style="dim")
    for rule, titles in together.items():
        screen.print(f"  {', '.join(titles)}: {rule}", style="dim", soft_wrap=True, markup=False)


def finite_or_none(value: Any) -> float | None:
    """Return a number that JSON allows: None if it is not finite."""
    number = float(value)
    return number if math.isfinite(number) else None


def usual_keys(result: Result) -> list[str]:
    """Return the columns of dimensions, extra variables, stroke and objectives."""
    from ...objectives.lengths_and_time_ratio import STROKE

    names = list(result.designs[0])
    dimensions = [find_column(name, names).key for name in DIMENSIONS]
    keys = [*dimensions, *choice_column_keys(names), *(key for key in names if metric_key(key) == STROKE.field)]
    keys += ["slow_stroke"] if result.strokes_differ else []
    return keys + [objective.column for objective in result.objectives if objective.column not in keys]


def _varying_usual_columns(result: Result) -> tuple[list[Column], list[str]]:
    """Return the columns of `usual_keys` that differ between designs, and the others in words."""
    from ...optimise.front.saved_front import is_constant

    objectives = {objective.column for objective in result.objectives}
    wishes = {objective.column: objective for objective in result.objectives}
    columns, constant = [], []
    for key in usual_keys(result):
        column = find_column(key, result.designs[0])
        wish = wishes.get(key)
        if wish is not None and (wish.unit != column.unit or not wish.quantity.isidentifier()):
            # A formula is more informative than its column's key.
            column = replace(column, title=wish.title, unit=wish.unit)
        values = [row[key] for row in result.designs]
        numbers = [value for value in values if isinstance(value, float)]
        if len(numbers) > 1 and is_constant(numbers) and key not in objectives:
            constant.append(f"{column.title} {numbers[0]:.6g} {column.unit}".rstrip())
        elif not numbers and len(values) > 1 and len(set(values)) == 1:
            constant.append(f"{column.title} {values[0]}")
        else:
            columns.append(column)
    return columns, constant


def _front_table(result: Result, rows: Sequence[int], columns: Sequence[Column]) -> Table:
    from rich.text import Text

    rich_table = empty_table(ruled=True, padding=0, pad_edge=True, show_header=True)
    rich_table.add_column("no.", justify="right", vertical="bottom")
    for column in columns:
        narrow = textwrap.wrap(column.title.removesuffix(", worst case"), 8, break_long_words=False)
        title = "\n".join(f"{line} " for line in (*narrow, column.unit))
        rich_table.add_column(title, justify="right", vertical="bottom", no_wrap=True)
    rich_table.add_column("", no_wrap=True)
    best = {(row, objective.column) for objective in result.objectives for row in _best_rows(result, objective)}
    designs = [row_without_noise(result.designs[row]) for row in rows]
    texts = [_format_with_same_decimals([design[column.key] for design in designs]) for column in columns]
    for row, line in zip(rows, zip(*texts, strict=True), strict=True):
        knee = row == result.knee and len(result.objectives) > 1
        tops = [(row, column.key) in best for column in columns]
        cells = [
            Text(text + ("*" if top else " "), style="bold" if top else "")
            for text, top in zip(line, tops, strict=True)
        ]
        rich_table.add_row(str(row + 1), *cells, "knee" if knee else "", style="bold" if knee else "")
    return rich_table


def _best_rows(result: Result, objective: StoredObjective) -> list[int]:
    """Return the positions of the designs that are best in an objective, within rounding; none if all are equal."""
    from ...optimise.front.saved_front import SAME

    ranks = [objective.minimised_value(row) for row in result.designs]
    least = min(ranks)
    best = [row for row, rank in enumerate(ranks) if math.isfinite(rank) and rank - least <= SAME * abs(least)]
    return best if len(best) < max(len(ranks), 2) else []


def _format_with_same_decimals(values: Sequence[Cell]) -> list[str]:
    """Return numbers with the same decimals: four significant digits for the largest."""
    sizes = [abs(value) for value in values if isinstance(value, float) and math.isfinite(value)]
    top = max(sizes, default=0.0)
    decimals = max(0, min(9, _DIGITS - 1 - math.floor(math.log10(top)))) if top > 0.0 else 0
    form = f".{decimals}f" if top == 0.0 or top >= 1e-3 else ".1e"

    def text(value: Cell) -> str:
        if isinstance(value, str):
            return value
        return "-" if value is None or math.isnan(value) else format(value, form)

    return [text(value) for value in values]


def marked_and_evenly_spread_rows(result: Result, rows: Sequence[int], limit: int) -> list[int]:
    """Return up to `limit` positions, in order: the marked ones, and others evenly spread; all for 0."""
    if limit <= 0 or len(rows) <= limit:
        return list(rows)
    marked = {*result.extremes.values(), result.knee} & set(rows)
    rest = [row for row in rows if row not in marked]
    free = max(0, limit - len(marked))
    steps = [round(index * (len(rest) - 1) / max(1, free - 1)) for index in range(free)]
    chosen = marked | {rest[step] for step in steps}
    return [row for row in rows if row in chosen]


def show_violated(screen: Console, violated: Mapping[str, float], row: Row) -> None:
    """Print the allowable values that a design violates, and the excess."""
    if violated:
        screen.print()
    for sentence in violations_in_words(violated, row):
        screen.print(f"Beyond the allowable value: {sentence}.", style="bold yellow", soft_wrap=True)


def show_rules(screen: Console, judgement: Judgement) -> None:
    """Print whether a design meets each requirement of its job, and with which choices; missed ones come first."""
    rules, choices = judgement.rules, judgement.choices
    if not rules:
        return
    broken = [rule for rule in rules if not rule.met]
    fitting = [" and ".join(choice.labels) for choice in choices if not choice.missed]
    screen.print()
    if not broken and choices and not fitting:
        nearest = min(choices, key=lambda choice: len(choice.missed))
        screen.print(f"No choice in the job meets the requirements; with {' and '.join(nearest.labels)}:", style="bold")
        broken = list(nearest.missed)
    elif not broken:
        judged = ""
        if choices:
            more = len(fitting) - _CHOICES
            listed = ", ".join(fitting[:_CHOICES]) + (f" and {more} more" if more > 0 else "")
            judged = f" with {len(fitting)} of {len(choices)} choices: {listed}"
        screen.print(f"It meets every range and requirement of the job{judged}.", soft_wrap=True)
    for rule in broken:
        value = (
            "has no value"
            if rule.value is None
            else f"is {_format_value(rule.value, rule, rule.distinguishing_digits)}"
        )
        miss = "" if rule.missed_by is None else f", by {_format_value(rule.missed_by, rule)}"
        screen.print(f"Not met: {rule.title} {_format_bounds(rule)} {value}{miss}.", style="bold", soft_wrap=True)
    for rule in (rule for rule in rules if rule.met):
        value = "" if rule.value is None else _format_value(rule.value, rule)
        screen.print(f"  met: {rule.title} {_format_bounds(rule)}: {value}", soft_wrap=True, style="dim")


def _format_bounds(rule: JudgedRule) -> str:
    if rule.lower is not None and rule.lower == rule.upper:
        return f"(exactly {_format_value(rule.lower, rule)})"
    ends = [("at least", rule.lower), ("at most", rule.upper)]
    return f"({', '.join(f'{word} {_format_value(end, rule)}' for word, end in ends if end is not None)})"


def _format_value(value: float, rule: JudgedRule, digits: int = 6) -> str:
    return f"{value:.{digits}g} {rule.unit}".rstrip()
