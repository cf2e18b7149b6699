"""Numbers of an analysis, one a line: what it is, value, unit, remark."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .tables import table

if TYPE_CHECKING:
    from rich.console import Console

Line = tuple[str, float | str | None, str, str]
"""Name, value (None where undefined), unit, remark."""


def show_lines(console: Console, title: str, lines: Sequence[Line]) -> None:
    """Write a heading and one line for each number."""
    console.print(title, style="bold")
    rows = table("", ">", "", "")
    rows.columns[2].no_wrap, rows.columns[3].style = True, "dim"
    for name, value, unit, remark in lines:
        text = "undefined" if value is None else value if isinstance(value, str) else f"{value:.6g}"
        rows.add_row(f"  {name}", text, "" if value is None else unit, remark)
    console.print(rows)


def plain(value: Any) -> float | None:
    """Return a number that JSON can have: None for what is not finite."""
    number = float(value)
    return number if math.isfinite(number) else None
