"""Section on the decision: the chosen design, its reason, and the reasons against the others."""

from __future__ import annotations

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import unit_text
from ..designs.columns import find_column
from ..designs.display_units import convert_row
from ..render.numerals import format_cell
from .document import Block, Paragraph, Section, Table
from .subject import Alternative, Subject


def decision_section(subject: Subject) -> Section | None:
    """Return the chosen design, and the others with the reasons against them; None if there is no decision."""
    chosen = next((alternative for alternative in subject.alternatives if alternative.bookmark.decided), None)
    if chosen is None:
        return None
    no_reason = "" if chosen.bookmark.reason else "; no reason was given"
    blocks: list[Block] = [Paragraph(f"{chosen.bookmark.decision(chosen.faults)}{no_reason}.")]
    if subject.bookmark != chosen.bookmark:
        blocks.append(Paragraph("This report is about another design.", "note"))
    ordered = [chosen, *(alternative for alternative in subject.alternatives if alternative is not chosen)]
    rows = [convert_row(alternative.row, subject.system) for alternative in ordered]
    keys = [find_column(name, list(rows[0])).key for name in DIMENSIONS]
    columns = [find_column(key, list(rows[0])) for key in keys]
    objectives = subject.result.objectives
    numbers = [*columns, *(find_column(item.column, list(rows[0])) for item in objectives)]
    heads = tuple(f"{column.title}, {unit_text(column.unit)}" if column.unit else column.title for column in numbers)
    cells = tuple(
        (
            alternative.bookmark.name,
            *(format_cell(row[column.key]) for column in numbers),
            _reason_and_misses(alternative),
        )
        for alternative, row in zip(ordered, rows, strict=True)
    )
    share = 0.6 / len(numbers)
    blocks.append(
        Table(
            "The kept designs",
            ("design", *heads, "why, or why not"),
            cells,
            (0.15, *([share] * len(numbers)), 0.25),
            frozenset(range(1, len(numbers) + 1)),
            frozenset({0}),
            small=True,
        )
    )
    return Section("Decision", tuple(blocks))


def _reason_and_misses(alternative: Alternative) -> str:
    """Return the reason, the note, and the requirements that a design misses."""
    note = alternative.bookmark.note and f"note: {alternative.bookmark.note}"
    return "; ".join(part for part in (alternative.bookmark.reason, note, *alternative.faults) if part)
