"""Speeds as plates of motors say them, in the form: understood as rpm there and nowhere else, or left out."""

from __future__ import annotations

import json
import math

import pytest
from playwright.sync_api import expect

from slidercrank.optimise.job import parse_job
from slidercrank.service.store import Store
from tests.optimise.test_speed_left_out import TABLES
from tests.service.page.conftest import Open, ready, text_of

PLATES = {
    "140 U/min": 140.0,
    "130 1/min": 130.0,
    "125 min^-1": 125.0,
    "120 r/min": 120.0,
    "115 spm": 115.0,
    "110 strokes/min": 110.0,
    "2.5 Hz": 150.0,
}


@pytest.mark.slow
def test_units_of_plates_are_typed_for_a_speed_and_refused_for_a_length(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    speed, facts = page.get_by_label("crank speed", exact=True), page.get_by_role("complementary")
    for text, rpm in PLATES.items():
        speed.fill(text)
        expect(facts).to_contain_text(f"crank speed {rpm:g} rpm")
        assert parse_job(text_of(page)).mechanism.speed == pytest.approx(rpm * math.pi / 30.0, rel=1e-15)
    speed.press("Tab")
    expect(speed).to_have_value("150")
    expect(page.locator("#f-mechanism-speed-u")).to_have_value("rpm")
    page.get_by_label("stroke, exactly").fill("5 Hz")
    expect(page.get_by_text('Must be a length; got "5 Hz"')).to_be_visible()


@pytest.mark.slow
def test_a_form_without_a_speed_is_ready_where_nothing_follows_the_speed(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    content = json.dumps(TABLES).encode()
    page.locator("#job-import").set_input_files({"name": "own.json", "mimeType": "application/json", "buffer": content})
    speed, facts = page.get_by_label("crank speed", exact=True), page.get_by_role("complementary")
    expect(facts).to_contain_text("no crank speed: static")
    ready(page)
    expect(speed).to_have_value("")
    assert text_of(page) == TABLES
    speed.fill("200 U/min")
    expect(facts).to_contain_text("crank speed 200 rpm")
    speed.fill("")
    expect(facts).to_contain_text("no crank speed: static")
    ready(page)
    assert "speed" not in text_of(page)["mechanism"]
    page.get_by_label("Another requirement").select_option("peak_slider_speed")
    page.get_by_label("peak slider speed, at most").fill("3")
    expect(page.locator("#f-mechanism-speed-c-error")).to_contain_text("Is missing, but required")
