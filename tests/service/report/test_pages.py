"""Pages of a report: words stay whole, and what belongs together on one page."""

from __future__ import annotations

import random

import pytest
from matplotlib.figure import Figure

from slidercrank.service.report.document import Facts, Paragraph, Picture, Report, Section, Table
from slidercrank.service.report.pages import Page, pages, wrapped

UNITS = ["mm", "N m", "MPa m/s", "kg m²", "m/s²", "%", "deg", "rpm", "lbf in"]

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


def test_no_line_ends_between_a_number_and_its_unit() -> None:
    drawn = random.Random(6)
    broken = 0
    for _ in range(200):
        numbers = [f"{drawn.uniform(0.0, 900.0):.3g} {drawn.choice(UNITS)}" for _ in range(12)]
        text = ", ".join(f"{drawn.choice(WORDS)} {number}" for number in numbers)
        lines = wrapped(text, 9.0, drawn.uniform(1.6, 4.0))
        assert " ".join(lines).replace("\u00a0", " ") == text
        assert sum(line.replace("\u00a0", " ").count(number) for line in lines for number in set(numbers)) >= 12
        broken += len(lines) > 1
    assert broken == 200
    for unit in UNITS:
        assert wrapped(unit, 9.0, 0.1)[0][:1] == unit[:1]
        assert wrapped(f"peak torque, {unit}", 9.0, 1.4)[-1].endswith(f"torque, {unit}".replace(" ", "\u00a0"))


@pytest.mark.parametrize("height", [3.0, 5.0, 6.0, 8.0, 12.0])
def test_a_heading_is_on_the_page_of_its_figure(height: float) -> None:
    drawn = random.Random(7)
    for _ in range(12):
        facts = Facts({f"fact {number}": ["a line"] for number in range(drawn.randint(1, 60))})
        picture = Picture("A figure", lambda: Figure((6.0, height)))
        sections = (Section("Before", (facts,)), Section("Sensitivity", (picture,)))
        for page in pages(Report("Title", "subtitle", "2026-11-22", sections)):
            assert ("Sensitivity" in texts(page)) == bool(page.insets) == ("A figure" in texts(page))
            for inset in page.insets:
                assert inset.bottom > 0.8
