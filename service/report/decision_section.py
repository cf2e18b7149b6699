"""Section on the decision: the chosen design, its reason, the reasons against the others, and earlier decisions."""

from datetime import UTC, datetime

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import System, unit_text
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
    decisions = _decisions(subject)
    by = f" {decisions[-1][0]}." if decisions else ""
    blocks: list[Block] = [Paragraph(f"{chosen.bookmark.decision(chosen.remarks(subject.system))}{no_reason}.{by}")]
    if subject.bookmark != chosen.bookmark:
        blocks.append(Paragraph("This report is about another design.", "note"))
    ordered = [chosen, *(alternative for alternative in subject.alternatives if alternative is not chosen)]
    rows = [convert_row(alternative.varied.row, subject.system) for alternative in ordered]
    keys = [find_column(name, list(rows[0])).key for name in DIMENSIONS]
    columns = [find_column(key, list(rows[0])) for key in keys]
    objectives = subject.result.objectives
    numbers = [*columns, *(find_column(item.column, list(rows[0])) for item in objectives)]
    heads = tuple(f"{column.title}, {unit_text(column.unit)}" if column.unit else column.title for column in numbers)
    cells = tuple(
        (
            alternative.bookmark.name,
            *(format_cell(row[column.key]) for column in numbers),
            _reason_and_misses(alternative, subject.system),
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
    if len(decisions) > 1:
        heads = ("by, at", "decision", "reason")
        blocks.append(Table("Decisions, oldest first", heads, tuple(decisions), (0.3, 0.3, 0.4), small=True))
    return Section("Decision", tuple(blocks))


def _decisions(subject: Subject) -> list[tuple[str, str, str]]:
    """Return author with time, decision and reason of every decision and withdrawal, oldest first."""
    entries = [entry for alternative in subject.alternatives for entry in alternative.bookmark.history]
    words = {"decided": "for {}", "withdrawn": "{} withdrawn"}
    return [
        (
            ", ".join(filter(None, (entry.author, f"{datetime.fromtimestamp(entry.at, UTC):%Y-%m-%d %H:%M} UTC"))),
            words[entry.action].format(entry.name),
            entry.text,
        )
        for entry in sorted(entries, key=lambda entry: entry.number)
        if entry.action in words
    ]


def _reason_and_misses(alternative: Alternative, system: System) -> str:
    """Return the reason, the notes, and the requirements that a design misses or from which it deviates."""
    notes = (f"note: {note}" for note in alternative.bookmark.notes)
    return "; ".join(part for part in (alternative.bookmark.reason, *notes, *alternative.remarks(system)) if part)
