"""The view of a design: extremes of its curves, and the way back from its slider to the crank."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from tests.service.api.fixed_front import Solved
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched

DESIGN = 3
CELLS = """table => [...table.tBodies[0].rows].map(row => [row.cells[0].textContent,
  ...[...row.cells].slice(1).filter(cell => cell.dataset.value !== undefined)
    .map(cell => cell.dataset.value === "" ? null : Number(cell.dataset.value))])"""

PLACES = ("_mm", "_at_crank_angle_deg", "_at_slider_position_mm")


def number(cell: Locator) -> float:
    return float(cell.inner_text().replace("−", "-"))


def command_numbers(solved: Solved, *arguments: str) -> Any:
    run = ("latest", "--runs", str(solved.folder.parent), "--design", str(DESIGN), "--json")
    done = CliRunner().invoke(command_line, [arguments[0], *run, *arguments[1:]])
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved) -> Iterator[Page]:
    """Return one page for all tests here, of which nothing may go wrong but refusals."""
    with watched(pages, solved.store, expected=("422",)) as (page, address):
        page.goto(f"{address}/#/help")
        yield page


@pytest.fixture
def page(opened: Page, solved: Solved) -> Page:
    """Return the view of a design as if for the first time."""
    opened.evaluate("localStorage.clear(); location.hash = '#/help'")
    expect(opened.locator(".mechanism .link.crank")).to_have_count(0)
    opened.evaluate("view => { location.hash = view; }", f"#/jobs/{solved.number}/designs/{DESIGN}")
    opened.locator(".inverse").wait_for()
    expect(opened.locator(".inverse")).to_contain_text("The slider of this design is", timeout=30_000)
    return opened


def table(page: Page, name: str) -> Locator:
    return page.get_by_role("table", name=re.compile(f"^{re.escape(name)}"))  # another one ends with these words


def field(page: Page, name: str) -> Locator:
    return page.get_by_role("textbox", name=name)


def test_extremes_are_those_of_the_command_line_in_either_system(page: Page, solved: Solved) -> None:
    record = command_numbers(solved, "analyse", "--show", "extremes")["extremes"]
    page.locator("section.extremes").scroll_into_view_if_needed()
    curves = table(page, "Extreme values over the turn")
    expect(curves).to_be_visible(timeout=30_000)
    entry = record["curves"]["slider_position"]
    metric = [entry[f"{end}{at}"] for end in ("least", "greatest") for at in PLACES]
    # The run of the command line has the same designs but for rounding; an angle on a flat top feels more of that.
    first = curves.locator("tbody tr").first
    assert [number(cell) for cell in first.locator("td.number").all()] == pytest.approx(metric, rel=1e-3, abs=1e-2)
    strokes = table(page, "Strokes").locator("tbody tr")
    ratio = strokes.filter(has_text="ratio of durations").locator("td").first
    assert number(ratio) == pytest.approx(record["strokes"]["duration_ratio"], rel=1e-5)
    page.get_by_label("Units").select_option("inch")
    expect(first.locator("td").last).to_have_text("in", timeout=30_000)
    inch = [value if at.endswith("deg") else value / 25.4 for value, at in zip(metric, 2 * PLACES, strict=True)]
    assert [number(cell) for cell in first.locator("td.number").all()] == pytest.approx(inch, rel=1e-3, abs=1e-2)


def test_the_way_back_is_that_of_the_command_line(page: Page, solved: Solved) -> None:
    position = field(page, "Slider position")
    middle = float(position.input_value())
    position.press("Enter")
    found = table(page, "Crank angles: ")
    expect(found.locator("tbody tr")).to_have_count(2)
    expect(found).not_to_contain_text("crank speed")
    field(page, "Slider velocity").fill("−1.5")
    field(page, "Slider acceleration").fill("4")
    page.get_by_role("button", name="Find crank angles").click()
    expect(found).to_contain_text("crank acceleration")
    motion = (f"--slider-position={middle} mm", "--slider-velocity=-1.5 m/s", "--slider-acceleration=4 m/s^2")
    expected = command_numbers(solved, "inverse", *motion)["solutions"]
    angles = [float(str(cell.get_attribute("data-value"))) for cell in found.locator("tbody th").all()]
    assert angles == pytest.approx([solution["crank_angle_deg"] for solution in expected], rel=1e-6)
    for row, solution in zip(found.evaluate(CELLS), expected, strict=True):
        values = [solution["crank_speed_rpm"], solution["crank_acceleration_rad_s2"]]
        assert row[1:] == pytest.approx(values, rel=1e-6)
    page.get_by_role("button", name="Turn the crank to").nth(1).click()
    crank = page.get_by_role("slider", name="Crank angle")
    assert float(crank.input_value()) == pytest.approx(angles[1], abs=1.0)


def test_the_way_back_in_inches_is_the_same(page: Page) -> None:
    position = field(page, "Slider position")
    middle = float(position.input_value())
    field(page, "Slider velocity").fill("2")
    field(page, "Slider velocity").press("Enter")
    found = table(page, "Crank angles: ")
    before = found.evaluate(CELLS)
    page.get_by_label("Units").select_option("inch")
    expect(page.locator(".inverse")).to_contain_text("in/s")
    assert float(position.input_value()) == pytest.approx(middle / 25.4, rel=1e-7)
    assert float(field(page, "Slider velocity").input_value()) == pytest.approx(2.0 / 0.0254, rel=1e-7)
    with page.expect_response("**/inverse?*"):
        position.press("Enter")
    for row, other in zip(before, found.evaluate(CELLS), strict=True):
        assert row[1:] == pytest.approx(other[1:], rel=1e-6)


def test_the_way_back_takes_sums_commas_and_units(page: Page) -> None:
    position, found = field(page, "Slider position"), table(page, "Crank angles: ")
    middle = float(position.input_value())
    answers = []
    for typed in (f"{middle:.4f}", f"2*{middle / 2:.4f}", f"{middle:.4f}".replace(".", ","), f"{middle / 25.4:.9f} in"):
        position.fill(typed)
        with page.expect_response("**/inverse?*"):
            position.press("Enter")
        answers.append([row[1:] for row in found.evaluate(CELLS)])
    for other in answers[1:]:
        assert other == [pytest.approx(row, rel=1e-4) for row in answers[0]]


def test_what_cannot_be_is_said_in_a_sentence(page: Page) -> None:
    for name, typed, sentence in (
        ("Slider position", "", "Slider position: a value is needed, such as 240 mm."),
        ("Slider position", "abc", "“abc” is not a valid length; write a number, in mm or with its unit."),
        ("Slider velocity", "Infinity", "“Infinity” is not a valid speed; write a number, in m/s or with its unit."),
        ("Slider position", "100000", "The slider position must be within reach of the open branch"),
        ("Slider position", "1e99", "Slider position must be at most"),
        ("Slider acceleration", "4", "got acceleration 4 m/s² alone"),
    ):
        before = field(page, name).input_value()
        field(page, name).fill(typed)
        field(page, name).press("Enter")
        expect(page.locator(".inverse [role=alert]")).to_contain_text(sentence)
        expect(table(page, "Crank angles: ")).to_have_count(0)
        field(page, name).fill(before)
        field(page, name).press("Enter")
        expect(table(page, "Crank angles: ")).to_be_visible()


def test_at_a_dead_centre_the_speed_is_undefined_and_says_so(page: Page, solved: Solved) -> None:
    record = command_numbers(solved, "analyse", "--show", "extremes")["extremes"]
    outermost = record["curves"]["slider_position"]["greatest_mm"]
    field(page, "Slider position").fill(repr(outermost))
    field(page, "Slider velocity").fill("0")
    field(page, "Slider velocity").press("Enter")
    expect(page.locator(".inverse")).to_contain_text("crank speed and acceleration are undefined")
    expect(table(page, "Crank angles: ").locator("tbody tr")).to_have_count(1)


@pytest.mark.slow
def test_nothing_bars_the_way_of_anybody(page: Page) -> None:
    page.locator("section.extremes").scroll_into_view_if_needed()
    expect(table(page, "Extreme values over the turn")).to_be_visible(timeout=30_000)
    field(page, "Slider velocity").fill("1")
    field(page, "Slider velocity").press("Enter")
    expect(table(page, "Crank angles: ")).to_be_visible()
    require_accessible(page)
