"""Four uses of the page from end to end: designing, by keyboard alone; studying, deciding together, operating."""

from __future__ import annotations

import contextlib
import csv
import io
import re
import threading
from dataclasses import replace
from pathlib import Path
from urllib.parse import urlsplit

import ezdxf
import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up
from slidercrank.service.workers.worker import work
from tests.service.api.fixed_front import Solved, served
from tests.service.page.conftest import Open, watch
from tests.service.page.test_run import FRONT, TABLES
from tests.service.store.contents import claim_waiting_job, progress

PATIENCE = 60_000.0  # ms, beside other work


def type_over(field: Locator, text: str) -> None:
    """Type over what a field has."""
    field.press("Control+a")
    field.press_sequentially(text)


def downloaded(page: Page, link: Locator, folder: Path) -> Path:
    """Return the file behind a link, which the Enter key takes."""
    with page.expect_download(timeout=PATIENCE) as download:
        link.press("Enter")
    file = folder / download.value.suggested_filename
    download.value.save_as(file)
    return file


@pytest.mark.slow
def test_designing_a_press_from_nothing_to_a_decided_rounded_design_by_keyboard(
    open_page: Open, store: Store, tmp_path: Path
) -> None:
    page = open_page(store, "", reduced_motion="reduce")
    page.get_by_role("navigation", name="Main").get_by_role("link", name="New run").press("Enter")
    type_over(page.get_by_label("name", exact=True), "Press for bushings")
    type_over(page.get_by_label("stroke, exactly"), "60")
    type_over(page.get_by_label("crank, to", exact=True), "=stroke")
    type_over(page.get_by_label("designs", exact=True), "12")
    expect(page.get_by_role("complementary").get_by_role("status")).to_have_text("Ready to start.", timeout=PATIENCE)
    page.get_by_role("button", name="Start the search").press("Enter")
    page.wait_for_url("**/#/jobs/1")
    worker = threading.Thread(target=work, args=(store,), kwargs={"drain": True})
    worker.start()
    expect(page.get_by_text("12 of 12 designs listed")).to_be_visible(timeout=2 * PATIENCE)
    worker.join()
    assert store.job(1).name == "Press for bushings"
    assert store.job_tables(1)["variables"]["crank"][1] == "60 mm"

    page.locator("table.designs tbody a").nth(5).press("Enter")
    page.get_by_label("Crank, step").press("Enter", timeout=PATIENCE)
    page.get_by_role("button", name="Apply round numbers 1", exact=True).press("Enter", timeout=PATIENCE)
    expect(page.locator("#what-if-crank_mm")).to_have_value(re.compile(r"^\d+(\.5)?$"), timeout=PATIENCE)
    page.get_by_role("button", name="Decide on this design").press("Enter", timeout=PATIENCE)
    expect(page.get_by_label("Name of the design")).to_be_focused()
    type_over(page.get_by_label("Name of the design"), "Rounded A")
    page.keyboard.press("Tab")
    page.keyboard.type("round numbers")
    page.keyboard.press("Enter")
    expect(page.locator("h1")).to_contain_text("Rounded A", timeout=PATIENCE)
    expect(page.get_by_role("button", name="Change the reason")).to_be_focused()
    page.get_by_text("Export", exact=True).press("Enter")
    drawing = ezdxf.readfile(  # type: ignore[attr-defined]
        downloaded(page, page.get_by_role("link", name="DXF", exact=True), tmp_path)
    )
    assert not drawing.audit().has_errors
    report = downloaded(page, page.get_by_role("link", name="Report", exact=True), tmp_path)
    assert report.name == "press-for-bushings-1-rounded-a-report.html"
    assert "Press for bushings: Rounded A" in report.read_text(encoding="utf-8")
    page.get_by_role("link", name="beside the front").press("Enter")
    head = page.locator(".run-head")
    expect(head).to_contain_text("Decided: Rounded A (round numbers)", timeout=PATIENCE)
    of_head = downloaded(page, head.get_by_role("link", name="Report of the decision"), tmp_path)
    assert "Press for bushings: Rounded A" in of_head.read_text(encoding="utf-8")
    page.get_by_role("navigation", name="Main").get_by_role("link", name="Runs").press("Enter")
    expect(page.locator("li.run")).to_contain_text("decided for Rounded A", timeout=PATIENCE)
    page.go_back()
    head.get_by_role("link", name="Decided: Rounded A").press("Enter", timeout=PATIENCE)
    expect(page.locator("h1")).to_contain_text("Rounded A", timeout=PATIENCE)


