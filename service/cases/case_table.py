"""Published cases with the values of the model, and as human-readable tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from ..render.terminal import empty_table, print_table
from . import case_1, case_2, case_3, case_4, case_5
from .printed_values import CASES, Case, Row, read_case

if TYPE_CHECKING:
    from rich.console import Console

_OF = dict(zip(CASES, (case_1, case_2, case_3, case_4, case_5), strict=True))


def collect_cases(numbers: Sequence[int] = CASES) -> list[Case]:
    """Return the cases with these numbers."""
    return [read_case(number, _OF[number].computed_values()) for number in numbers]


def show_case(screen: Console, case: Case, *, full: bool) -> None:
    """Write one case: its numbers with verdicts, followed by the reasons.

    full: whether to show every cell of a long printed table instead of one line per column.
    """
    screen.print(f"Case {case.number}: {case.title}", style="bold", soft_wrap=True)
    screen.print(f"{case.source}.", style="dim", soft_wrap=True)
    screen.print(f"Given: {case.given}.", style="dim", soft_wrap=True)
    rows = empty_table("quantity", ">printed", ">exact", "unit", "verdict", ruled=True)
    reasons: list[str] = []
    folded = 0
    for _, group in groupby(case.rows, key=lambda row: row.key if full else row.key_without_row_number):
        first, *rest = cells = list(group)
        if first.why and first.why not in reasons:
            reasons.append(first.why)
        note = f" [{reasons.index(first.why) + 1}]" if first.why else ""
        if rest:
            folded += len(cells)
            name = first.what.partition(" at ")[0]
            rows.add_row(name, f"{len(cells)} rows", "", first.unit, f"{_verdicts_text(cells)}{note}")
        else:
            exact = "-" if first.exact is None else _exact_text(first)
            rows.add_row(first.what, first.printed or "-", exact, first.unit, f"{first.verdict}{note}")
    print_table(screen, rows)
    for index, reason in enumerate(reasons, start=1):
        screen.print(f"[{index}] {reason}.", soft_wrap=True)
    if folded:
        screen.print(f"All {folded} numbers of the printed table: slidercrank cases --case {case.number}", style="dim")
    screen.print()


def verdict_counts_text(rows: Sequence[Row]) -> str:
    """Return the number of rows with each verdict, in words."""
    counts = Counter(row.verdict for row in rows)
    return ", ".join(f"{count} {_PLURAL.get(verdict, verdict)}" for verdict, count in counts.most_common())


_PLURAL = {"agrees": "agree", "misprint": "misprints", "differs": "differ"}


def _verdicts_text(rows: Sequence[Row]) -> str:
    verdicts = {row.verdict for row in rows}
    return f"all {len(rows)}: {verdicts.pop()}" if len(verdicts) == 1 else verdict_counts_text(rows)


def _exact_text(row: Row) -> str:
    """Return the exact value with three digits more than printed, nine without a printed value."""
    assert row.exact is not None
    digits = sum(character.isdigit() for character in (row.printed or "").partition("e")[0].lstrip("-+0."))
    return f"{row.exact:.{min(10, max(6, digits + 3)) if row.printed else 9}g}"
