"""Kept designs: a what-if outside the job is kept, starred, noted and decided for, beside the front for all."""

from __future__ import annotations

import re
from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Page, expect

from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service.api.fixed_front import API, Solved
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str, str]]:
    """Return a page without errors, the address of its service and that of the job in the API."""
    path = tmp_path_factory.mktemp("kept") / "store.db"
    back_up(solved.store, path)
    with Store(path) as store, watched(pages, store) as (page, address):
        yield page, address, f"{address}{API}/jobs/{solved.number}"


def test_that_nothing_is_kept_is_said_only_after_the_service_has_answered(
    opened: tuple[Page, str, str], solved: Solved
) -> None:
    page, address, api = opened
    for one in httpx.get(f"{api}/kept", timeout=60.0).json()["designs"]:
        httpx.delete(f"{api}/kept/{one['number']}", timeout=60.0).raise_for_status()
    page.route("**/kept", lambda _: None)  # the request waits
    page.goto(f"{address}/#/jobs/{solved.number}")
    expect(page.get_by_role("heading", name="Kept designs")).to_be_visible(timeout=30_000)
    expect(page.get_by_text("None yet.")).to_be_hidden()
    page.unroute("**/kept")
    expect(page.get_by_text("None yet.")).to_be_visible()


@pytest.mark.slow
def test_a_what_if_outside_the_job_is_kept_and_decided_for(opened: tuple[Page, str, str], solved: Solved) -> None:
    page, address, api = opened
    page.goto(f"{address}/#/jobs/{solved.number}/designs/3")
    rod = page.locator("#what-if-rod_mm")
    expect(rod).to_be_visible(timeout=30_000)
    if page.locator(".holding input").count():
        page.locator(".holding input").uncheck()
    rod.fill("650")
    expect(page.locator(".length", has=rod)).to_contain_text("outside the job")
    expect(rod).not_to_have_attribute("aria-invalid", "true")
    expect(page.locator(".verdict")).to_contain_text("Misses a requirement")
    expect(page.locator(".verdict")).to_contain_text("Outside the job: rod 650\xa0mm; must be")
    page.get_by_role("button", name="Keep", exact=True).click()
    asking = page.get_by_role("dialog")
    asking.get_by_label("Name of the design").fill("Long rod")
    asking.get_by_label("Note").fill("from stock")
    asking.get_by_role("button", name="Keep").click()
    expect(page.locator(".standing")).to_contain_text("“Long rod” is kept")
    expect(page.get_by_role("button", name="Add a note")).to_be_focused()  # keys go on from there
    expect(page.locator("h1")).to_contain_text("Long rod")
    page.get_by_role("link", name="beside the front").click()
    line = page.locator(".kept tbody tr")
    expect(line).to_contain_text("Long rod", timeout=30_000)
    expect(line).to_contain_text("outside the job")
    page.get_by_role("button", name="Star of Long rod").press("Enter")
    expect(page.get_by_role("button", name="Star of Long rod")).to_have_attribute("aria-pressed", "true")
    expect(page.get_by_role("button", name="Star of Long rod")).to_be_focused()
    page.get_by_role("button", name="Decide on Long rod").click()
    expect(asking.locator(".bad").first).to_have_text("Misses stroke; outside the job: rod.")
    asking.get_by_label("Reason").fill("the rod is in stock")
    require_accessible(page)
    asking.get_by_role("button", name="Decide nonetheless").click()
    expect(page.locator(".decision")).to_contain_text("Decided: Long rod (the rod is in stock); misses stroke")
    (one,) = httpx.get(f"{api}/kept", timeout=60.0).json()["designs"]
    told = (one["name"], one["note"], one["star"], one["decided"], one["reason"], one["outside"])
    table = page.locator(".kept .scroll")
    assert table.evaluate("node => node.scrollWidth <= node.clientWidth"), "the shortlist fits at 1280 px"
    page.set_viewport_size({"width": 390, "height": 844})
    assert table.evaluate("node => node.scrollWidth <= node.clientWidth"), "and on a phone"
    expect(line.locator("[data-key=time_ratio]")).to_have_css("display", "flex")  # a line of its own, with its title
    require_accessible(page)
    page.set_viewport_size({"width": 1280, "height": 900})
    expect(line).to_contain_text("✓ Decided the rod is in stock")
    assert told == ("Long rod", "from stock", True, True, "the rod is in stock", ["rod_mm"])
    for key in ("time_ratio", "least_transmission_angle_deg", "crank_mm", "rod_mm", "offset_mm"):
        assert float(str(line.locator(f"[data-key={key}]").get_attribute("data-value"))) == one["cells"][key]
    report = page.get_by_role("link", name="Report of the decision").get_attribute("href")
    text = httpx.get(f"{address}/{report}", timeout=120.0).text
    assert "Decided: Long rod (the rod is in stock); misses stroke; outside the job: rod." in text
    assert "note: from stock; misses stroke; outside the job: rod" in text
    assert "This report is about another design." not in text
    other = httpx.get(f"{api}/designs/1/report.html", timeout=120.0).text
    assert "This report is about another design." in other
    page.get_by_role("link", name="Long rod", exact=True).click()
    expect(page.locator("#what-if-rod_mm")).to_have_value("650", timeout=30_000)


