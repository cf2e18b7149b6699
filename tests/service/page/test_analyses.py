"""Analyses of a design, a tab each: those of the API, by keyboard, and of a changed design."""

from __future__ import annotations

import re
from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Page, expect

from tests.service.api.fixed_front import API, Solved
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched

OWN = ("extremes", "sensitivity", "tolerances", "inverse", "round", "wish")
"""Questions with a place of their own."""


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved) -> Iterator[tuple[Page, str]]:
    """Return a page and the address of its service; nothing but refusals may go wrong on the page."""
    with watched(pages, solved.store, expected=("422",)) as found:
        yield found


def number_on_page(number: str) -> str:
    """Return a number of the command as the page writes it: 1.3e-26 is 1.3·10⁻²⁶."""
    power = re.compile(r"e([-+]?)0?(\d+)")
    raised = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
    text = power.sub(lambda found: f"·10{(found[1].strip('+') + found[2]).translate(raised)}", number)
    return text.replace("-", "−")


@pytest.mark.slow
def test_every_analysis_has_a_tab_with_what_the_api_tells(opened: tuple[Page, str], solved: Solved) -> None:
    page, address = opened
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2")
    panel = page.get_by_role("tabpanel")
    panel.scroll_into_view_if_needed(timeout=30_000)
    listed = httpx.get(f"{address}{API}/topics", timeout=60.0).json()
    questions = [one for one in (*listed["topics"], *listed["questions"]) if one["name"] not in OWN]
    path = f"{address}{API}/jobs/{solved.number}/designs/2/requirements"
    lacking = httpx.get(path, timeout=60.0).json()["lacking"]
    fitting = [one for one in questions if one["name"] not in lacking]
    fitting.sort(key=lambda one: not one["premise"] or not one["path"].startswith("topics/"))
    fronts = [one["title"] for one in listed["fronts"] if one["name"] not in OWN]
    expect(page.get_by_role("tablist", name="Analyses", exact=True).get_by_role("tab")).to_have_text(
        [*(one["title"] for one in fitting), *fronts]
    )
    absent = [f"{one['title']} needs {one['premise']}" for one in questions if one["name"] in lacking]
    assert "Start from rest needs a motor" in absent
    page.get_by_text(f"{len(absent)} for other machines").click()
    expect(page.get_by_role("tablist", name="Analyses for other machines").get_by_role("tab")).to_have_text(absent)
    page.get_by_role("tab", name="Motor", exact=True).click()
    path = f"{address}{API}/jobs/{solved.number}/designs/2/topics"
    told = httpx.get(f"{path}/motor", timeout=60.0).json()["told"]
    for block in told:
        for row in block["rows"]:
            expect(panel.locator("tr", has_text=row[0]).first).to_contain_text(number_on_page(row[1]))
    picture = page.get_by_role("img", name="Figure: Motor")
    expect(picture).to_have_js_property("complete", True, timeout=30_000)
    assert picture.evaluate("image => image.naturalWidth") > 100
    require_accessible(page)
    page.get_by_role("tab", name="Motor", exact=True).press("ArrowRight")
    following = page.get_by_role("tab", selected=True)
    expect(following).to_be_focused()
    expect(following).to_have_text("Shaking forces")
    page.get_by_role("tab", name="Start from rest").click()
    expect(panel).to_contain_text("give it under “Motor and flywheel”. Change the job")
    expect(panel.locator("img")).to_have_count(0)


@pytest.mark.slow
def test_the_analysis_follows_a_changed_design(opened: tuple[Page, str], solved: Solved) -> None:
    page, address = opened
    page.goto(f"{address}/#/help")
    row = solved.result.designs[1]
    lengths = {key: float(str(row[key])) for key in ("crank_mm", "rod_mm", "offset_mm")} | {"rod_mm": 590.0}
    query = "&".join(f"{key}={value!r}" for key, value in lengths.items())
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2?{query}")
    panel = page.get_by_role("tabpanel")
    panel.scroll_into_view_if_needed(timeout=30_000)
    page.get_by_role("tab", name="Motor", exact=True).click()
    expect(panel).to_contain_text("for the changed design")
    path = f"{address}{API}/jobs/{solved.number}/designs/2/topics/motor"
    told = httpx.get(path, params=lengths, timeout=60.0).json()["told"]
    expect(panel.locator("tr", has_text="peak torque").first).to_contain_text(told[1]["rows"][0][1])
    page.wait_for_url(re.compile("tab=motor"))
    panel.evaluate("node => node.scrollIntoView()")
    page.wait_for_function("() => history.state?.top === Math.round(scrollY) && scrollY > 500")
    page.reload()
    before = page.evaluate("history.state.top")
    assert before > 500
    expect(page.get_by_role("tab", selected=True)).to_have_text("Motor", timeout=30_000)
    page.wait_for_function(f"() => Math.abs(scrollY - {before}) <= 2", timeout=30_000)
    page.evaluate("location.hash = '#/help'")  # as by a bookmark: a link at the top is reached by going there
    expect(page.get_by_role("heading", level=1)).to_have_text("Help")
    assert page.evaluate("scrollY") == 0
    page.go_back()
    page.wait_for_function(f"() => Math.abs(scrollY - {before}) <= 2", timeout=30_000)
    page.get_by_label("Next design").press("Enter")
    page.wait_for_url(re.compile(r"designs/3\?tab=motor"))


