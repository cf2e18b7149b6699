"""Blocks on a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ...objectives.kinds import System
from .blocks import Block, Sentence, Table
from .formatting import format_text, table_cells, table_headings

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as Drawn

_STYLES = {"heading": "bold", "plain": None, "note": "dim"}


def print_blocks(screen: Console, blocks: Sequence[Block], system: System = "metric") -> None:
    """Write blocks in a unit system; a blank line follows a table with its notes."""
    for before, block in zip((None, *blocks), blocks, strict=False):
        if block.space_before or ((isinstance(before, Table) or _is_note(before)) and not _is_note(block)):
            screen.print()
        if isinstance(block, Sentence):
            screen.print(format_text(block.text, system), style=_STYLES[block.style], soft_wrap=True, markup=False)
        else:
            _print_table(screen, block, system)


def _is_note(block: Block | None) -> bool:
    return isinstance(block, Sentence) and block.style == "note"


def _print_table(screen: Console, block: Table, system: System) -> None:
    titles = table_headings(block, system, separator=",\n" if block.ruled else ", ")
    rows = empty_table(
        *(f"{'>' if column.right_aligned else ''}{title}" for column, title in zip(block.columns, titles, strict=True)),
        ruled=block.ruled,
        **({"padding": (0, 2, 0, 0), "pad_edge": True} if block.space_before else {}),
    )
    for place in block.dim:
        rows.columns[place].style = "dim"
    for place, (first, *rest) in enumerate(table_cells(block, system)):
        rows.add_row(f"  {first}" if block.indented else first, *rest, style="bold" if place in block.bold else "")
    print_table(screen, rows)


def empty_table(*columns: str, ruled: bool = False, **look: Any) -> Drawn:
    """Return an empty table.

    columns: headings; a leading ">" right-aligns the column. ruled: whether headings have a rule.

    look: further options of `rich.table.Table`.
    """
    from rich import box
    from rich.table import Table as Drawn

    usual: dict[str, Any] = {"pad_edge": False, "show_header": any(column.strip(">") for column in columns)}
    usual |= {"box": box.SIMPLE_HEAD, "padding": (0, 1), "show_edge": False} if ruled else {"box": None}
    rich_table = Drawn(**({"padding": (0, 2, 0, 0)} | usual | look))
    for column in columns:
        right = column.startswith(">")
        rich_table.add_column(column.removeprefix(">"), justify="right" if right else "left", no_wrap=right)
    return rich_table


def print_table(screen: Console, table: Drawn) -> None:
    """Write a table at its full width: a narrow terminal wraps its lines, but no number is cut."""
    natural = screen.measure(table, options=screen.options.update(width=1000)).maximum
    before = screen.width
    try:
        screen.width = max(before, natural)
        screen.print(table)
    finally:
        screen.width = before
