"""Numbers of an analysis, one a line: what it is, value, unit, remark."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

Line = tuple[str, float | str | None, str, str]
"""Name, value (None where undefined), unit, remark."""


def show_lines(console: Console, title: str, lines: Sequence[Line]) -> None:
    """Write a heading and one line for each number."""
    from rich.table import Column, Table

    console.print(title, style="bold")
    columns = ("name", Column(justify="right", no_wrap=True), Column(no_wrap=True), Column(style="dim"))
    table = Table(*columns, box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    for name, value, unit, remark in lines:
        text = "undefined" if value is None else value if isinstance(value, str) else f"{value:.6g}"
        table.add_row(f"  {name}", text, "" if value is None else unit, remark)
    console.print(table)


def plain(value: Any) -> float | None:
    """Return a number that JSON can have: None for what is not finite."""
    number = float(value)
    return number if math.isfinite(number) else None
