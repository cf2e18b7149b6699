"""Wishes beside the front: the numbers of the API, on the charts, in a link, from the history."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from playwright.sync_api import Locator, Page, expect

from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service.api.fixed_front import API, Solved
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str]]:
    """Return one page for all tests here, of which nothing may go wrong but refusals, and its address."""
    path = tmp_path_factory.mktemp("wishing") / "store.db"
    back_up(solved.store, path)
    with Store(path) as store, watched(pages, store, expected=("422",)) as (page, address):
        page.goto(f"{address}/#/help")
        yield page, address


@pytest.fixture
def page(opened: tuple[Page, str], solved: Solved) -> Page:
    """Return the front as if for the first time."""
    page, _ = opened
    page.evaluate("localStorage.clear(); sessionStorage.clear(); location.hash = '#/help'")
    expect(page.locator(".wishing")).to_have_count(0)
    page.evaluate("view => { location.hash = view; }", f"#/jobs/{solved.number}")
    page.locator(".wishing").wait_for()
    return page


def panel(page: Page) -> Locator:
    return page.get_by_role("region", name="Choose by wishing")


def wish(page: Page, objective: str, kind: str, value: str = "") -> None:
    panel(page).get_by_label(objective, exact=True).select_option(kind)
    if value:
        panel(page).get_by_label(f"Value for {objective}").fill(value)


def solve(page: Page) -> dict[str, Any]:
    """Ask for the wished design, and return the answer of the service."""
    with page.expect_response("**/wish") as answered:
        panel(page).get_by_role("button", name="Solve").click()
    found: dict[str, Any] = answered.value.json()
    return found


def test_the_wished_design_is_that_of_the_api_and_opens(page: Page, opened: tuple[Page, str], solved: Solved) -> None:
    wish(page, "time ratio", "should reach", "1,3")
    wish(page, "least transmission angle", "should reach", "50")
    solve(page)
    at = {"time_ratio": "1.3", "transmission_angle": "50 deg"}
    expected = httpx.post(f"{opened[1]}{API}/jobs/{solved.number}/wish", json={"at": at}, timeout=60.0).json()
    for one in expected["objectives"]:
        cell = panel(page).locator(f"td[data-key={one['quantity']}]").first
        assert float(str(cell.get_attribute("data-value"))) == one["reached"]
    page.wait_for_url(re.compile(r"wish\.time_ratio=1\.3"))
    page.reload()  # as whoever gets the link sees it
    panel(page).get_by_role("link", name="Open the resulting design").click()
    expect(page.locator(".what-if .verdict")).to_contain_text(
        "No listed design is better in every objective.", timeout=30_000
    )
    for one in expected["objectives"]:
        cell = page.locator(f".before-after td[data-key={expected['columns'][_place(expected, one)]['key']}]")
        assert float(str(cell.get_attribute("data-value"))) == pytest.approx(one["reached"], rel=1e-9)


def _place(answer: dict[str, Any], outcome: dict[str, Any]) -> int:
    """Return the place of the column of an objective."""
    return next(place for place, one in enumerate(answer["columns"]) if one["title"] == outcome["title"])


def test_classes_speak_of_a_design_and_wishes_of_anybody_come_back(
    page: Page, opened: tuple[Page, str], solved: Solved
) -> None:
    made = {"at": {"time_ratio": "1.22", "transmission_angle": "50 deg"}}  # in another window
    httpx.post(f"{opened[1]}{API}/jobs/{solved.number}/wish", json=made, timeout=60.0)
    wish(page, "time ratio", "improves")
    page.get_by_label("refer to design").fill("3")
    wish(page, "least transmission angle", "may worsen to", "41")
    first = solve(page)
    assert first["number"] == 3
    assert first["objectives"][0]["reached"] > first["objectives"][0]["before"]
    wish(page, "time ratio", "should reach", "1.25")
    wish(page, "least transmission angle", "is free")
    solve(page)
    panel(page).get_by_text("Wishes so far").click()
    told = panel(page).locator(".wish-history li")
    for place, words in enumerate(("time ratio 1.25", "time ratio improves", "time ratio 1.22, least transmission")):
        expect(told.nth(place)).to_contain_text(words)
    with page.expect_response("**/wish") as answered:
        panel(page).get_by_role("button", name="time ratio improves").first.click()
    assert answered.value.json()["design"] == first["design"]
    expect(panel(page).get_by_label("Value for least transmission angle")).to_have_value("41")
    panel(page).get_by_role("button", name="Clear wishes").click()
    expect(panel(page).get_by_role("link", name="Open the resulting design")).to_have_count(0)


def test_what_cannot_be_wished_is_said_at_its_field(page: Page) -> None:
    button = panel(page).get_by_role("button", name="Solve")
    alert = panel(page).get_by_role("alert")
    button.click()
    expect(alert).to_contain_text("There is no wish yet")
    wish(page, "time ratio", "should reach", "fast")
    button.click()
    value = panel(page).get_by_label("Value for time ratio")
    expect(value).to_have_attribute("aria-invalid", "true")
    expect(panel(page).locator("#wish-time_ratio-wrong")).to_contain_text("A number is needed here")
    wish(page, "time ratio", "improves")
    page.get_by_label("refer to design").fill("99")
    button.click()
    expect(panel(page).locator("#wish-design-wrong")).to_contain_text("give its number, 1 to 8")
    page.get_by_label("refer to design").fill("3")
    wish(page, "least transmission angle", "keeps")
    button.click()
    expect(alert).to_contain_text("Nothing can improve unless another objective is freed or allowed to worsen")
    wish(page, "least transmission angle", "may worsen to", "89")
    button.click()
    expect(panel(page).locator("#wish-transmission_angle-wrong")).to_contain_text("better; write only the value")


def test_a_wish_is_solved_at_once_after_one_that_was_refused_or_is_on_its_way(page: Page) -> None:
    value = panel(page).get_by_label("Value for time ratio")
    reached = panel(page).locator("td[data-key=time_ratio]").locator("xpath=preceding-sibling::td")
    wish(page, "time ratio", "should reach", "1e300")
    panel(page).get_by_role("button", name="Solve").click()
    expect(value).to_have_attribute("aria-invalid", "true")
    value.press("ControlOrMeta+a")
    page.keyboard.type("2*0,65")
    panel(page).get_by_role("button", name="Solve").click()  # pressed and let go at one place
    expect(reached).to_have_text("1.3", timeout=30_000)
    for typed in ("1.25", "1.35"):
        value.fill(typed)
        value.press("Enter")
    expect(reached).to_have_text("1.35", timeout=30_000)


def test_wishing_bars_the_way_of_nobody(page: Page) -> None:
    panel(page).get_by_label("time ratio", exact=True).focus()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Tab")
    page.keyboard.type("1.2")
    with page.expect_response("**/wish"):
        page.keyboard.press("Enter")
    expect(panel(page).get_by_role("link", name="Open the resulting design")).to_be_visible()
    require_accessible(page)
