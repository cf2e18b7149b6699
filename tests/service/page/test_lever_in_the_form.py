"""A lever moved by a cylinder that turns in the form of a new run, in a browser."""

from __future__ import annotations

import json

import pytest
from playwright.sync_api import expect

from slidercrank.service.store import Store
from tests.optimise.problems import LEVER
from tests.service.page.conftest import Open, ready, text_of

pytestmark = pytest.mark.slow


def test_a_lever_is_stated_in_the_form_and_left_again(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    kind = page.locator("#f-motion-kind-c")
    kind.select_option("lever moved by a pivoting cylinder")
    ready(page)
    job = text_of(page)
    assert job["mechanism"]["inversion"] == "turning cylinder"
    assert job["objectives"] == {"peak_cylinder_force": "minimise"}
    for label in ("frame angle", "pin angle", "closed length", "bore", "supply pressure", "length tolerance"):
        expect(page.get_by_label(label, exact=True).first).to_be_visible()
    for label in ("slider mass", "mass of the rod", "driven end", "crank angle tolerance"):
        expect(page.get_by_label(label, exact=True)).to_have_count(0)
    for heading in ("Friction", "Loads", "Material and pins"):
        expect(page.locator(".sections").get_by_text(heading, exact=True)).to_have_count(0)
    expect(page.locator(".sketch g.turning-cylinder")).to_be_visible()
    expect(page.get_by_text("the cylinder travels")).to_be_visible()
    offered = page.locator("#add-requirement option").all_text_contents()
    assert "travel of the cylinder" in offered
    assert not {"peak actuator force", "stroke", "peak drive torque"} & set(offered)
    kind.select_option("rotates fully and turns a pivoting cylinder or an arm")
    ready(page)
    job = text_of(page)
    assert "motion" not in job
    assert job["objectives"] == {"arm_time_ratio": "maximise"}
    page.get_by_text("Arm and ram", exact=True).click()
    page.get_by_label("ram", exact=True).fill("300")
    ready(page)
    assert text_of(page)["arm"] == {"ram": "300 mm"}
    kind.select_option("")
    ready(page)
    assert "arm" not in text_of(page)
    assert "inversion" not in text_of(page)["mechanism"]
    assert "motion" not in text_of(page)


def test_the_job_of_a_lever_is_taken_from_its_text(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    page.get_by_text("The job as text").click()
    page.locator("#job-text").fill(json.dumps(LEVER))
    expect(page.get_by_label("seal friction", exact=True)).to_have_value("30")
    ready(page)
    expect(page.locator("section", has=page.get_by_text("Other parts of the job"))).to_have_count(0)
    page.get_by_label("bore", exact=True).fill("20")
    expect(page.get_by_role("complementary").get_by_role("status")).to_have_text("One thing to correct.")
    expect(page.get_by_text("The bore must exceed the piston rod").first).to_be_visible()
