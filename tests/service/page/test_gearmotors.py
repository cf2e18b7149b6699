"""A pusher with six gearmotors on the page: a pasted catalogue, the least motor that serves, and round numbers."""

from __future__ import annotations

import json
import re
import threading

import pytest
from playwright.sync_api import expect

from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service.page.conftest import Open, ready
from tests.service.test_three_stories import CATALOGUE, MOTORS, SEARCH, STORIES, cheapest, peak_torque, stroke

TABLES = {
    **{key: part for key, part in STORIES["pusher"].tables.items() if key != "choice"},
    "objectives": {"peak_torque": "minimise", "stroke": "maximise"},
    "optimiser": SEARCH,
}


@pytest.mark.slow
def test_a_pusher_comes_from_a_pasted_catalogue_to_round_numbers_that_its_motor_drives(
    open_page: Open, store: Store
) -> None:
    story = STORIES["pusher"]
    page = open_page(store, "#/new", reduced_motion="reduce")
    ready(page)
    content = json.dumps(TABLES).encode()
    page.locator("#job-import").set_input_files({"name": "own.json", "mimeType": "application/json", "buffer": content})
    page.get_by_text("Catalogues to choose from").click()
    page.get_by_role("button", name="Add a catalogue").click()
    page.get_by_role("group", name="Catalogue 1").get_by_role("textbox").last.fill(CATALOGUE)
    expect(page.get_by_text("6 rows.")).to_be_visible()
    ready(page)
    page.get_by_role("button", name="Start the search").click()
    page.wait_for_url("**/#/jobs/1")
    worker = threading.Thread(target=work, args=(store,), kwargs={"drain": True})
    worker.start()
    count = int(SEARCH["designs"])
    expect(page.get_by_text(f"{count} of {count} designs listed")).to_be_visible(timeout=120_000)
    worker.join()
    designs = store.result(1).designs
    for number, row in enumerate(designs, 1):
        page.goto(f"{page.url.split('#')[0]}#/jobs/1/designs/{number}")
        least = page.locator("[data-key=choice_least_catalogue_1]").first
        expect(least).to_have_text(cheapest(story, row))
        price = page.locator("[data-key=least_catalogue_1_price_EUR]").first
        expect(price).to_have_attribute("data-value", str(MOTORS[cheapest(story, row)][1]))
    page.get_by_label("Crank, step").fill("1")
    page.get_by_label("Rod, step").fill("1")
    page.get_by_label("Offset, step").fill("1")
    page.get_by_label("Offset, step").press("Enter")
    notes = page.locator(".rounding")
    motor = str(designs[-1]["choice_catalogue_1"])
    expect(notes).to_contain_text(
        f"Catalogue 1 stays {motor}; the smallest one that suffices for the given design is "
        f"{cheapest(story, designs[-1])}",
        timeout=60_000,
    )
    page.get_by_role("button", name="Apply round numbers 1", exact=True).click()
    expect(page).to_have_url(re.compile("crank_mm="))
    rounded = {f"{name}_mm": float(page.locator(f"#what-if-{name}_mm").input_value()) for name in story.steps}
    assert all(value % 1.0 == 0.0 for value in rounded.values())
    assert stroke(rounded) >= 120.0
    assert peak_torque(story, rounded) <= MOTORS[motor][0]
    torque = page.locator(".objectives strong[data-key='peak_torque_Nm']")
    assert float(str(torque.get_attribute("data-value"))) == pytest.approx(peak_torque(story, rounded), rel=1e-4)
