"""Tables and lines of numbers that the text of a topic is made of."""

from __future__ import annotations

from rich import box
from rich.table import Table


def table(*columns: str, ruled: bool = False) -> Table:
    """Return an empty table. columns: heads, aligned to the right where they begin with ">". ruled: the heads."""
    look = {"box": box.SIMPLE_HEAD, "padding": (0, 1), "show_edge": False} if ruled else {"padding": (0, 2, 0, 0)}
    found = Table(**({"box": None, "pad_edge": False, "show_header": any(c.strip(">") for c in columns)} | look))
    for column in columns:
        right = column.startswith(">")
        found.add_column(column.removeprefix(">"), justify="right" if right else "left", no_wrap=right)
    return found
