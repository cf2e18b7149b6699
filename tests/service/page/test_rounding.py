"""Round numbers in the view of a design: applied by one click, wrong steps said at their fields."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from pathlib import Path
from threading import Event
from typing import Any

import httpx
import pytest
from playwright.sync_api import Page, expect

from slidercrank.optimise.front.rounding_search import RoundingSearch, Stage
from tests.service.api.fixed_front import API, Solved, varied_in
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched

DESIGN = 3
LENGTHS = ("crank_mm", "rod_mm", "offset_mm")


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved) -> Iterator[tuple[Page, str]]:
    """Return one page for all tests here, of which nothing may go wrong but refusals, and its address."""
    with watched(pages, solved.store, expected=("422",)) as (page, address):
        page.goto(f"{address}/#/help")
        yield page, address


@pytest.fixture
def page(opened: tuple[Page, str], solved: Solved) -> Page:
    """Return the view of a design as if for the first time."""
    page, _ = opened
    page.evaluate("localStorage.clear(); location.hash = '#/help'")
    expect(page.locator(".rounding")).to_have_count(0)
    page.evaluate("view => { location.hash = view; }", f"#/jobs/{solved.number}/designs/{DESIGN}")
    page.get_by_role("heading", name="Round it").wait_for()
    return page


def asked_of(address: str, number: int, design: int, **body: object) -> list[dict[str, Any]]:
    """Return the rounded designs that the API gives."""
    path = f"{address}{API}/jobs/{number}/designs/{design}/rounded"
    found = httpx.post(path, json={"count": 5, **body}, timeout=60.0).json()["rounded"]
    return list(found["designs"])


def test_round_numbers_are_those_of_the_api_with_every_miss_as_a_number(
    page: Page, opened: tuple[Page, str], solved: Solved
) -> None:
    page.get_by_label("Rod, step").fill("1")
    expect(page.get_by_label("Stroke, allowed deviation")).to_have_value("0.05")
    page.get_by_label("Stroke, allowed deviation").fill("")
    page.get_by_label("Rod, step").press("Enter")
    lines = page.get_by_role("table", name="Round numbers").locator("tbody tr")
    steps = ["crank=0.5 mm", "rod=1 mm", "offset=0.5 mm"]
    expected = asked_of(opened[1], solved.number, DESIGN, to=steps)
    expect(lines).to_have_count(len(expected), timeout=30_000)
    for line, row in zip(lines.all(), expected, strict=True):
        for key in (*LENGTHS, "time_ratio", "least_transmission_angle_deg"):
            assert float(str(line.locator(f"[data-key={key}]").get_attribute("data-value"))) == row[key]
        (miss,) = row["misses"]
        shown = line.locator("[data-miss=stroke]")
        assert float(str(shown.get_attribute("data-value"))) == miss["amount"] > 0.0
        expect(shown).to_contain_text("mm too low" if miss["side"] == "below" else "mm too high")
    expect(page.locator(".rounding")).to_contain_text("allow a miss of stroke")
    page.get_by_label("Stroke, allowed deviation").fill("0,1")
    page.get_by_label("Stroke, allowed deviation").press("Enter")
    expect(page.locator(".rounding")).to_contain_text("keep every requirement within 0.1 mm of stroke")
    expected = asked_of(opened[1], solved.number, DESIGN, to=steps, allow=["stroke=0.1 mm"])
    expect(lines).to_have_count(len(expected))
    for line, row in zip(lines.all(), expected, strict=True):
        assert float(str(line.locator("[data-miss]").get_attribute("data-value"))) == row["misses"][0]["amount"]
        expect(line.locator("[data-miss]")).to_contain_text(", 0.1 mm allowed")


def test_applying_one_keeps_the_list_and_the_steps(page: Page, opened: tuple[Page, str], solved: Solved) -> None:
    page.get_by_label("Rod, step").fill("2")
    page.get_by_label("Stroke, allowed deviation").fill("0.2")
    page.get_by_label("Rod, step").press("Enter")
    lines = page.get_by_role("table", name="Round numbers").locator("tbody tr")
    steps = ["crank=0.5 mm", "rod=2 mm", "offset=0.5 mm"]
    expected = asked_of(opened[1], solved.number, DESIGN, to=steps, allow=["stroke=0.2 mm"])
    expect(lines).to_have_count(len(expected), timeout=30_000)
    for number in (2, 1):
        page.get_by_role("button", name=f"Apply round numbers {number}", exact=True).click()
        for key in LENGTHS:
            expect(page.locator(f"#what-if-{key}")).to_have_value(f"{expected[number - 1][key]:.6g}", timeout=30_000)
        expect(page.locator(".what-if .verdict")).to_contain_text("mm, within the allowed ±0.2 mm.")
        expect(page.locator(".objectives")).not_to_contain_text("misses")
        expect(lines).to_have_count(len(expected))
        expect(page.get_by_label("Rod, step")).to_have_value("2")
        expect(page.get_by_label("Stroke, allowed deviation")).to_have_value("0.2")
        expect(page).to_have_url(re.compile(f"rod_mm={expected[number - 1]['rod_mm']:g}.*allow=stroke_mm%3D0.2"))
    page.get_by_role("button", name="Decide on this design").press("Enter")
    expect(page.get_by_role("dialog")).to_contain_text("within the allowed ±0.2 mm.")
    expect(page.get_by_role("dialog").get_by_role("button", name="Decide", exact=True)).to_be_visible()
    page.get_by_role("dialog").press("Escape")


def test_the_search_shows_its_progress_and_can_be_stopped(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    ended = Event()

    def endless(self: RoundingSearch, count: int) -> Iterator[Stage]:
        try:
            while True:
                time.sleep(0.01)
                yield Stage("screening combinations", count, 10)
        finally:
            ended.set()

    monkeypatch.setattr(RoundingSearch, "best_designs", endless)
    page.get_by_role("button", name="Find round numbers").press("Enter")
    expect(page.locator(".rounding .searching")).to_contain_text("Screening combinations: 5 of 10")
    assert page.get_by_role("progressbar", name="Progress of the search").evaluate("bar => bar.position") == 0.5
    page.get_by_role("button", name="Stop").press("Enter")
    expect(page.locator(".rounding")).to_contain_text("Stopped.")
    expect(page.get_by_role("button", name="Find round numbers")).to_be_enabled()
    assert ended.wait(10.0)


def test_wrong_steps_are_said_at_their_fields(page: Page) -> None:
    step = page.get_by_label("Crank, step")
    step.press("Enter")
    expect(page.get_by_role("table", name="Round numbers")).to_be_visible(timeout=30_000)
    for typed, sentence in (
        ("0", "must be a length above 0"),
        ("-1", "must be a length above 0"),
        ("1/0", "divides by zero"),
        ("wide", "must be a length above 0"),
    ):
        step.fill(typed)
        step.press("Enter")
        expect(page.locator("#step-crank_mm-wrong")).to_contain_text(sentence)
        expect(step).to_have_attribute("aria-invalid", "true")
        expect(page.get_by_role("table", name="Round numbers")).to_have_count(0)  # that of another step
    for name in ("Crank, step", "Rod, step", "Offset, step"):
        page.get_by_label(name).fill("")
    step.press("Enter")
    expect(page.locator(".rounding [role=alert]")).to_contain_text("No number has a step")


def test_rounding_bars_the_way_of_nobody(page: Page) -> None:
    page.get_by_label("Units").select_option("inch")
    expect(page.get_by_label("Crank, step")).to_have_value("1/64")
    page.get_by_role("button", name="Find round numbers").press("Enter")
    expect(page.get_by_role("table", name="Round numbers")).to_be_visible(timeout=30_000)
    require_accessible(page)


def test_a_rounded_width_is_applied_kept_in_the_address_taken_back_and_typed(pages: Pages, tmp_path: Path) -> None:
    with varied_in(tmp_path) as (store, number), watched(pages, store) as (page, address):
        page.goto(f"{address}/#/jobs/{number}/designs/2")
        page.get_by_label("Rod width, step").fill("7")
        page.get_by_label("Stroke, allowed deviation").fill("0.1")
        page.get_by_label("Rod width, step").press("Enter")
        button = page.get_by_role("button", name="Apply round numbers 1", exact=True)
        button.click(timeout=30_000)
        expected = asked_of(address, number, 2, to=["0.5 mm", "rod_width_mm=7 mm"], allow=["stroke=0.1 mm"], count=1)[0]
        width = f"{expected['rod_width_mm']:g}"
        changed = page.locator(".what-if").get_by_label("Rod width", exact=True)
        expect(changed).to_have_value(width)
        torque = page.locator(".what-if [data-key=peak_torque_Nm]")
        expect(torque).to_have_attribute("data-value", re.compile(f"^{expected['peak_torque_Nm']:.7g}"[:-1]))
        page.reload()
        expect(changed).to_have_value(width)
        expect(page.get_by_role("link", name="Curves as CSV")).to_have_attribute(
            "href", re.compile(f"value=rod_width_mm%3D{width}")
        )
        page.get_by_role("button", name="Reset").click()
        expect(changed).not_to_have_value(width)
        expect(page).not_to_have_url(re.compile("rod_width"))
        changed.fill(width)
        expect(torque).to_have_attribute("data-key", "peak_torque_Nm")
        expect(page).to_have_url(re.compile(f"rod_width_mm%3D{width}"))
