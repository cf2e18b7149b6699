"""Pages of a report: words stay whole, and what belongs together on one page."""

from __future__ import annotations

import random

from slidercrank.service.report.document import Facts, Paragraph, Report, Section, Table
from slidercrank.service.report.pages import Page, pages

WORDS = [
    "crank",
    "rod",
    "offset",
    "transmission",
    "angle,",
    "deg",
    "position",
    "error",
    "worst",
    "case,",
    "torque",
    "peak_pivot_force_N",
    "0.203753",
]


def laid_out(*blocks: Facts | Paragraph | Table) -> list[Page]:
    return pages(Report("Title", "subtitle", "2026-11-22", (Section("Section", blocks),)))


def texts(page: Page) -> list[str]:
    return [text.get_text() for text in page.figure.texts]


def test_columns_are_as_wide_as_their_longest_word_where_there_is_room() -> None:
    drawn = random.Random(5)
    for _ in range(60):
        columns = drawn.randint(2, 6)
        heads = tuple(" ".join(drawn.sample(WORDS, 3)) for _ in range(columns))
        row = tuple(drawn.choice(WORDS) for _ in range(columns))
        shares = [drawn.uniform(0.02, 1.0) for _ in range(columns)]
        wide = tuple(share / sum(shares) for share in shares)
        table = Table("A table", heads, (row,), wide, bold=frozenset({0}), small=columns > 4)
        written = " ".join(text for page in laid_out(table) for text in texts(page)).split()
        words = [word for cell in (*heads, *row) for word in cell.split()]
        assert all(written.count(word) >= words.count(word) for word in words), (heads, written)


def test_a_note_after_facts_is_not_alone_on_its_page() -> None:
    apart = 0
    for count in range(30, 60):
        facts = Facts({f"fact {number}": ["a line"] for number in range(count)})
        first, *others = laid_out(facts, Paragraph("a note", "note"))
        for page in (first, *others):
            if "a note" in texts(page):
                assert f"fact {count - 1}" in texts(page)
        apart += bool(others)
    assert 0 < apart < 30
