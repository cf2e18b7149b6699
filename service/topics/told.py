"""The text of a topic as data, so that a page tells the same as the command line."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .block import Block

if TYPE_CHECKING:
    from ...objectives.kinds import System
    from .topic import TopicOfDesign

_WIDE = 10_000  # no line is broken


class _Collecting(Console):
    """A console that keeps what is written to it."""

    def __init__(self) -> None:
        super().__init__(file=io.StringIO(), width=_WIDE, highlight=False, markup=False, emoji=False)
        self.blocks: list[Block] = []

    def print(self, *objects: Any, style: Any = None, **options: Any) -> None:
        """Keep sentences and tables; empty lines are for screens."""
        for item in objects:
            if isinstance(item, Table):
                self.blocks.append(_table_block(item))
            elif str(item).strip():
                self.blocks.append(Block(" ".join(str(item).split()), heading=style == "bold"))


def told(topic: TopicOfDesign, numbers: dict[str, Any], units: System = "metric") -> Sequence[Block]:
    """Return the text of a topic on its numbers, metric as they are, as sentences and tables in units."""
    return [
        replace(block, heads=tuple(" ".join(head.split()) for head in block.heads))
        for block in _blocks(topic, numbers, units)
    ]


def show_in(screen: Console, topic: TopicOfDesign, numbers: dict[str, Any], units: System) -> None:
    """Write a topic on a screen in a system of units."""
    from ..text.tables import print_table, table

    if units == "metric" or topic.shows_any_units:
        topic.show(screen, topic.numbers_in(numbers, units))
        return
    for block in _blocks(topic, numbers, units):
        if not block.rows:
            screen.print(block.sentence, style="bold" if block.heading else None, soft_wrap=True)
            continue
        heads = [f"{'>' if right else ''}{head}" for head, right in zip(block.heads, block.right, strict=True)]
        rows = table(*heads, ruled=any(block.heads))
        for cells in block.rows:
            rows.add_row(*cells)
        print_table(screen, rows)


def _blocks(topic: TopicOfDesign, numbers: dict[str, Any], units: System) -> Sequence[Block]:
    """Return the text of `told`, the heads of tables with their line breaks."""
    screen = _Collecting()
    if units == "metric" or topic.shows_any_units:
        topic.show(screen, topic.numbers_in(numbers, units))
        return screen.blocks
    from .exact_numbers import exact
    from .inches import block_in_inches

    topic.show(screen, exact(numbers))
    return [block_in_inches(block) for block in screen.blocks]


def _table_block(table: Table) -> Block:
    columns = [[_plain(cell) for cell in column.cells] for column in table.columns]
    return Block(
        heads=tuple(_plain(column.header) if table.show_header else "" for column in table.columns),
        right=tuple(column.justify == "right" for column in table.columns),
        rows=tuple(zip(*columns, strict=True)),
    )


def _plain(cell: Any) -> str:
    return cell.plain.strip() if isinstance(cell, Text) else str(cell).strip()
