"""The view of a design: it moves, its curves follow, what-if, others beside it, the same numbers everywhere."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable, Iterator
from typing import Any

import ezdxf.filemanagement
import httpx
import numpy as np
import pytest
from playwright.sync_api import Locator, Page, expect

from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.optimise.job import load_job
from tests.service.api.fixed_front import Solved, served
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, Pages, watch

Opened = Callable[..., Page]
Shared = tuple[Page, list[str]]
STILL: dict[str, Any] = {"reduced_motion": "reduce", "color_scheme": "light"}
WIDE = {"width": 1280, "height": 900}
NARROW = {"width": 390, "height": 800}
CENTRES = """nodes => nodes.map(node => {
  const box = node.getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
})"""
LENGTHS_BETWEEN_DEGREES = [(113.9, 484.8, 108.0), (100.6, 480.7, 56.2), (118.3, 362.7, 46.9)]
"""Linkages whose stroke between whole degrees of the crank differs in its fourth digit."""
NUMBERS = """nodes => nodes.map(node => [node.dataset.key, node.dataset.value])"""


def view(solved: Solved, design: int = 3, query: str = "") -> str:
    return f"#/jobs/{solved.number}/designs/{design}{query}"


@pytest.fixture(scope="module")
def service(solved: Solved) -> Iterator[str]:
    """Return the address of one service for all tests here."""
    with served(solved.store) as address:
        yield address


@pytest.fixture(scope="module")
def shared(pages: Pages, service: str) -> Iterator[Shared]:
    """Return one page for all tests here, and what it may complain of."""
    wrong: list[str] = []
    expected: list[str] = []
    with pages.fresh(service) as page:
        watch(page, service, wrong, expected)
        page.goto(service)
        yield page, expected
    assert wrong == []


@pytest.fixture
def opened(shared: Shared, solved: Solved) -> Opened:
    """Return a function that opens a design as if for the first time and waits for its mechanism."""
    page, expected = shared

    def opening(
        design: int = 3, query: str = "", *, complaints: tuple[str, ...] = (), viewport: Any = WIDE, **media: Any
    ) -> Page:
        expected[:] = complaints
        page.evaluate("localStorage.clear(); location.hash = '#/help'")
        page.set_viewport_size(viewport)
        page.emulate_media(**{**STILL, **media})
        page.evaluate("view => { location.hash = view; }", view(solved, design, query))
        page.locator(".mechanism .link.crank").first.wait_for()
        expect(page.get_by_role("heading", level=1)).to_contain_text(f"Design {design}", timeout=30_000)
        expect(page.locator(".mechanism .link.crank").first).to_be_visible()
        return page

    return opening


def crank_angle(page: Page) -> Locator:
    return page.get_by_role("slider", name="Crank angle")


def angle_of(page: Page) -> float:
    return float(crank_angle(page).input_value())


def place_of(part: Locator) -> str | None:
    """Where a link, or a cursor, is: it moves with its parent, or by its style."""
    found: str | None = part.evaluate("node => node.style.transform || node.parentElement.getAttribute('transform')")
    return found


@pytest.mark.parametrize(("crank", "rod", "offset"), LENGTHS_BETWEEN_DEGREES)
def test_the_stroke_in_the_drawing_is_that_of_the_api_to_its_last_digit(
    opened: Opened, service: str, solved: Solved, crank: float, rod: float, offset: float
) -> None:
    page = opened(3, f"?crank_mm={crank}&rod_mm={rod}&offset_mm={offset}")
    lengths = {"crank_mm": crank, "rod_mm": rod, "offset_mm": offset}
    design = httpx.post(f"{service}{solved.path}/designs/3/what-if", json=lengths, timeout=60.0).json()["design"]
    expect(page.locator("text.dimension.stroke")).to_have_text(f"stroke {design['stroke_mm']:.4g}\u00a0mm")


def test_the_mechanism_moves_until_it_is_stopped(opened: Opened) -> None:
    page = opened(reduced_motion="no-preference")
    crank = page.locator(".mechanism .link.crank")
    before = place_of(crank)
    page.wait_for_function(
        "before => document.querySelector('.link.crank').parentElement.getAttribute('transform') !== before", arg=before
    )
    page.get_by_role("button", name="Pause").click()
    stopped = place_of(crank)
    page.wait_for_timeout(150)
    assert place_of(crank) == stopped


def test_it_stands_still_for_who_prefers_reduced_motion(opened: Opened) -> None:
    page = opened()
    before = place_of(page.locator(".mechanism .link.crank"))
    page.wait_for_timeout(150)
    assert place_of(page.locator(".mechanism .link.crank")) == before
    expect(page.get_by_role("button", name="Play")).to_be_visible()


def test_keys_turn_the_crank_by_one_and_by_ten_degrees(opened: Opened) -> None:
    page = opened()
    crank = crank_angle(page)
    for key, angle in (("ArrowRight", 1), ("PageUp", 11), ("ArrowLeft", 10), ("PageDown", 0), ("ArrowDown", 359)):
        crank.press(key)
        assert angle_of(page) == angle, key


def test_the_crank_follows_the_pointer(opened: Opened) -> None:
    page = opened()
    circle = page.locator(".mechanism .handle").bounding_box()
    assert circle is not None
    x, y, r = circle["x"] + circle["width"] / 2, circle["y"] + circle["height"] / 2, 0.4 * circle["width"]
    page.mouse.move(x + r, y)
    page.mouse.down()
    page.mouse.move(x + r * math.cos(2.0), y - r * math.sin(2.0), steps=5)
    page.mouse.up()
    assert angle_of(page) == pytest.approx(math.degrees(2.0), abs=2.0)


def test_pins_are_where_the_api_says(opened: Opened, solved: Solved, service: str) -> None:
    page = opened()
    crank_angle(page).evaluate("(node) => { node.value = 90; node.dispatchEvent(new Event('input')); }")
    curves = httpx.get(f"{service}{solved.path}/designs/3/curves", params={"angles": 360}).json()["curves"]
    row = httpx.get(f"{service}{solved.path}/designs/3").json()["design"]
    (bx, by), (px, py), (ax, ay) = page.locator(".mechanism .pin:visible").evaluate_all(CENTRES)
    unit = (py - ay) / row["crank_mm"]
    assert (ax - px) / unit == pytest.approx(0.0, abs=0.5)
    assert (bx - px) / unit == pytest.approx(curves["slider_position_mm"][90], abs=0.5)
    assert (py - by) / unit == pytest.approx(row["offset_mm"], abs=0.5)


def test_a_chart_moves_the_mechanism_and_the_mechanism_the_cursors(opened: Opened) -> None:
    page = opened()
    chart = page.locator("figure[data-key='torque_Nm'] svg")
    chart.scroll_into_view_if_needed()
    box = chart.bounding_box()
    assert box is not None
    before = place_of(page.locator("figure[data-key='slider_position_mm'] .cursor"))
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert 150 < angle_of(page) < 200
    assert place_of(page.locator("figure[data-key='slider_position_mm'] .cursor")) != before


def test_the_cursor_is_at_the_crank_angle_of_the_axis(opened: Opened) -> None:
    page = opened()
    crank_angle(page).evaluate("(node) => { node.value = 180; node.dispatchEvent(new Event('input')); }")
    chart = page.locator("figure[data-key='slider_velocity_m_s']")
    (cursor,) = chart.locator(".cursor").evaluate_all(CENTRES)
    (tick,) = chart.locator("text", has_text="180°").evaluate_all(CENTRES)
    assert cursor[0] == pytest.approx(tick[0], abs=1.0)


def test_every_chart_says_its_least_and_greatest_value(opened: Opened) -> None:
    page = opened()
    labels = page.locator(".curves figure svg").evaluate_all("nodes => nodes.map(node => node.ariaLabel)")
    assert len(labels) >= 8
    assert all("least" in label and "greatest" in label and "°" in label for label in labels)


def test_least_and_greatest_values_in_the_charts_are_those_of_the_extremes(
    opened: Opened, solved: Solved, service: str
) -> None:
    """To the digits shown, also between the points of the curves; of a change about those of its points."""
    for design in (3, 6):
        page = opened(design)
        found = httpx.get(f"{service}{solved.path}/designs/{design}/analysis", params={"show": "extremes"}).json()
        expect(page.locator(".curves .peak text").first).not_to_contain_text("≈", timeout=20_000)
        told = page.eval_on_selector_all(
            ".curves figure",
            "nodes => nodes.map(n => [n.dataset.key, [...n.querySelectorAll('.peak text')].map(t => t.textContent)])",
        )
        compared = 0
        for key, texts in told:
            name, _, suffix = key.rpartition("_")
            if key.endswith("_m_s"):
                name, suffix = key.removesuffix("_m_s"), "m_s"
            curve = found["analysis"]["extremes"]["curves"].get(name)
            if curve is None or not texts:
                continue
            exact = [curve[f"{end}_{suffix}"] for end in ("least", "greatest")]
            shown = [float(text.replace("\u2212", "-").replace(",", "").replace("\u202f", "")) for text in texts]
            size = max(map(abs, exact))
            assert shown == pytest.approx(exact, rel=6e-4, abs=1e-6 * size), key
            compared += 1
        assert compared >= 3
        page.get_by_role("slider", name="Crank, slider").press("ArrowRight")
        expect(page.locator(".curves .peak text").first).to_contain_text("≈")


def test_forces_are_shown_when_asked_for(opened: Opened) -> None:
    page = opened()
    arrows = page.locator(".mechanism .force")
    expect(arrows.first).to_be_hidden()
    page.get_by_role("checkbox", name="Forces").check()
    crank_angle(page).press("PageUp")
    assert "L" in str(arrows.first.get_attribute("d"))
    expect(page.locator(".legend.forces")).to_contain_text("guide on slider")


def release(page: Page) -> None:
    """Let lengths be moved against the rules that ask for exact values."""
    page.get_by_role("checkbox", name="The other lengths follow").uncheck()


def test_the_other_lengths_follow_to_keep_what_is_asked_exactly(opened: Opened, solved: Solved) -> None:
    page = opened()
    row = solved.result.designs[2]
    page.get_by_label("Rod", exact=True).fill(str(float(row["rod_mm"] or 0.0) * 1.02))
    expect(page.get_by_role("table", name="Objectives before and after the change")).to_be_visible()
    expect(page.locator(".verdict")).not_to_contain_text("stroke")
    assert float(page.get_by_label("Crank", exact=True).input_value()) != pytest.approx(row["crank_mm"], rel=1e-4)
    stroke = page.get_by_role("region", name="All numbers").locator("td[data-design='What if'][data-key='stroke_mm']")
    expect(stroke).to_have_text("280")


def test_a_length_beyond_what_the_rules_allow_shows_how_far_it_reaches_and_both_ways_on(opened: Opened) -> None:
    """A stroke of 280 mm allows no crank above 140 mm."""
    page = opened()
    crank = page.get_by_label("Crank", exact=True)
    stroke = page.get_by_role("region", name="All numbers").locator("td[data-design='What if'][data-key='stroke_mm']")
    crank.fill("150")
    warning = page.locator(".what-if .warning")
    expect(warning).to_contain_text(
        re.compile(r"With stroke 280\smm, the crank reaches 1(39\.\d+|40\.0)\smm, not 150\smm")
    )
    expect(stroke).to_have_text("280")
    page.get_by_role("button", name="Stay at 1").click()
    expect(warning).to_have_count(0)
    assert 139.0 < float(crank.input_value()) <= 140.0
    crank.fill("150")
    page.get_by_role("button", name="Drop stroke 280").click()
    expect(warning).to_have_count(0)
    expect(crank).to_have_value("150")
    expect(page.get_by_role("checkbox", name="The other lengths follow")).not_to_be_checked()
    expect(page.locator(".verdict")).to_contain_text("Misses a requirement: stroke")
    page.get_by_role("button", name="Reset").click()


def test_what_if_shows_what_a_change_does(opened: Opened, solved: Solved, service: str) -> None:
    page = opened()
    release(page)
    row = solved.result.designs[2]
    page.get_by_label("Crank", exact=True).fill(str(float(row["crank_mm"] or 0.0) * 0.98))
    table = page.get_by_role("table", name="Objectives before and after the change")
    expect(table).to_be_visible()
    missed = re.compile(r"Misses a requirement: stroke \S+\xa0mm; must be exactly \S+\xa0mm, \S+\xa0mm more\.")
    expect(page.locator(".verdict")).to_contain_text(missed)
    expect(page.locator(".objectives .panel")).to_contain_text(["misses a requirement"] * len(solved.result.objectives))
    expect(page.locator(".front-map .changed")).to_be_visible()
    lengths = {name: row[name] for name in ("rod_mm", "offset_mm")} | {"crank_mm": float(row["crank_mm"] or 0) * 0.98}
    answer = httpx.post(f"{service}{solved.path}/designs/3/what-if", json=lengths).json()["design"]
    for key, value in table.locator("[data-value]").evaluate_all(NUMBERS):
        assert float(value) == answer[key], key
    assert "crank_mm" in page.url
    page.get_by_role("button", name="Reset").click()
    expect(table).to_have_count(0)
    assert "crank_mm" not in page.url


def test_what_if_says_why_a_linkage_does_not_turn_and_shows_the_design_itself(opened: Opened) -> None:
    page = opened(complaints=("422",))
    release(page)
    ranges = page.get_by_label("Rod", exact=True)
    name, head = page.locator(".objectives .whose"), page.locator("h1")
    ranges.fill(f"{1.01 * float(ranges.input_value()):.6g}")
    expect(head).to_contain_text("Design 3, changed")
    ranges.fill("60")
    expect(page.get_by_role("alert")).to_contain_text("Rod must exceed crank + |offset| for full rotation")
    expect(name).to_have_text("Design 3 itself: the change is not possible")
    expect(head).not_to_contain_text("changed")
    expect(page.get_by_role("figure", name="What if")).to_have_count(0)
    expect(page.locator(".mechanism.faded .link.crank")).to_be_visible()
    page.get_by_role("button", name="Reset").click()
    expect(page.get_by_role("alert")).to_have_count(0)
    expect(page.locator(".mechanism.faded")).to_have_count(0)


def test_a_length_of_what_if_is_typed_as_in_any_other_field(opened: Opened, solved: Solved) -> None:
    page = opened()
    release(page)
    crank = page.get_by_label("Crank", exact=True)
    at = float(solved.result.designs[2]["crank_mm"] or 0.0)
    kept: set[str] = set()
    for typed in (f"{0.99 * at:.4f}".replace(".", ","), f"2*{0.99 * at / 2:.4f}", f"{0.99 * at / 25.4:.8f} in"):
        crank.fill(typed)
        crank.press("Tab")
        expect(page.get_by_role("table", name="Objectives before and after the change")).to_be_visible()
        kept.add(crank.input_value()[:6])
        expect(page.locator(".what-if").get_by_text(f'"{typed}" = ')).to_be_visible()
        page.get_by_role("button", name="Reset").click()
    assert kept == {f"{0.99 * at:.6g}"[:6]}


def test_what_is_no_length_of_what_if_has_no_answer_and_says_why(opened: Opened, solved: Solved) -> None:
    page = opened()
    release(page)
    crank, rod = (page.get_by_label(name, exact=True) for name in ("Crank", "Rod"))
    verdict = page.locator(".verdict")
    table = page.get_by_role("table", name="Objectives before and after the change")
    at = float(solved.result.designs[2]["crank_mm"] or 0.0)
    for typed, sentence in (
        ("0", "above 0; got 0"),
        ("-5", "above 0; got -5"),
        ("", "above 0."),
        ("wide", "not a valid length"),
    ):
        crank.fill(f"{0.99 * at:.4f}")
        expect(table).to_be_visible()
        crank.fill(typed)
        expect(verdict.get_by_role("alert")).to_contain_text(sentence)
        expect(table).to_have_count(0)
        expect(crank).to_have_attribute("aria-invalid", "true")
    rod.fill(str(1.01 * float(rod.input_value())))
    expect(verdict.get_by_role("alert")).to_contain_text("not a valid length")  # the other field is still wrong
    page.get_by_role("button", name="Reset").click()
    expect(crank).to_have_value(f"{at:.6g}")
    expect(verdict.get_by_role("alert")).to_have_count(0)


def test_a_link_shows_the_change_to_somebody_else(opened: Opened, solved: Solved) -> None:
    row = solved.result.designs[2]
    query = f"?crank_mm={float(row['crank_mm'] or 0) * 0.98}&rod_mm={row['rod_mm']}&offset_mm={row['offset_mm']}"
    page = opened(query=query)
    expect(page.get_by_role("table", name="Objectives before and after the change")).to_be_visible()


def test_designs_stand_side_by_side_at_the_same_angle(opened: Opened) -> None:
    page = opened(query="?beside=1,5")
    expect(page.locator(".machine .mechanism")).to_have_count(3)
    crank_angle(page).press("PageUp")
    turns = {str(place_of(crank)).split("rotate")[1] for crank in page.locator(".mechanism .link.crank").all()}
    assert turns == {"(-10.000)"}
    assert page.locator("figure[data-key='torque_Nm'] .curve").count() == 3
    columns = page.get_by_role("region", name="All numbers").locator("thead th").all_inner_texts()
    assert columns == ["Quantity", "Design 3", "Design 1", "change", "Design 5", "change"]
    angles = page.locator(".numbers tr", has=page.get_by_role("link", name="outer dead centre", exact=True))
    assert all(text.endswith("°") for text in angles.locator("td.quiet.number").all_inner_texts())
    ratios = page.locator(".objective").first.locator(".of-other")
    expect(ratios).to_contain_text(["Design 1", "Design 5"])
    expect(ratios.first).to_contain_text(re.compile(r"[▲▼] [+−].*% (better|worse)"))
    requirements = page.get_by_role("region", name="Requirements of the job")
    assert requirements.evaluate("node => node.scrollWidth <= node.clientWidth")  # the whole width is theirs
    page.get_by_label("Remove design 1").click()
    expect(page.locator(".machine .mechanism")).to_have_count(2)
    assert "beside=5" in page.url
    preferred = page.get_by_role("link", name="Prefer Design 5").get_attribute("href")
    assert preferred is not None
    assert re.search(r"wish\.\w+=improve.*wish\.design=5", preferred)


def test_a_design_is_put_beside_by_its_number(opened: Opened) -> None:
    page = opened()
    page.get_by_label("Beside design").fill("4")
    page.get_by_role("button", name="Compare").click()
    expect(page.locator(".machine .mechanism")).to_have_count(2)


def test_sensitivity_comes_when_it_is_scrolled_to_and_missing_tolerances_are_said(opened: Opened) -> None:
    page = opened()
    page.locator(".sensitivity").scroll_into_view_if_needed()
    expect(page.get_by_role("table", name="Change of each quantity")).to_be_visible(timeout=30_000)
    page.locator(".tolerances").scroll_into_view_if_needed()
    expect(page.locator(".tolerances")).to_contain_text("This job has no tolerances")


def test_designs_are_walked_through_by_number(opened: Opened, solved: Solved) -> None:
    page = opened(design=1)
    assert page.get_by_label("Previous design").count() == 0
    page.get_by_label("Next design").click()
    expect(page.get_by_role("heading", level=1)).to_have_text(f"Design 2 of {len(solved.result.designs)}")


def test_designs_are_walked_through_by_the_enter_key_alone(opened: Opened) -> None:
    page = opened(design=1)
    page.get_by_label("Next design").focus()
    for number in (2, 3, 4):
        page.keyboard.press("Enter")
        expect(page.get_by_role("heading", level=1)).to_contain_text(f"Design {number} of")
        expect(page.get_by_label("Next design")).to_be_focused()


@pytest.mark.parametrize(
    ("lengths", "got"),
    [
        ("crank_mm=70&rod_mm=300", "no offset"),
        ("crank_mm=abc&rod_mm=300&offset_mm=20", "“abc” as the crank"),
        ("crank_mm=70&rod_mm=3x&offset_mm=20", "“3x” as the rod"),
    ],
)
def test_a_link_that_gives_no_whole_design_is_answered_so(
    opened: Opened, solved: Solved, lengths: str, got: str
) -> None:
    page = opened()
    page.evaluate("view => { location.hash = view; }", f"{view(solved)}?{lengths}")
    expect(page.locator(".what-if [role=alert]")).to_have_text(
        f"A link must give crank, rod and offset as numbers; got {got}. The design itself is shown."
    )


def test_the_way_back_is_to_the_front_as_it_was_left(opened: Opened, solved: Solved) -> None:
    page = opened()
    front = f"#/jobs/{solved.number}"
    expect(page.locator(".back a")).to_have_attribute("href", front)
    page.evaluate("view => { location.hash = view; }", f"{front}?x=crank_mm")
    expect(page.locator(".design-head")).to_have_count(0)
    page.evaluate("view => { location.hash = view; }", view(solved))
    expect(page.locator(".back a")).to_have_attribute("href", f"{front}?x=crank_mm", timeout=30_000)
    page.evaluate("sessionStorage.clear()")


def exports(page: Page) -> Locator:
    """Return the links of the menu of exports, open or not."""
    return page.get_by_role("navigation", name="Exports").locator("a")


def test_everything_to_take_away_is_linked(opened: Opened, solved: Solved) -> None:
    page = opened()
    links = exports(page)
    design = f"api/v1/jobs/{solved.number}/designs/3"
    assert links.evaluate_all("nodes => nodes.map(node => node.getAttribute('href'))") == [
        *(f"{design}/{name}" for name in ("linkage.dxf", "linkage.svg", "motion.html", "motion.gif")),
        *(f"{design}/{name}" for name in ("report.html", "report.pdf")),
        *(f"api/v1/jobs/{solved.number}/figures/design_3.{kind}" for kind in ("png", "svg")),
    ]


def test_what_is_taken_away_is_the_design_on_the_screen(opened: Opened, solved: Solved, service: str) -> None:
    page = opened()
    links = exports(page)
    bare = links.evaluate_all("nodes => nodes.map(node => node.getAttribute('href'))")
    row = solved.result.designs[2]
    page.get_by_label("Crank", exact=True).fill(str(float(row["crank_mm"] or 0.0) * 0.98))
    expect(page.locator("h1")).to_contain_text("Design 3, changed")
    expect(page.locator(".numbers td[data-design='What if'][data-key='crank_mm']")).to_be_visible()
    shown = dict(page.locator(".numbers td[data-design='What if'][data-value]").evaluate_all(NUMBERS))
    href = links.first.get_attribute("href")
    document = ezdxf.filemanagement.read(io.StringIO(httpx.get(f"{service}/{href}").text))
    skeleton = document.modelspace().query('LINE[layer=="SKELETON"]')
    drawn = sorted((line.dxf.end - line.dxf.start).magnitude for line in skeleton)
    assert drawn == pytest.approx([float(shown["crank_mm"]), float(shown["rod_mm"])], rel=1e-9)
    assert drawn[0] != pytest.approx(row["crank_mm"], rel=1e-3)
    page.get_by_role("navigation", name="Exports").get_by_text("Export", exact=True).click()
    with page.expect_download() as taken:
        page.get_by_role("link", name="Sheet SVG").click()
    expect(page.get_by_role("link", name="Sheet SVG")).not_to_have_attribute("aria-busy", "true")
    assert taken.value.suggested_filename == f"short-test-job-{solved.number}-design-3-changed-sheet.svg"
    for link in links.all():
        assert "crank_mm=" in str(link.get_attribute("href"))
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Reset").click()
    expect(page.locator("h1")).not_to_contain_text("changed")
    assert links.evaluate_all("nodes => nodes.map(node => node.getAttribute('href'))") == bare


def test_a_design_that_is_not_there_is_said(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view(solved, 99), expected=("404",))
    expect(page.get_by_role("main")).to_contain_text("has designs 1 to")
    page.evaluate("location.hash = location.hash.replace('99', 'x')")
    expect(page.get_by_role("main")).to_contain_text("A design must be given by its number")


def test_units_are_the_readers(opened: Opened) -> None:
    page = opened()
    cell = page.locator(".numbers td[data-key='crank_mm']")
    millimetres = float(cell.inner_text())
    page.get_by_label("Units").select_option("inch")
    assert float(cell.inner_text()) == pytest.approx(millimetres / 25.4, rel=1e-4)
    assert float(page.get_by_label("Crank", exact=True).input_value()) == pytest.approx(millimetres / 25.4, rel=1e-4)
    links = exports(page)
    asked = {str(link.get_attribute("href")).rpartition("/")[2] for link in links.all()}
    assert {name for name in asked if name.endswith("?units=inch")} == {
        f"{name}?units=inch"
        for name in (
            "linkage.svg",
            "motion.html",
            "motion.gif",
            "report.html",
            "report.pdf",
            "design_3.png",
            "design_3.svg",
        )
    }


@pytest.mark.slow
def test_nothing_bars_the_way_of_anybody(opened: Opened, solved: Solved) -> None:
    page = opened(query="?beside=5")
    page.get_by_role("checkbox", name="Forces").check()
    row = solved.result.designs[2]
    page.get_by_label("Crank", exact=True).fill(str(float(row["crank_mm"] or 0.0) * 0.98))
    expect(page.get_by_role("table", name="Objectives before and after the change")).to_be_visible()
    page.locator(".sensitivity").scroll_into_view_if_needed()
    expect(page.get_by_role("table", name="Change of each quantity")).to_be_visible(timeout=30_000)
    require_accessible(page)


def test_a_narrow_screen_shows_all_without_scrolling_sideways(opened: Opened, solved: Solved) -> None:
    page = opened(query="?beside=5", viewport=NARROW)
    row = solved.result.designs[2]
    page.get_by_label("Crank", exact=True).fill(str(float(row["crank_mm"] or 0.0) * 0.98))
    expect(page.get_by_role("table", name="Objectives before and after the change")).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= NARROW["width"]


def test_page_api_csv_and_python_have_the_same_numbers(opened: Opened, solved: Solved, service: str) -> None:
    page = opened()
    shown = dict(page.locator(".numbers [data-value]").evaluate_all(NUMBERS))
    of_api = httpx.get(f"{service}{solved.path}/designs/3").json()["design"]
    exported = httpx.get(f"{service}{solved.path}/export.csv").text
    of_csv = list(csv.DictReader(io.StringIO(exported)))[2]
    lengths = np.array([[float(of_csv[name]) / 1e3 for name in ("crank_mm", "rod_mm", "offset_mm")]])
    of_python = analyse(load_job(solved.job).mechanism, lengths).iloc[0]
    assert of_csv.pop("number") == "3"
    assert set(shown) == set(of_api) == set(of_csv)
    for key, value in of_api.items():
        if value is None:
            assert (shown[key], of_csv[key]) in (("", ""), ("", "inf")), key
        elif isinstance(value, str):
            assert shown[key] == of_csv[key] == value
        else:
            assert float(shown[key]) == float(of_csv[key]) == value, key
        if key in of_python and isinstance(value, float):
            # A millimetre is a thousandth of a metre only to rounding, which forces near a jump amplify.
            assert of_python[key] == pytest.approx(value, rel=1e-9, abs=1e-9), key
