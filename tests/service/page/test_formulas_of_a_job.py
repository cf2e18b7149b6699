"""Formulas in the form of a new run: typed, completed, with unit or mistake beside them, named, in bounds."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from slidercrank.optimise.job import parse_job
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, ready, text_of


@pytest.mark.slow
def test_formulas_are_typed_by_keyboard_alone_with_names_offered_and_units_or_mistakes_said(
    form: Open, store: Store
) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_role("button", name="Add a formula as a requirement").focus()
    page.keyboard.press("Enter")
    formula = page.get_by_label("formula 1, requirement", exact=True)
    expect(formula).to_be_focused()
    page.keyboard.type("2 * cra")
    offered = page.get_by_role("listbox").get_by_role("option")
    expect(offered.first).to_have_text("crank crank, mm")
    page.keyboard.press("ArrowDown")
    expect(formula).to_have_attribute("aria-activedescendant", str(offered.first.get_attribute("id")))
    page.keyboard.press("Enter")
    page.keyboard.type(" + 3 m")
    expect(page.get_by_role("listbox")).to_have_count(0)  # a unit stands there
    for _ in " + 3 m":
        page.keyboard.press("Backspace")
    page.keyboard.type(" + peak_torque")
    page.keyboard.press("Escape")
    expect(formula).to_have_attribute("aria-invalid", "true")
    error = page.locator(f"#{formula.get_attribute('id')}-error")
    expect(error).to_contain_text("2 * crank + peak_torque adds mm and N m")
    for _ in "peak_torque":
        page.keyboard.press("Backspace")
    page.keyboard.type("rod")
    page.keyboard.press("Tab")
    expect(page.get_by_role("status").filter(has_text="length, in mm")).to_be_visible()
    expect(page.get_by_label("Unit of formula 1, requirement")).to_have_value("mm")
    page.get_by_label("formula 1, requirement, at most").fill("36 in")
    page.get_by_label("formula 1, requirement, at most").blur()
    expect(page.get_by_label("formula 1, requirement, at most")).to_have_value("914.4")
    ready(page)
    assert text_of(page)["constraints"]["2 * crank + rod"] == {"max": "914.4 mm"}
    page.get_by_role("button", name="Add a formula as an objective").click()
    page.keyboard.type("peak_torque_outward / peak_torque_inwrd")
    page.keyboard.press("Escape")
    wrong = page.get_by_label("formula 1, objective", exact=True)
    expect(page.locator(f"#{wrong.get_attribute('id')}-error")).to_contain_text("did you mean peak_torque_inward")
    require_accessible(page)
    page.get_by_role("button", name="Remove formula 1, objective").click()
    ready(page)
    assert parse_job(text_of(page)).objectives == parse_job(text_of(page) | {"constraints": {}}).objectives


@pytest.mark.slow
def test_a_formula_with_a_name_is_called_by_it_everywhere_and_renamed_everywhere(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_text("Formulas with names").click()
    page.get_by_role("button", name="Add a formula with a name").click()
    named = page.get_by_role("group", name="formula with a name 1")
    named.get_by_label("formula", exact=True).fill("offset - crank")
    page.keyboard.press("Escape")
    named.get_by_label("title", exact=True).fill("room beside the crank")
    named.get_by_label("name", exact=True).fill("clearance")
    named.get_by_label("name", exact=True).blur()
    page.get_by_role("button", name="Add a formula as a requirement").click()
    page.keyboard.type("clear")
    offered = page.get_by_role("option", name="clearance room beside the crank, mm")
    expect(offered).to_be_visible(timeout=30_000)  # once the service has looked at it
    page.keyboard.type("ance")
    page.get_by_label("formula 1, requirement, at most").fill("90")
    page.get_by_label("stroke, exactly").fill("=2.4*crank + 0*clearance")
    page.keyboard.press("Escape")
    ready(page)
    job = text_of(page)
    assert job["quantity"] == {"clearance": {"formula": "offset - crank", "title": "room beside the crank"}}
    assert job["constraints"]["stroke"] == {"equals": "2.4*crank + 0*clearance"}
    named.get_by_label("name", exact=True).fill("room")
    named.get_by_label("name", exact=True).blur()
    ready(page)
    job = text_of(page)
    assert list(job["quantity"]) == ["room"]
    assert job["constraints"]["room"] == {"max": "90 mm"}
    assert job["constraints"]["stroke"] == {"equals": "2.4*crank + 0*room"}
    named.get_by_label("name", exact=True).fill("Room!")
    named.get_by_label("name", exact=True).blur()
    expect(page.get_by_text("A name must have lower-case letters, digits and underscores")).to_be_visible()
    page.reload()
    ready(page)
    expect(page.get_by_label("formula 1, requirement", exact=True)).to_have_value("room")
    assert text_of(page) == job