def test_notes_and_decisions_of_two_people_stay(opened: tuple[Page, str, str], solved: Solved) -> None:
    page, address, api = opened
    page.goto(f"{address}/#/help")
    first, second = (
        httpx.post(f"{api}/kept", json={"design": n, "name": f"Typed {n}"}, timeout=60.0).json()["number"]
        for n in (4, 5)
    )
    page.goto(f"{address}/#/jobs/{solved.number}")
    page.get_by_role("button", name="Note on Typed 4").click(timeout=30_000)
    asking = page.get_by_role("dialog", name="Note on Typed 4")
    asking.get_by_label("Note", exact=True).press_sequentially("stiff, but")
    for number, change in ((first, {"note": "in stock"}), (second, {"decided": True, "reason": "light"})):
        httpx.patch(f"{api}/kept/{number}", json={**change, "author": "Anna"}, timeout=60.0).raise_for_status()
    with page.expect_response("**/kept") as looked:
        page.evaluate("window.dispatchEvent(new Event('focus'))")
    looked.value.finished()
    asking.get_by_label("Note", exact=True).press_sequentially(" heavy")
    asking.get_by_label("Your name").fill("Ben")
    asking.get_by_role("button", name="Save").click()
    line = page.locator(".kept tr", has_text="Typed 4")
    expect(line.locator("li")).to_contain_text([re.compile("in stock.*Anna"), re.compile("stiff, but heavy.*Ben")])
    expect(page.get_by_role("button", name="Note on Typed 4")).to_be_focused()
    page.get_by_role("button", name="Decide on Typed 4").click()
    asking = page.get_by_role("dialog", name="Decide on Typed 4?")
    expect(asking.locator(".warning")).to_contain_text("replaces the decision for Typed 5 (light), Anna")
    asking.get_by_label("Reason").fill("stiff")
    expect(asking.get_by_label("Your name")).to_have_value("Ben")
    asking.get_by_role("button", name="Replace the decision").click()
    expect(page.locator(".decision")).to_contain_text("Decided: Typed 4 (stiff), Ben, just now")
    page.get_by_role("link", name="Typed 4", exact=True).click()
    standing = page.locator(".standing")
    expect(standing).to_contain_text("✓ Decided (stiff), Ben", timeout=30_000)
    expect(standing.locator("li")).to_have_count(2)
    page.get_by_role("button", name="Withdraw").click()
    page.get_by_role("dialog").get_by_role("button", name="Withdraw").click()
    expect(standing).to_contain_text("“Typed 4” is kept")
    page.get_by_role("link", name="beside the front").click()
    page.get_by_role("button", name="Drop Typed 4").click(timeout=30_000)
    page.get_by_role("dialog", name="Drop Typed 4?").get_by_role("button", name="Drop").click()
    expect(line).to_have_count(0)
    page.get_by_text("History (").click()
    entries = page.locator(".kept details li")
    expect(entries.first).to_contain_text("Typed 4 dropped")
    expect(entries).to_contain_text(["Decision for Typed 4 withdrawn", "Decided on Typed 4: stiff"])
    httpx.delete(f"{api}/kept/{second}", timeout=60.0).raise_for_status()


@pytest.mark.slow
def test_ticked_designs_are_kept_and_the_view_bars_nobody(opened: tuple[Page, str, str], solved: Solved) -> None:
    page, address, api = opened
    before = len(httpx.get(f"{api}/kept", timeout=60.0).json()["designs"])
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{solved.number}?selected=2")
    page.get_by_role("button", name="Keep design 2").click(timeout=30_000)
    expect(page.locator(".kept tbody tr")).to_have_count(before + 1)
    require_accessible(page)
    page.get_by_role("button", name="Search near Design 2").press("Enter")
    page.get_by_role("dialog").get_by_role("button", name="Start the search").press("Enter")
    expect(page).not_to_have_url(re.compile(f"jobs/{solved.number}[?]"))
    near = page.url.split("/jobs/")[1]
    job = httpx.get(f"{address}{API}/jobs/{near}", timeout=60.0).json()
    low, high = (
        float(str(end).split()[0])
        for end in httpx.get(f"{address}{API}/jobs/{near}/job", timeout=60.0).json()["variables"]["rod"]
    )
    rod = float(str(solved.result.designs[1]["rod_mm"]))
    assert job["origin"] == solved.number
    assert (low, high) == pytest.approx((0.9 * rod, 1.1 * rod))
    page.go_back()
    page.get_by_role("button", name="Drop Design 2").click()
    page.get_by_role("dialog").get_by_role("button", name="Drop").click()
    expect(page.locator(".kept tbody tr")).to_have_count(before)
