"""The text of a topic as data, so that a page tells the same as the command line."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:
    from .topic import TopicOfDesign

_WIDE = 10_000  # no line is broken


@dataclass(frozen=True)
class Block:
    """A sentence, or a table where there are rows.

    heading: whether the sentence heads what follows. heads: of the columns, empty ones where they have none. right:
    whether a column is aligned to the right, as numbers are. rows: the texts of the cells.
    """

    sentence: str = ""
    heading: bool = False
    heads: tuple[str, ...] = ()
    right: tuple[bool, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()


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


def told(topic: TopicOfDesign, numbers: dict[str, Any]) -> Sequence[Block]:
    """Return the text of a topic on its numbers, as sentences and tables."""
    screen = _Collecting()
    topic.show(screen, numbers)
    return screen.blocks


def _table_block(table: Table) -> Block:
    columns = [[_plain(cell) for cell in column.cells] for column in table.columns]
    return Block(
        heads=tuple(" ".join(_plain(column.header).split()) if table.show_header else "" for column in table.columns),
        right=tuple(column.justify == "right" for column in table.columns),
        rows=tuple(zip(*columns, strict=True)),
    )


def _plain(cell: Any) -> str:
    return cell.plain.strip() if isinstance(cell, Text) else str(cell).strip()