def test_studying_a_published_case_to_a_curve_over_the_slider_position_by_keyboard(
    open_page: Open, solved: Solved, tmp_path: Path
) -> None:
    page = open_page(solved.store, f"#/jobs/{solved.number}", reduced_motion="reduce")
    page.get_by_role("link", name="Open the design of the picture").press("Enter", timeout=PATIENCE)
    page.locator("select[name=over]").press("s", timeout=PATIENCE)  # as "slider position" begins
    expect(page.locator("select[name=over]")).to_have_value("position")
    chart = page.locator("figure[data-key='torque_Nm'] svg")
    expect(chart).to_have_attribute("aria-label", re.compile("over the slider position"), timeout=PATIENCE)
    page.wait_for_url("**over=position*")
    file = downloaded(page, page.get_by_role("link", name="Curves as CSV"), tmp_path)
    rows = list(csv.DictReader(io.StringIO(file.read_text(encoding="utf-8"))))
    places = [float(row["slider_position_mm"]) for row in rows]
    number = int(page.url.split("/designs/")[1].split("?")[0])
    assert max(places) - min(places) == pytest.approx(
        float(str(solved.result.designs[number - 1]["stroke_mm"])), rel=1e-3
    )
    assert all(row["torque_Nm"] for row in rows)


@pytest.mark.slow
def test_deciding_together_in_two_windows_by_keyboard(browser: Browser, solved: Solved, tmp_path: Path) -> None:
    wrong: list[str] = []
    back_up(solved.store, tmp_path / "store.db")
    with (
        Store(tmp_path / "store.db") as store,
        served(store) as address,
        contextlib.closing(browser.new_context(reduced_motion="reduce")) as one,
        contextlib.closing(browser.new_context(reduced_motion="reduce")) as other,
    ):
        mine, theirs = one.new_page(), other.new_page()
        for page in (mine, theirs):
            watch(page, address, wrong)
        mine.goto(f"{address}/#/jobs/{solved.number}?selected=2")
        mine.get_by_role("button", name="Keep design 2").press("Enter", timeout=PATIENCE)
        expect(mine.locator(".kept tbody tr")).to_have_count(1, timeout=PATIENCE)
        theirs.goto(mine.url)  # a link that was sent
        line = theirs.locator(".kept tbody tr")
        expect(line).to_have_count(1, timeout=PATIENCE)
        theirs.get_by_role("button", name="Decide on Design 2").press("Enter")
        type_over(theirs.get_by_label("Reason"), "fits the old frame")
        theirs.keyboard.press("Enter")
        expect(theirs.locator(".decision")).to_contain_text("(fits the old frame)", timeout=PATIENCE)
        expect(mine.locator(".decision")).to_contain_text("Decided: Design 2 (fits the old frame)", timeout=PATIENCE)
        expect(mine.get_by_role("button", name="Star of Design 2")).to_have_attribute("aria-pressed", "true")
    assert wrong == []


@pytest.mark.slow
def test_operating_a_service_that_starts_anew_while_a_run_is_watched_by_keyboard(
    browser: Browser, store: Store, solved: Solved
) -> None:
    wrong: list[str] = []
    submit(store, TABLES)
    claim = claim_waiting_job(store)
    with contextlib.closing(browser.new_context(reduced_motion="reduce")) as context:
        page = context.new_page()
        with served(store) as address:
            watch(page, address, wrong, ("Failed to load resource", "ERR_"))
            page.goto(f"{address}/#/")
            page.get_by_role("link", name=str(TABLES["name"]), exact=True).press("Enter")
            claim.report(progress(1), FRONT)
            expect(page.get_by_text("1 of 9")).to_be_visible(timeout=PATIENCE)
        expect(page.get_by_text("The connection to the service was lost.")).to_be_visible(timeout=PATIENCE)
        claim.report(progress(2), FRONT)
        with served(store, port=int(urlsplit(address).port or 0)):
            expect(page.get_by_text("2 of 9")).to_be_visible(timeout=PATIENCE)
            page.get_by_role("button", name="Stop run 1").press("Enter")
            claim.finish(replace(solved.result, status="cancelled"))
            expect(page.get_by_role("heading", name="Stopped early")).to_be_visible(timeout=PATIENCE)
            page.get_by_role("button", name="Resume run 1").press("Enter")
            expect(page.get_by_role("heading", name="Front so far")).to_be_visible(timeout=PATIENCE)
            again = claim_waiting_job(store)
            again.finish(solved.result)
            expect(page.get_by_text("8 of 8 designs listed")).to_be_visible(timeout=PATIENCE)
            page.go_back()
            expect(page.get_by_role("listitem")).to_contain_text("done")
    assert wrong == []
