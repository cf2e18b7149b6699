"""Formatting of values and blocks in a unit system: the only place where numbers in answers become text."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ...objectives.kinds import System, unit_text
from .blocks import Block, Phrase, Sentence, Table, Text, Unit, Value
from .numerals import format_number

_LEAST_DIGITS = 4  # minimum significant digits in the inch system: 0.7 mm is 0.02756 in


@dataclass(frozen=True)
class PlainBlock:
    """Sentence, or a table if there are rows, as text in one unit system.

    heading: whether the sentence is a heading. heads: column headings, empty for columns that have none. right: whether
    each column is right-aligned, as numbers are. rows: cell texts.
    """

    sentence: str = ""
    heading: bool = False
    heads: tuple[str, ...] = ()
    right: tuple[bool, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()


def format_value(value: Value, system: System = "metric", *, bare: bool = False, printed: bool = False) -> str:
    """Return a value with its unit in a unit system.

    bare: without the unit. printed: in the number style of figures.
    """
    if value.number is None or math.isnan(value.number):
        return value.missing
    display_unit = value.kind.display_unit(system)
    digits, decimals = digits_of(value, system)
    number, unit = display_unit.factor * value.number, "" if bare or value.bare else unit_text(display_unit.symbol)
    if printed and decimals is None:
        text = format_number(number, digits)
    else:
        text = format(number, f".{digits}g" if decimals is None else f".{decimals}f")
        text = text.removeprefix("-") if float(text) == 0.0 else text
        text = text.replace("-", "−") if printed else text
    return f"{'+' if value.sign and number > 0.0 else ''}{text} {unit}".rstrip()


def digits_of(value: Value, system: System) -> tuple[int, int | None]:
    """Return the significant digits of a value in a unit system, and the number of decimals if that applies instead."""
    if value.kind.display_unit(system) is value.kind.metric:
        return value.digits, value.decimals
    return max(value.digits, _LEAST_DIGITS), None


def format_text(text: Text, system: System = "metric", *, bare: bool = False, printed: bool = False) -> str:
    """Return a text with its values in a unit system. bare: whether a value that is the whole text omits its unit."""
    if isinstance(text, str):
        return text
    if isinstance(text, Value):
        return format_value(text, system, bare=bare, printed=printed)
    if isinstance(text, Phrase):
        return text.metric if system == "metric" else text.inch
    if isinstance(text, Unit):
        return unit_text(text.kind.display_unit(system).symbol)
    return "".join(format_text(part, system, printed=printed) for part in text)


def table_headings(table: Table, system: System = "metric", *, separator: str = ", ") -> tuple[str, ...]:
    """Return the column headings of a table, each followed by a separator and the unit of the column."""
    titles = []
    for column in table.columns:
        unit = "" if column.kind is None else unit_text(column.kind.display_unit(system).symbol)
        titles.append(separator.join(part for part in (format_text(column.title, system), unit) if part))
    return tuple(titles)


def table_cells(table: Table, system: System = "metric", *, printed: bool = False) -> tuple[tuple[str, ...], ...]:
    """Return the cells of a table; see `format_value`."""
    return tuple(tuple(format_text(cell, system, bare=True, printed=printed) for cell in row) for row in table.rows)


def plain_blocks(blocks: Sequence[Block], system: System = "metric") -> list[PlainBlock]:
    """Return blocks as text in a unit system."""
    return [
        PlainBlock(format_text(block.text, system), heading=block.style == "heading")
        if isinstance(block, Sentence)
        else PlainBlock(
            heads=tuple(" ".join(head.split()) for head in table_headings(block, system)),
            right=tuple(column.right_aligned for column in block.columns),
            rows=tuple(tuple(cell.strip() for cell in row) for row in table_cells(block, system)),
        )
        for block in blocks
    ]
