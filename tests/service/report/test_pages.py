"""Pages of a report: words stay whole, what belongs together is on one page, and pages are filled."""

from __future__ import annotations

import random
from functools import partial

import pytest
from matplotlib.figure import Figure

from slidercrank.service.report.document import Block, Facts, Paragraph, Picture, Report, Section, Table
from slidercrank.service.report.pdf import pdf_file
from tests.service.report.paper import Page, paper

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


def laid_out_report(*sections: tuple[Block, ...]) -> list[Page]:
    made = tuple(Section(f"Section {number}", blocks) for number, blocks in enumerate(sections))
    return paper(pdf_file(Report("Title", "subtitle", "2026-11-22", made)))


def test_columns_are_as_wide_as_their_longest_word_where_there_is_room() -> None:
    chance = random.Random(5)
    tables = []
    for _ in range(60):
        columns = chance.randint(2, 6)
        heads = tuple(" ".join(chance.sample(WORDS, 3)) for _ in range(columns))
        row = tuple(chance.choice(WORDS) for _ in range(columns))
        shares = [chance.uniform(0.02, 1.0) for _ in range(columns)]
        wide = tuple(share / sum(shares) for share in shares)
        tables.append(Table("A table", heads, (row,), wide, bold=frozenset({0}), small=columns > 4))
    written = " ".join(page.whole for page in laid_out_report(tuple(tables))).split()
    words = [word for table in tables for cell in (*table.heads, *table.rows[0]) for word in cell.split()]
    for word in set(words):
        assert written.count(word) >= words.count(word), word


def test_a_table_is_written_whole_and_its_heads_are_on_every_page() -> None:
    rows = tuple((f"quantity {number}", f"{number}.5") for number in range(150))
    pages = laid_out_report((Table("A table", ("name", "number"), rows, (0.7, 0.3), frozenset({1})),))
    assert len(pages) > 2
    assert all("name" in page.whole for page in pages)
    together = " ".join(" ".join(page.whole.split()) for page in pages)
    assert all(f"{name} {number}" in together for name, number in rows)


def test_no_line_ends_between_a_number_and_its_unit() -> None:
    chance = random.Random(6)
    numbers = [f"{chance.uniform(0.0, 900.0):.3g} {chance.choice(UNITS)}" for _ in range(600)]
    text = ", ".join(f"{chance.choice(WORDS)} {number}" for number in numbers)
    table = Table("Heads", tuple(f"peak torque, {unit}" for unit in UNITS[:6]), (("1",) * 6,), (1 / 6,) * 6)
    pages = laid_out_report((Paragraph(text), table))
    lines = [line.replace("\u00a0", " ") for page in pages for line in page.whole.splitlines()]
    assert len(lines) > 50
    assert sum(line.count(number) for line in lines for number in set(numbers)) >= len(numbers)
    for unit in UNITS[:6]:
        assert any(line.endswith(f"torque, {unit}") or f"torque, {unit} " in line for line in lines), (
            unit,
            lines[-12:],
        )


@pytest.mark.parametrize("count", range(1, 60, 4))
def test_a_note_after_facts_is_not_alone_on_its_page(count: int) -> None:
    facts = Facts({f"fact {number}": ["a line"] for number in range(count)})
    pages = laid_out_report((Facts({"a": ["b"]}),), (facts, Paragraph("a note", "note")))
    (page,) = (page for page in pages if "a note" in page.whole)
    assert f"fact {count - 1}" in page.whole


@pytest.mark.parametrize("height", [3.0, 5.0, 6.0, 8.0, 12.0])
def test_a_heading_is_on_the_page_of_its_figure(height: float) -> None:
    chance = random.Random(7)
    for _ in range(5):
        facts = Facts({f"fact {number}": ["a line"] for number in range(chance.randint(1, 60))})
        picture = Picture("A figure", partial(Figure, (6.0, height)))
        pages = laid_out_report((facts,), (picture,))
        with_figure = [page for page in pages if "A figure" in page.whole]
        assert len(with_figure) == 1
        assert "Section 1" in with_figure[0].whole


def test_signatures_are_on_the_first_page_below_the_summary() -> None:
    (page,) = laid_out_report((Facts({"Lengths": ["crank 40 mm"]}),))
    (below,) = (box for words, box in page.texts if words.startswith("Prepared by"))
    (above,) = (box for words, box in page.texts if words.startswith("crank"))
    assert below[3] < above[1] - 40.0


def test_empty_and_strange_texts_are_written_as_they_are() -> None:
    strange = r"#set page() $x$ *bold* _it_ `raw` \ <label> @ref // no comment [ ] { } ~ -- Größe"
    blocks: tuple[Block, ...] = (
        Facts({}),
        Paragraph(""),
        Paragraph(strange, "bad"),
        Facts({strange: [strange, ""]}),
        Table(strange, (strange, ""), ((strange, ""),), (0.5, 0.5)),
        Table("none", ("a", "b"), (), (0.5, 0.5)),
    )
    whole = " ".join(page.whole for page in laid_out_report(blocks)).split()
    for word in strange.split():
        assert whole.count(word) >= 5, word
