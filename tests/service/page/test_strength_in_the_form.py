"""Material, pins and sections in the form of a new run: what is held, what varies, and what they need."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from slidercrank.optimise.job import parse_job
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, ready, text_of

PINS = ("crank pivot", "crank pin", "slider pin")


def test_material_is_an_example_that_is_said_and_pins_are_asked_for(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    page.locator("summary", has_text="Material and pins").click()
    page.get_by_label("with material and pins", exact=True).select_option("yes")
    expect(page.get_by_text("The values are those of a common steel")).to_be_visible()
    sections = text_of(page)["sections"]
    assert sections["material"]["yield_strength"] == "350 MPa"
    assert sections["pins"] == {}
    for pin in PINS:
        expect(page.get_by_label(f"diameter of the {pin}", exact=True)).to_have_value("")
    status = page.get_by_role("complementary").get_by_role("status")
    expect(status).not_to_have_text("Ready to start.")
    expect(page.locator("#f-sections-pins-crank_pin-c-error")).to_contain_text("Is missing")


def test_pins_are_proposed_from_the_width_of_their_bars_when_that_is_asked_for(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    page.locator("summary", has_text="Material and pins").click()
    page.get_by_label("with material and pins", exact=True).select_option("yes")
    page.locator("#f-mechanism-crank-width-c").fill("1.2")
    page.locator("#f-mechanism-crank-width-u").select_option("in")
    page.locator("#f-mechanism-crank-width-c").fill("1.2")
    page.get_by_role("button", name="Make pins half as thick as their bars are wide").click()
    job = text_of(page)
    assert job["mechanism"]["rod"]["width"] == "30 mm"
    assert job["sections"]["pins"] == {"crank_pivot": "0.6 in", "crank_pin": "15 mm", "slider_pin": "15 mm"}
    ready(page)
    page.get_by_label("diameter of the slider pin", exact=True).fill("16")
    assert text_of(page)["sections"]["pins"]["slider_pin"] == "16 mm"


def test_a_requirement_begins_on_the_good_side_of_its_quantity(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    for name, title, side in (
        ("efficiency", "efficiency", "at least"),
        ("peak_shaking_force", "peak shaking force", "at most"),
    ):
        page.get_by_label("Another requirement").select_option(name)
        expect(page.get_by_label(f"{title}, {side}")).to_be_focused()
        key = {"at least": "min", "at most": "max"}[side]
        assert text_of(page)["constraints"][name] == {key: ""}


@pytest.mark.slow
def test_material_pins_and_sections_are_given_held_or_left_to_the_search(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    fold = page.locator("summary", has_text="Material and pins")
    fold.click()
    page.get_by_label("with material and pins", exact=True).select_option("yes")
    for pin in PINS:  # none has a size that nobody gave
        expect(page.get_by_label(f"diameter of the {pin}", exact=True)).to_have_value("")
    page.get_by_label("diameter of the crank pivot", exact=True).fill("15")
    page.get_by_label("diameter of the slider pin", exact=True).fill("10")
    page.get_by_label("yield strength", exact=True).fill("355 N/mm^2")
    page.get_by_label("yield strength", exact=True).blur()
    page.get_by_label("diameter of the crank pin", exact=True).fill("14")
    page.get_by_role("button", name="Let diameter of the crank pin vary").click()
    page.get_by_role("button", name="Let rod, width vary").click()
    page.get_by_label("rod, width", exact=True).select_option("step")
    page.get_by_label("Another requirement").select_option("fatigue_safety")
    page.get_by_label("fatigue safety, at least").fill("1.5")
    ready(page)
    job = text_of(page)
    assert job["sections"]["material"]["yield_strength"] in ("355 MPa", "355 N/mm^2")
    assert job["sections"]["pins"]["crank_pin"] == "14 mm"
    assert job["variables"]["sections"] == {"pins": {"crank_pin": ["7 mm", "28 mm"]}}
    assert job["variables"]["mechanism"] == {"rod": {"width": {"min": "15 mm", "max": "60 mm", "step": "1 mm"}}}
    problem = parse_job(job)
    assert {item.name for item in problem.mechanism.varying} == {"sections.pins.crank_pin", "mechanism.rod.width"}
    expect(fold).to_contain_text("14 mm")
    require_accessible(page)
    page.get_by_role("button", name="Hold diameter of the crank pin").click()
    ready(page)
    assert "sections" not in text_of(page)["variables"]
    page.get_by_label("mass of the rod", exact=True).select_option("mass")
    needed = "For stresses and safety, give the rod a rectangular section (width and depth) in the fields above."
    expect(page.get_by_text(needed)).to_be_visible()
    page.get_by_label("with material and pins", exact=True).select_option("")
    assert "sections" not in text_of(page)
