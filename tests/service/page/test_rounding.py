"""Round numbers in the view of a design: applied by one click, wrong steps said at their fields."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Page, expect

from tests.service.api.fixed_front import API, Solved
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


def test_round_numbers_are_those_of_the_api_and_can_be_applied(
    page: Page, opened: tuple[Page, str], solved: Solved
) -> None:
    page.get_by_label("Rod, step").fill("1")
    page.get_by_label("Rod, step").press("Enter")
    lines = page.get_by_role("table", name="Round numbers").locator("tbody tr")
    path = f"{opened[1]}{API}/jobs/{solved.number}/designs/{DESIGN}/rounded"
    body = {"to": ["crank=0.5 mm", "rod=1 mm", "offset=0.5 mm"], "count": 5}
    expected = httpx.post(path, json=body, timeout=60.0).json()["rounded"]["designs"]
    expect(lines).to_have_count(len(expected), timeout=30_000)
    for line, row in zip(lines.all(), expected, strict=True):
        for key in (*LENGTHS, "time_ratio", "least_transmission_angle_deg"):
            assert float(str(line.locator(f"[data-key={key}]").get_attribute("data-value"))) == row[key]
    page.get_by_role("link", name="Apply round numbers 1", exact=True).click()
    for key in LENGTHS:
        expect(page.locator(f"#what-if-{key}")).to_have_value(f"{expected[0][key]:.6g}", timeout=30_000)


def test_wrong_steps_are_said_at_their_fields(page: Page) -> None:
    step = page.get_by_label("Crank, step")
    step.press("Enter")
    expect(page.get_by_role("table", name="Round numbers")).to_be_visible(timeout=30_000)
    for typed, sentence in (
        ("0", "is a length above 0"),
        ("-1", "is a length above 0"),
        ("1/0", "divides by zero"),
        ("wide", "is a length above 0"),
    ):
        step.fill(typed)
        step.press("Enter")
        expect(page.locator("#step-crank_mm-wrong")).to_contain_text(sentence)
        expect(step).to_have_attribute("aria-invalid", "true")
        expect(page.get_by_role("table", name="Round numbers")).to_have_count(0)  # that of another step
    for name in ("Crank, step", "Rod, step", "Offset, step"):
        page.get_by_label(name).fill("")
    step.press("Enter")
    expect(page.locator(".rounding [role=alert]")).to_contain_text("No length has a step")


def test_rounding_bars_the_way_of_nobody(page: Page) -> None:
    page.get_by_label("Units").select_option("inch")
    expect(page.get_by_label("Crank, step")).to_have_value("1/64")
    page.get_by_role("button", name="Find round numbers").press("Enter")
    expect(page.get_by_role("table", name="Round numbers")).to_be_visible(timeout=30_000)
    require_accessible(page)
