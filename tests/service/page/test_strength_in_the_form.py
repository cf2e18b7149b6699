"""Material, pins and sections in the form of a new run: what is held, what varies, and what they need."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from slidercrank.optimise.job import parse_job
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, ready, text_of


@pytest.mark.slow
def test_material_pins_and_sections_are_given_held_or_left_to_the_search(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    fold = page.locator("summary", has_text="Material and pins")
    fold.click()
    page.get_by_label("with material and pins", exact=True).select_option("yes")
    page.get_by_label("yield strength", exact=True).fill("355 N/mm^2")
    page.get_by_label("yield strength", exact=True).blur()
    page.get_by_label("diameter of the crank pin", exact=True).fill("14")
    page.get_by_role("button", name="Let diameter of the crank pin vary").click()
    page.get_by_role("button", name="Let rod, width vary").click()
    page.get_by_label("rod, width, varying", exact=True).select_option("step")
    page.get_by_label("Another requirement").select_option("fatigue_safety")
    page.get_by_label("fatigue safety", exact=True).and_(page.get_by_role("combobox")).select_option("min")
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
    page.get_by_role("button", name="Hold diameter of the crank pin, varying").click()
    ready(page)
    assert "sections" not in text_of(page)["variables"]
    page.get_by_label("mass of the rod", exact=True).select_option("mass")
    expect(page.get_by_text("Stresses and safety need rod as a bar of rectangular section, above.")).to_be_visible()
    page.get_by_label("with material and pins", exact=True).select_option("")
    assert "sections" not in text_of(page)