@pytest.mark.slow
def test_analyses_are_told_in_inches_and_the_flywheel_for_the_fluctuation_that_is_typed(
    opened: tuple[Page, str], solved: Solved
) -> None:
    page, address = opened
    page.goto(f"{address}/#/help")
    page.get_by_label("Units").select_option("inch")
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2?tab=flywheel")
    panel = page.get_by_role("tabpanel")
    panel.scroll_into_view_if_needed(timeout=30_000)
    path = f"{address}{API}/jobs/{solved.number}/designs/2/topics/flywheel"

    def first(**asked: float) -> str:
        answer = httpx.get(path, params={"units": "inch", **asked}, timeout=60.0).json()
        return str(answer["told"][0]["sentence"])

    assert re.search(r"speed fluctuation of 0\.02: [\d.]+ lb in² ", first())
    expect(panel).to_contain_text(first(), timeout=30_000)
    field = panel.get_by_label("Maximum speed fluctuation")
    field.fill("0,05")
    field.press("Enter")
    expect(panel).to_contain_text(first(fluctuation=0.05), timeout=30_000)
    expect(field).to_be_focused()
    expect(panel.locator("img")).to_have_attribute("src", re.compile("units=inch&fluctuation=0.05"))
    field.fill("2")
    field.press("Enter")
    expect(panel).to_contain_text("Fluctuation must be below 1; got 2; correct it", timeout=30_000)
    field.fill("2 kg")
    field.press("Enter")
    expect(panel.get_by_role("alert")).to_have_text("“2 kg” is not a valid number; write a number.")
    refused = httpx.get(path.replace("flywheel", "motor"), params={"fluctuation": 0.05}, timeout=60.0)
    assert (
        refused.status_code,
        "the topic motor has no inputs; got fluctuation; leave" in refused.text,
    ) == (422, True)
    page.evaluate("localStorage.clear()")


@pytest.mark.slow
def test_heads_in_inches_have_their_units_after_commas(opened: tuple[Page, str], solved: Solved) -> None:
    page, address = opened
    page.goto(f"{address}/#/help")
    page.get_by_label("Units").select_option("inch")
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2?tab=static_forces")
    panel = page.get_by_role("tabpanel")
    panel.scroll_into_view_if_needed(timeout=30_000)
    heads = panel.get_by_role("columnheader")
    forces = ["load, lbf", "rod force, lbf", "guide, lbf", "crank torque, lbf in"]
    expect(heads).to_have_text(["crank angle, deg", *forces, "mechanical advantage"], timeout=30_000)
    page.get_by_role("tab", name="Textbook formulas").click()
    parts = [f"{percent} %" for percent in (0, 25, 50, 75, 100)]
    expect(heads).to_have_text(["model", "peak", "unit", "error", *parts], timeout=30_000)
    page.evaluate("localStorage.clear()")


def test_what_is_printed_is_whole(opened: tuple[Page, str], solved: Solved) -> None:
    page, address = opened
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{solved.number}/designs/4")
    page.evaluate("() => { window.print = () => { window.left = document.querySelectorAll('.busy').length; }; }")
    page.get_by_role("button", name="Print").press("Enter", timeout=30_000)  # nothing was scrolled into sight
    page.wait_for_function("() => window.left !== undefined", timeout=60_000)
    assert page.evaluate("window.left") == 0
    page.emulate_media(media="print")
    expect(page.get_by_role("heading", name="Sensitivity")).to_be_visible()
    assert page.locator(".analysis img").evaluate("image => image.complete && image.naturalWidth") > 100
    expect(page.get_by_role("button")).to_have_count(0)
    page.goto(f"{address}/#/jobs/{solved.number}")
    expect(page.get_by_role("columnheader", name="time ratio")).to_contain_text("time ratio", timeout=30_000)
    expect(page.locator("table.designs tbody tr")).to_have_count(len(solved.result.designs))
    page.emulate_media(media="screen")
