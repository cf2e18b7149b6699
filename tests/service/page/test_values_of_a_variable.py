"""Values that dimensions and other numbers may take, in the form: steps, series, lists, further numbers."""

from __future__ import annotations

import json
import re

import pytest
from playwright.sync_api import expect

from slidercrank.optimise.job import parse_job
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, ready, text_of


@pytest.mark.slow
def test_steps_preferred_numbers_and_lists_are_those_of_the_job_and_units_change_them_together(
    form: Open, store: Store
) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    dimensions = page.get_by_role("region", name="Dimensions")
    dimensions.get_by_label("crank", exact=True).select_option("step")
    expect(dimensions.get_by_label("crank, step")).to_have_value("1")  # of 80 to 160 mm
    dimensions.get_by_label("crank, step").fill("1/2")
    dimensions.get_by_label("rod", exact=True).select_option("series")
    dimensions.get_by_label("rod, series of preferred numbers").select_option("R20")
    dimensions.get_by_label("offset", exact=True).select_option("values")
    dimensions.get_by_label("offset, values").fill("20, 40, 60")
    page.get_by_label("stroke", exact=True).and_(page.get_by_role("combobox")).select_option("between")
    page.get_by_label("stroke, at least").fill("270")
    page.get_by_label("stroke, at most").fill("290")
    ready(page)
    variables = text_of(page)["variables"]
    assert variables == {
        "crank": {"min": "80 mm", "max": "160 mm", "step": "0.5 mm"},
        "rod": {"min": "200 mm", "max": "600 mm", "series": "R20"},
        "offset": {"values": ["20 mm", "40 mm", "60 mm"]},
    }
    crank, rod, offset = parse_job(text_of(page)).discrete
    assert len(crank.values) == 161
    assert [round(1e3 * value) for value in rod.values][:3] == [200, 224, 250]
    assert [round(1e3 * value) for value in offset.values] == [20, 40, 60]
    page.get_by_label("Unit of crank", exact=True).select_option("cm")
    assert text_of(page)["variables"]["crank"] == {"min": "8 cm", "max": "16 cm", "step": "0.05 cm"}
    dimensions.get_by_label("crank, step").fill("0")
    expect(dimensions.get_by_label("crank, step")).to_have_attribute("aria-invalid", "true")
    expect(dimensions.get_by_text(re.compile("Step must be positive"))).to_be_visible()
    dimensions.get_by_label("crank", exact=True).select_option("range")
    ready(page)
    assert text_of(page)["variables"]["crank"] == ["8 cm", "16 cm"]


@pytest.mark.slow
def test_a_further_number_varies_over_a_range_or_takes_some_values_and_then_is_fixed_again(
    form: Open, store: Store
) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    page.get_by_text("Extra variables").click()
    page.get_by_label("Add a variable").select_option("mechanism.slider.mass")
    expect(page.get_by_label("slider mass, from")).to_be_focused()
    ready(page)
    assert text_of(page)["variables"]["mechanism"] == {"slider": {"mass": ["0.975 kg", "3.9 kg"]}}
    page.get_by_label("Add a variable").select_option("load.1.force")
    mass = page.get_by_role("region", name="Dimensions").get_by_label("slider mass", exact=True)
    mass.select_option("series")
    ready(page)
    job = text_of(page)
    assert job["variables"]["mechanism"]["slider"]["mass"] == {"min": "0.975 kg", "max": "3.9 kg", "series": "R5"}
    assert job["variables"]["load"] == {"1": {"force": ["30 N", "120 N"]}}
    assert {item.name for item in parse_job(job).mechanism.varying} == {"mechanism.slider.mass", "load.1.force"}
    assert [item.rule for item in parse_job(job).discrete] == ["R5 in kg"]
    require_accessible(page)
    page.get_by_role("button", name="Remove slider mass").click()
    page.get_by_role("button", name="Remove load 1 force").click()
    ready(page)
    assert set(text_of(page)["variables"]) == {"crank", "rod", "offset"}


@pytest.mark.slow
def test_a_middle_and_half_a_width_make_a_range_where_one_can_be_and_are_refused_elsewhere(
    form: Open, store: Store
) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    stroke, crank = page.get_by_label("stroke", exact=True), page.get_by_label("crank", exact=True)
    page.get_by_label("stroke, exactly").fill("280 mm +- 0.5 mm")
    expect(page.get_by_text('"280 mm +- 0.5 mm" = 279.5 to 280.5 mm')).to_be_visible()
    page.keyboard.press("Tab")
    expect(stroke.and_(page.get_by_role("combobox"))).to_have_value("between")
    expect(page.get_by_label("stroke, at least")).to_have_value("279.5")
    expect(page.get_by_label("Unit of stroke", exact=True)).to_be_focused()
    crank.and_(page.get_by_role("combobox")).select_option("fixed")
    page.get_by_label("crank, fixed at").fill("14 ± 0,5 cm")
    page.keyboard.press("Tab")
    expect(page.get_by_label("crank, from")).to_have_value("135")
    page.get_by_label("crank, to").fill("150")
    page.get_by_label("rod, from").fill("400 +- 150")
    page.get_by_label("crank speed", exact=True).fill("5 Hz")
    page.get_by_role("button", name="Add a formula as a requirement").click()
    page.get_by_label("formula 1, requirement", exact=True).fill("rod - crank")
    page.get_by_label("formula 1, requirement: what must hold").select_option("equals")
    page.get_by_label("formula 1, requirement, exactly").fill("200 +- 90")
    expect(page.get_by_label("Unit of formula 1, requirement")).to_have_value("mm")
    ready(page)
    job = text_of(page)
    assert job["constraints"]["stroke"] == {"min": "279.5 mm", "max": "280.5 mm"}
    assert job["constraints"]["rod - crank"] == {"min": "110 mm", "max": "290 mm"}
    assert job["variables"]["crank"] == ["135 mm", "150 mm"]
    assert job["variables"]["rod"] == ["250 mm", "550 mm"]
    assert job["mechanism"]["speed"] == "300 rpm"
    page.get_by_label("crank speed", exact=True).fill("300 rpm +- 5 rpm")
    expect(page.get_by_text("is a range; write a single value here")).to_be_visible()
    job["mechanism"]["speed"] = "300 1/min"
    job["constraints"]["stroke"] = {"equals": "280 mm +- 0.5 mm"}
    job["variables"]["crank"] = "140 mm +- 5 mm"
    content = json.dumps(job).encode()
    page.locator("#job-import").set_input_files({"name": "own.json", "mimeType": "application/json", "buffer": content})
    expect(page.get_by_label("crank, to")).to_have_value("145")
    expect(page.get_by_label("stroke, at most")).to_have_value("280.5")
    expect(page.get_by_label("crank speed", exact=True)).to_have_value("300")
    assert text_of(page) == job
