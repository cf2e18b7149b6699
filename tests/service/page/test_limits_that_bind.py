"""Limits that bind: said beside the front, widened by a new run over the front before."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Page, expect

from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up
from slidercrank.service.workers.worker import work
from tests.service.api.fixed_front import API, Solved
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str, Store]]:
    """Return a page, the address of its service and its store; nothing but refusals may go wrong on the page."""
    path = tmp_path_factory.mktemp("limits") / "store.db"
    back_up(solved.store, path)
    with Store(path) as store, watched(pages, store, expected=("422",)) as (page, address):
        yield page, address, store


@pytest.mark.slow
def test_a_limit_that_binds_is_widened_and_the_front_before_stays_behind(
    opened: tuple[Page, str, Store], solved: Solved
) -> None:
    page, address, store = opened
    limits = httpx.get(f"{address}{API}/jobs/{solved.number}/binding", timeout=60.0).json()["limits"]
    page.goto(f"{address}/#/jobs/{solved.number}")
    lines = page.locator(".binding .limit")
    expect(lines).to_have_count(len(limits), timeout=30_000)
    for line, limit in zip(lines.all(), limits, strict=True):
        count = len(limit["designs"])
        expect(line).to_contain_text(
            f"{count} of 8 designs {'is' if count == 1 else 'are'} at the limit {limit['title']}"
        )
        line.get_by_role("button", name="Show the designs").click()
        expect(page.locator(".count")).to_have_text(f"{count} of 8 designs listed")
        page.get_by_role("button", name="Clear all limits").click()
    line = page.locator("[data-limit='constraints.transmission_angle.lower']")
    expect(line.get_by_role("textbox")).to_have_value("36")
    require_accessible(page)
    refused = {
        "": "a number in ° is needed",
        "wide": "“wide” is not a valid angle",
        "45": "must be below 40°; got 45",
    }
    for typed, said in refused.items():
        line.get_by_role("textbox").fill(typed)
        line.get_by_role("textbox").press("Enter")
        expect(page.locator(".binding [role=alert]")).to_contain_text(said)
    line.get_by_role("textbox").fill("35")
    line.get_by_role("textbox").press("Enter")
    page.wait_for_url(f"**/#/jobs/{solved.number + 1}*")
    work(store, drain=True)
    expect(page.locator(".run-head")).to_contain_text(f"changed from run {solved.number}", timeout=30_000)
    behind = page.locator(".before")
    expect(behind).to_contain_text(f"Behind it: the front of run {solved.number}", timeout=30_000)
    dots = page.locator(".dots canvas").first
    drawn = dots.evaluate("canvas => canvas.toDataURL()")
    behind.get_by_role("checkbox").uncheck()
    page.wait_for_url("**behind=none*")
    assert dots.evaluate("canvas => canvas.toDataURL()") != drawn
    expect(behind.get_by_role("link")).to_have_attribute(
        "href", f"#/compare?jobs={solved.number}%2C{solved.number + 1}"
    )
