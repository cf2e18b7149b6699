"""The whole story of a user without a terminal: from a shipped job to files for CAD and review."""

from __future__ import annotations

import csv
import io
import re
import threading
from pathlib import Path

import ezdxf
import pytest
from playwright.sync_api import Page, expect

from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service.page.conftest import Open


@pytest.mark.slow
def test_from_a_preset_to_drawing_table_report_and_a_link(form: Open, store: Store, tmp_path: Path) -> None:
    page = form(store, "")
    expect(page.get_by_role("heading", name="No runs yet")).to_be_visible()
    page.get_by_role("navigation", name="Main").get_by_role("link", name="New run").click()
    page.get_by_label("Start from an example").select_option("sieve")
    page.get_by_label("stroke, exactly").fill("260")
    page.get_by_label("designs", exact=True).fill("12")
    expect(page.get_by_role("complementary").get_by_role("status")).to_have_text("Ready to start.", timeout=30_000)
    page.get_by_role("button", name="Start the search").click()
    page.wait_for_url("**/#/jobs/1")

    expect(page.get_by_text("Waiting for a worker.")).to_be_visible()
    worker = threading.Thread(target=work, args=(store,), kwargs={"drain": True})
    worker.start()
    expect(page.get_by_text("12 of 12 designs listed")).to_be_visible(timeout=120_000)
    worker.join()
    rows = store.result(1).designs
    assert all(abs(row["stroke_mm"] - 260.0) < 1e-6 for row in rows)  # type: ignore[operator]

    angles = sorted(row["least_transmission_angle_deg"] for row in rows)  # type: ignore[type-var]
    least = round((angles[5] + angles[6]) / 2, 6)  # type: ignore[operator]
    page.locator(".axis-head summary", has_text="least transmission angle").click()
    page.get_by_role("textbox", name="At least least transmission angle").fill(str(least))
    page.get_by_role("textbox", name="At least least transmission angle").press("Enter")
    expect(page.get_by_text("6 of 12 designs listed")).to_be_visible()
    page.wait_for_url(re.compile(r"min\."))
    brushed = page.url
    page.locator("table.designs tbody a").first.click()
    page.wait_for_url("**/designs/*")
    number = int(page.url.split("/designs/")[1].split("?")[0])
    row = rows[number - 1]
    assert row["least_transmission_angle_deg"] >= least  # type: ignore[operator]

    page.get_by_role("checkbox", name="The other lengths follow").uncheck()
    changed = str(round(float(row["rod_mm"] or 0.0) * 1.02, 6))
    page.get_by_label("Rod", exact=True).fill(changed)
    expect(page.locator(".verdict")).to_contain_text("Misses a requirement: stroke")
    page.get_by_role("button", name="Reset").click()

    drawing = ezdxf.readfile(downloaded_file(page, "DXF", tmp_path))  # type: ignore[attr-defined]
    assert not drawing.audit().has_errors
    report = downloaded_file(page, "Report", tmp_path).read_text(encoding="utf-8")
    assert f"design {number}" in report.lower()
    page.goto(brushed)
    expect(page.get_by_text("6 of 12 designs listed")).to_be_visible()
    page.get_by_text("Download", exact=True).click()
    with page.expect_download() as download:
        page.get_by_role("link", name="Designs as CSV").click()
    download.value.save_as(tmp_path / "front.csv")
    table = list(csv.DictReader(io.StringIO((tmp_path / "front.csv").read_text())))
    assert [float(cells["rod_mm"]) for cells in table] == [one["rod_mm"] for one in rows]

    assert page.context.browser is not None
    elsewhere = page.context.browser.new_context().new_page()
    elsewhere.goto(brushed)
    expect(elsewhere.get_by_text("6 of 12 designs listed")).to_be_visible()
    elsewhere.context.close()


def downloaded_file(page: Page, name: str, folder: Path) -> Path:
    """Return a file of the design on the page, downloaded."""
    page.get_by_role("navigation", name="Exports").get_by_text("Export", exact=True).click()
    with page.expect_download() as download:
        page.get_by_role("navigation", name="Exports").get_by_role("link", name=name, exact=True).click()
    page.keyboard.press("Escape")
    file = folder / download.value.suggested_filename
    download.value.save_as(file)
    return file
