"""The published cases as tables for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..text.tables import print_table
from .published import Case, Row

if TYPE_CHECKING:
    from rich.console import Console


def show_case(screen: Console, case: Case, *, full: bool) -> None:
    """Write one case: its numbers with their verdicts, and below them the reasons.

    full: every cell of a long printed table; else one line for each of its columns.
    """
    from rich import box
    from rich.table import Table

    screen.print(f"Case {case.number}: {case.title}", style="bold", soft_wrap=True)
    screen.print(f"{case.source}.", style="dim", soft_wrap=True)
    screen.print(f"Given: {case.given}.", style="dim", soft_wrap=True)
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1), show_edge=False, pad_edge=False)
    table.add_column("quantity")
    for name in ("printed", "exact"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    reasons: list[str] = []
    folded = 0
    for rows in _groups(case.rows, full):
        first = rows[0]
        note = ""
        if first.why:
            if first.why not in reasons:
                reasons.append(first.why)
            note = f" [{reasons.index(first.why) + 1}]"
        if len(rows) > 1:
            folded += len(rows)
            table.add_row(
                first.what.partition(" at ")[0], f"{len(rows)} rows", "", first.unit, f"{_counted(rows)}{note}"
            )
            continue
        printed = "-" if first.printed is None else first.printed
        exact = "-" if first.exact is None else _like(first)
        table.add_row(first.what, printed, exact, first.unit, f"{first.verdict}{note}")
    print_table(screen, table)
    for index, reason in enumerate(reasons, start=1):
        screen.print(f"[{index}] {reason}.", soft_wrap=True)
    if folded:
        screen.print(f"All {folded} numbers of the printed table: slidercrank cases --case {case.number}", style="dim")
    screen.print()


def _groups(rows: Sequence[Row], full: bool) -> list[list[Row]]:
    """Return the rows, those of one column of a printed table together unless `full`."""
    groups: list[list[Row]] = []
    for row in rows:
        if (
            not full
            and ", row " in row.where
            and groups
            and groups[-1][0].key.rpartition("_")[0] == (row.key.rpartition("_")[0])
        ):
            groups[-1].append(row)
        else:
            groups.append([row])
    return groups


def counted(rows: Sequence[Row]) -> str:
    """Return how many rows have which verdict, in words."""
    counts = Counter(row.verdict for row in rows)
    return ", ".join(f"{count} {_PLURAL.get(verdict, verdict)}" for verdict, count in counts.most_common())


_PLURAL = {"agrees": "agree", "misprint": "misprints", "differs": "differ"}


def _counted(rows: Sequence[Row]) -> str:
    verdicts = {row.verdict for row in rows}
    return f"all {len(rows)}: {verdicts.pop()}" if len(verdicts) == 1 else counted(rows)


def _like(row: Row) -> str:
    """Return the exact value with three digits more than are printed, nine if none are."""
    assert row.exact is not None
    digits = sum(character.isdigit() for character in (row.printed or "").partition("e")[0].lstrip("-+0."))
    return f"{row.exact:.{min(10, max(6, digits + 3)) if row.printed else 9}g}"
