"""Violated allowable values on the page; a what-if has numbers and a name of its own."""

from __future__ import annotations

import re
from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Page, expect

from slidercrank.service.designs.judged_requirements import front_violations_in_words
from slidercrank.service.store import Store
from tests.service.api.fixed_front import API, store_result
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched
from tests.service.weak_pins import TABLES, result

LENGTHS = {"crank_mm": 51.0, "rod_mm": 200.0, "offset_mm": 20.0}


@pytest.fixture(scope="module")
def opened(pages: Pages, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str, str]]:
    """Return a page, its address and that of a job with weak pins in the API."""
    with Store(tmp_path_factory.mktemp("weak") / "store.db") as store, watched(pages, store) as (page, address):
        number = store_result(store, result(), TABLES)
        yield page, f"{address}/#/jobs/{number}", f"{address}{API}/jobs/{number}"


def test_a_front_says_in_how_many_designs_what_is_allowed_is_exceeded(opened: tuple[Page, str, str]) -> None:
    page, view, _ = opened
    page.goto(view)
    count = len(result().designs)
    worst = max(float(str(row["pin_shear_crank_pin_MPa"])) for row in result().designs)
    said = page.get_by_text("Beyond the allowable value: shear of the crank pin in")
    expect(said).to_contain_text(f"in {count} of {count} designs, at worst {worst:.4g} MPa")
    expect(said).to_contain_text("more than the allowed 202.1 MPa (shear yield strength of the material)")
    sentences = front_violations_in_words(result())
    expect(page.get_by_text("Beyond the allowable value: ")).to_have_text(
        [f"Beyond the allowable value: {s}." for s in sentences]
    )


def test_a_design_says_what_it_goes_beyond_and_so_does_what_if(opened: tuple[Page, str, str]) -> None:
    page, view, api = opened
    page.goto(f"{view}/designs/2?beside=1")
    said = page.locator(".beyond p", has_text="shear of the crank pin")
    expect(said).to_have_count(2)
    own = httpx.get(f"{api}/designs/2").json()
    by = own["violated"]["pin_shear_crank_pin_MPa"]
    expect(said.first).to_contain_text("Design 2, beyond the allowable value: shear of the crank pin is")
    expect(said.first).to_contain_text(f"{by:.4g} MPa more than the allowed")
    assert (
        said.first.inner_text().removeprefix("Design 2, beyond the allowable value: ").rstrip(".") in own["violations"]
    )
    expect(said.last).to_contain_text("Design 1, beyond")
    require_accessible(page)
    query = "&".join(f"{key}={value}" for key, value in LENGTHS.items())
    page.goto(f"{view}/designs/1?{query}")
    found = httpx.post(f"{api}/designs/1/what-if", json={**LENGTHS, "angles": 0}, timeout=60.0).json()["violated"]
    text = (
        "What if, beyond the allowable value: pressure at the crank pin is .* "
        f"{found['pin_pressure_crank_pin_MPa']:.4g}"
    )
    expect(page.locator(".beyond p", has_text="pressure")).to_have_text(re.compile(text))


def test_the_objectives_at_a_glance_are_those_of_the_what_if_and_say_so(opened: tuple[Page, str, str]) -> None:
    page, view, api = opened
    page.goto(f"{view}/designs/1")
    tile = page.locator(".objectives strong[data-key='peak_torque_Nm']")
    before = httpx.get(f"{api}/designs/1").json()["design"]["peak_torque_Nm"]
    expect(tile).to_have_attribute("data-value", str(before))
    expect(page.locator(".objectives .whose")).to_have_count(0)
    rod = page.locator("#what-if-rod_mm")
    kept = rod.input_value()
    rod.fill("222")
    expect(page.locator("h1")).to_contain_text("Design 1, changed")
    expect(page.get_by_text("For design 1 itself, without the change:").first).to_be_visible()
    row = page.locator(".before-after td[data-key='peak_torque_Nm']")
    expect(row).to_have_attribute("data-value", re.compile(r"\d"))
    changed = row.get_attribute("data-value")
    assert changed is not None
    assert float(changed) != before
    expect(tile).to_have_attribute("data-value", changed)
    expect(tile).to_have_text(re.compile(rf"^{before:.4g}[.0]* → {float(changed):.4g}"))
    back = page.get_by_role("button", name="Back to design 1")
    back.press("Enter")
    expect(tile).to_have_text(re.compile(rf"^{before:.4g}"))
    expect(back).to_be_hidden()
    expect(rod).to_have_value(kept)
    rod.fill("-5")
    expect(page.locator(".what-if [role=alert]")).to_contain_text("needs a length above 0")
    expect(page.locator(".objectives .whose")).to_have_text("Design 1 itself: the change is not possible")
    expect(tile).to_have_attribute("data-value", str(before))
    rod.fill("230")
    expect(page.locator(".objectives .whose")).to_be_visible()
    page.get_by_role("button", name="Reset").click()
    expect(page.locator(".objectives .whose")).to_have_count(0)
    expect(page.get_by_text("For design 1 itself, without the change:").first).to_be_hidden()
    expect(tile).to_have_attribute("data-value", str(before))
    expect(rod).to_have_value(kept)
