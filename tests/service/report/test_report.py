"""Reports: every number of the design is there, nothing is fetched, and both files say the same."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from functools import cache
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.requirements import Range
from slidercrank.optimise.solve import solve
from slidercrank.service.designs.columns import find_column
from slidercrank.service.render.numerals import format_cell
from slidercrank.service.report.design_report import design_report
from slidercrank.service.report.document import Facts, Paragraph, Report, Section, Table
from slidercrank.service.report.html import html_file
from slidercrank.service.report.pdf import pdf_file
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import result_of
from tests.service import fronts
from tests.service.report.paper import A4, Page, paper

INCH = 72.0  # points
NUMBER = 3
NAME = r"$\frac{ <script>alert(1)</script> &amp; Größe"
CERTIFICATE = {
    "status": "proven",
    "message": "no feasible design beats the front by more than 1 %",
    "epsilon": 0.01,
    "epsilon_of_delivered": 0.0123,
    "gap_of_delivered": 0.004,
    "hypervolume_gap": None,
    "boxes": 12345,
    "open_boxes": 0,
    "seconds": 1.5,
    "notes": ["a note"],
}


@cache
def subject() -> Subject:
    found = fronts.front(fronts.FOUR[:2], designs=6)
    found = replace(found, problem=replace(found.problem, name=NAME))
    result = result_of(found, "kept")
    return Subject(found.problem, result, NUMBER, run="kept", versions={"numpy": "1.2.3"}, certificate=CERTIFICATE)


@cache
def report() -> Report:
    return design_report(subject(), created=0.0)


@cache
def printed_report() -> list[Page]:
    return paper(pdf_file(report()))


@cache
def html() -> str:
    return html_file(report()).decode()


def text_of(page: str) -> str:
    """Return the text of a page as a reader sees it, spaces as one."""
    page = re.sub(r"<style>.*?</style>", " ", page, flags=re.DOTALL)
    page = re.sub(r"<br>|</(dt|dd|td|th|p|li|h1|h2|h3|figcaption)>", " ", page)
    return " ".join(unescape(re.sub(r"<[^>]+>", "", page)).split())


def texts(part: Report) -> list[str]:
    """Return everything that a report says."""
    found = [part.title, part.subtitle, part.date, *part.signatures]
    for section in part.sections:
        found.append(section.title)
        for block in section.blocks:
            if isinstance(block, Paragraph):
                found.append(block.text)
            elif isinstance(block, Facts):
                found += [text for name, lines in block.rows.items() for text in (name, *lines)]
            elif isinstance(block, Table):
                found += [block.title, *block.heads, *(cell for row in block.rows for cell in row)]
            else:
                found.append(block.title)
    return [" ".join(text.split()) for text in found if text.strip()]


@pytest.mark.slow
def test_every_number_of_the_design_is_in_it() -> None:
    (table,) = (block for block in named("Every number of the design").blocks if isinstance(block, Table))
    row = subject().row
    keys = [cells[3] for cells in table.rows]
    left = [key for key in row if key not in keys]
    assert keys == [key for key in row if key not in left]
    note = named("Every number of the design").blocks[1]
    assert isinstance(note, Paragraph)
    titles = note.text.removeprefix("Not defined for this machine: ").removesuffix(".").split(", ")
    assert sorted(", ".join(titles)) == sorted(", ".join(find_column(key, list(row)).title for key in left))
    blank = [key for key, cell in row.items() if cell is None or (isinstance(cell, float) and math.isnan(cell))]
    assert set(blank) == set(left)
    for title, value, unit, key in table.rows:
        cell, column = row[key], find_column(key, list(row))
        assert title == column.title
        assert unit.replace("²", "^2").replace("³", "^3") == column.unit
        if isinstance(cell, float):
            size, _, tolerance = value.replace("−", "-").partition(" ± ")
            assert bool(tolerance) == (key in ("crank_mm", "rod_mm"))  # the machine has no tolerance of the offset
            assert float(size) == pytest.approx(cell, rel=1e-4, abs=0.5 * float(tolerance or 0.0))
        else:
            assert value == cell
        assert all(part in text_of(html()) for part in (value, key))


def named(title: str) -> Section:
    return next(section for section in report().sections if section.title == title)


def test_both_files_say_everything() -> None:
    page = text_of(html())
    words = re.sub(r"\s", "", "".join(sheet.whole for sheet in printed_report()))
    for text in texts(report()):
        assert text in page, text
        assert re.sub(r"\s", "", text) in words, text


def test_it_says_what_was_asked_how_it_was_found_and_how_good_it_is() -> None:
    page = text_of(html())
    for words in (
        "crank speed 300 rpm (counter-clockwise)",
        "least transmission angle at least 30 deg",
        "maximise time ratio",
        "minimise peak torque",
        "Seed 1",
        "Evaluations 400",
        "proven: no feasible design beats the front by more than 1 %",
        "epsilon proven, for this front alone: 0.0123",
        "numpy 1.2.3",
        "1970-01-01 00:00 UTC",
        "All requirements are met.",
        "Stationary: no small change improves every objective",
        "Worst case, exact",
        "random machines".capitalize(),
    ):
        assert words in page, words


def test_a_rule_that_is_not_met_is_said() -> None:
    rows = [{**row, "slack_least_transmission_angle_deg": -1.0} for row in subject().result.designs]
    broken = replace(subject(), metric=replace(subject().metric, designs=rows))
    said = texts(design_report(broken))
    assert "Not all requirements are met: see below." in said
    assert "not met" in said


def test_without_certificate_and_tolerances_it_says_so_or_leaves_out() -> None:
    found = subject()
    part = found.design.part
    part = replace(part, mechanism=replace(part.mechanism, tolerances=type(part.mechanism.tolerances)()))
    bare = replace(found, certificate=None, versions={})
    vars(bare)["design"] = replace(found.design, part=part)  # as if the job had none
    plain = design_report(bare)
    assert any(text.startswith("No certificate") for text in texts(plain))
    assert "not recorded" in texts(plain)
    assert "Tolerances" not in [section.title for section in plain.sections]


def test_the_page_is_whole_and_nothing_in_it_runs_or_is_fetched() -> None:
    open_, seen = [], []

    class Reader(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            seen.append((tag, dict(attrs)))
            if tag not in ("meta", "br", "img", "path", "use", "rect", "line", "circle", "image", "stop"):
                open_.append(tag)

        def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            seen.append((tag, dict(attrs)))

        def handle_endtag(self, tag: str) -> None:
            if open_ and open_[-1] == tag:
                open_.pop()
            else:
                assert tag in ("path", "use", "rect", "line", "circle"), (tag, open_[-3:])

    reader = Reader()
    reader.feed(html())
    assert open_ == []
    assert not [tag for tag, _ in seen if tag in ("script", "link", "iframe", "object", "embed", "form")]
    names = [attributes["id"] for _, attributes in seen if "id" in attributes]
    assert len(names) == len(set(names))
    for tag, attributes in seen:
        assert not [key for key in attributes if key.startswith("on")], tag
        for key in ("src", "href", "xlink:href", "data"):
            value = attributes.get(key)
            assert value is None or value.startswith(("#", "data:image/png")), (tag, value)
            if value is not None and value.startswith("#"):
                assert value[1:] in names, value
    assert not re.search(r"url\((?!#)|@import", html())
    assert len([tag for tag, _ in seen if tag == "svg"]) == 6
    (policy,) = (attributes["content"] for tag, attributes in seen if "http-equiv" in attributes)
    assert policy == "default-src 'none'; style-src 'unsafe-inline'; img-src data:"


def test_nothing_on_a_page_of_the_pdf_is_cut_or_covers_something_else() -> None:
    assert 4 <= len(printed_report()) <= 12
    for page in printed_report():
        for text, (left, bottom, right, top) in page.texts:
            assert left > 0.6 * INCH, text
            assert right < A4[0] - 0.6 * INCH, text
            assert bottom > 0.3 * INCH, text
            assert top < A4[1] - 0.6 * INCH, text
        for index, (text, one) in enumerate(page.texts):
            for other_text, other in page.texts[:index]:
                across, up = (
                    min(one[2], other[2]) - max(one[0], other[0]),
                    min(one[3], other[3]) - max(one[1], other[1]),
                )
                assert across < 1.5 or up < 2.5, (text, other_text)


def test_the_drawing_is_on_the_first_page_and_no_page_but_the_last_is_half_empty() -> None:
    first, *others, _ = printed_report()
    assert len(first.insets) == 1
    assert "The linkage, to scale" in first.whole
    for page in (first, *others):
        feet = [bottom for text, (_, bottom, _, _) in page.texts if bottom > 0.7 * INCH]
        assert min([*feet, *(inset.bottom for inset in page.insets)]) < 0.5 * A4[1], page.number


def test_the_pdf_is_whole_and_the_same_report_gives_the_same() -> None:
    content = pdf_file(report())
    assert content == pdf_file(report())
    assert content.startswith(b"%PDF-1.")
    assert content.rstrip().endswith(b"%%EOF")
    assert len(content) < 2_000_000
    assert b"/StructTreeRoot" in content  # tagged
    for word in ("Summary", "Prepared", "crank", "Größe"):
        assert any(word in page.whole for page in printed_report()), word
    assert any("crank angle, deg" in page.whole for page in printed_report())  # texts of figures are texts too


@pytest.mark.parametrize(
    ("cell", "text"),
    [
        (1.23456789, "1.2346"),
        (-math.inf, "−∞"),
        (math.nan, "–"),
        (None, "–"),
        ("inward", "inward"),
        (0.0, "0"),
    ],
)
def test_values_are_written_for_people(cell: float | str | None, text: str) -> None:
    assert format_cell(cell) == text


def test_no_word_of_a_table_is_broken() -> None:
    found = fronts.front(designs=6)
    below = found.dimensions * (1.0, 1.0, -1.0)  # signs are a letter more
    shown = {"offset_mm": -found.columns["offset_mm"], "slack_least_transmission_angle_deg": np.full(6, -1.5e-14)}
    result = result_of(replace(found, columns=found.columns | shown, dimensions=below), "kept")
    of = Subject(replace(found.problem, offset=Range(lower=-0.15, upper=0.0)), result, 2, run="kept", versions={})
    sections = [
        replace(part, blocks=tuple(block for block in part.blocks if isinstance(block, Table)))
        for part in design_report(of, created=0.0).sections
    ]
    tables = replace(report(), sections=tuple(part for part in sections if part.blocks))
    written = {word for page in paper(pdf_file(tables)) for word in page.whole.split()}
    for part in tables.sections:
        for block in part.blocks:
            assert isinstance(block, Table)
            words = {word for row in (block.heads, *block.rows) for cell in row for word in cell.split()}
            assert words <= written, words - written
            for row in block.rows:
                assert "slack_" not in row[-1] or row[1] == "0"


def test_a_large_front_is_drawn_as_points(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slidercrank.service.report.job_and_front._MANY", 5)
    large = design_report(subject())
    front = replace(large, sections=tuple(part for part in large.sections if part.title == "The front"))
    assert html_file(front).decode().count("data:image/png;base64,") == 2
    assert pdf_file(front).count(b"/Subtype/Image") == 2


def test_json_of_the_certificate_is_what_certify_writes(tmp_path: Path) -> None:
    """The names that the report reads are those of the file of `slidercrank certify`."""
    import inspect

    from slidercrank.service.questions.certify import analysis

    source = inspect.getsource(analysis)
    assert all(f'"{key}"' in source for key in CERTIFICATE)
    assert json.loads(json.dumps(CERTIFICATE)) == CERTIFICATE


def test_a_fast_stroke_that_is_loaded_is_warned_of_and_the_slow_stroke_stands_in_the_table() -> None:
    (sentence,) = subject().result.warnings
    assert "the loaded stroke (the outward one, against the load) is the faster one" in sentence
    assert sentence in text_of(html())
    marked = next(
        block
        for section in report().sections
        for block in section.blocks
        if isinstance(block, Table) and block.title == "Marked designs"
    )
    place = marked.heads.index("slow stroke")
    assert {row[place] for row in marked.rows} == {"inward"}


def test_the_machine_of_a_design_is_told_where_it_is_not_that_of_the_job() -> None:
    """Speed and width of a design stand in the summary; the job keeps what it gives."""
    job = {
        "name": "chosen",
        "mechanism": {
            "speed": "30 rpm",
            "crank": {"width": "70 mm", "depth": "20 mm", "density": "7850 kg/m^3"},
            "slider": {"mass": "8 kg"},
        },
        "variables": {
            **{"crank": "30 mm", "rod": ["90 mm", "200 mm"], "offset": "10 mm"},
            "mechanism": {"crank": {"width": ["45 mm", "120 mm"]}, "speed": {"choices": ["24 rpm", "36 rpm"]}},
        },
        "objectives": {"transmission_angle": "maximise", "peak_torque": "minimise"},
        "optimiser": {"method": "sobol", "evaluations": 200, "designs": 3, "seed": 1},
    }
    problem = parse_job(job)
    result = result_of(solve(problem), "chosen")
    for number, row in enumerate(result.designs, start=1):
        said = texts(design_report(Subject(problem, result, number, run="chosen", versions={}), created=0.0))
        assert f"crank: bar {row['crank_width_mm']:.6g} x 20 mm (width x depth), 7850 kg/m³" in said
        assert f"crank speed {row['choice_speed']} (counter-clockwise)" in said
        assert "crank speed 30 rpm (counter-clockwise)" in said
        assert "slider: 8 kg" in said
    assert "Machine" not in texts(report())
