"""A swing in the form of a new run: its fields, its two ends in the sketch."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from slidercrank.optimise.job import parse_job
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, checked, ready, text_of


@pytest.mark.slow
def test_the_shipped_support_is_shown_changed_and_started_with_the_two_ends_of_its_swing(
    form: Open, store: Store
) -> None:
    page = form(store, "#/new?preset=support")
    ready(page)
    beside = page.get_by_role("complementary")
    expect(beside).to_contain_text("from 11.16° to 101.16°, the slider travels")
    expect(beside).to_contain_text("makes the swing")
    expect(beside.locator("svg .ghost")).to_have_count(2)
    assert "NaN" not in beside.inner_html()
    before = text_of(page)
    page.get_by_label("to crank angle", exact=True).fill("95")
    page.get_by_label("margin from dead points", exact=True).fill("0.35 rad")
    page.get_by_label("margin from dead points", exact=True).blur()
    expect(beside).to_contain_text("to 95°")
    page.get_by_label("motion over time", exact=True).select_option("polynomial")
    expect(page.get_by_text(re.compile("any other swing must have one"))).to_be_visible()
    page.get_by_label("duration of one stroke", exact=True).fill("30")
    ready(page)
    motion = text_of(page)["motion"]
    assert motion == before["motion"] | {
        "to": "95 deg",
        "margin": motion["margin"],
        "law": "polynomial",
        "duration": "30 s",
    }
    assert parse_job(text_of(page)).motion is not None
    require_accessible(page)
    page.get_by_role("button", name="Start the search").click()
    page.wait_for_url("**/#/jobs/1")
    assert store.job_tables(1)["motion"] == motion


def test_a_crank_that_is_let_swing_keeps_what_fits_and_says_what_was_taken_out(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    page.get_by_label("the crank", exact=True).select_option("swing")
    expect(page.locator("#notices")).to_contain_text("stroke, least transmission angle, time ratio, peak torque")
    checked(page)
    job = text_of(page)
    assert job["motion"] == {"kind": "swing", "from": "30 deg", "to": "90 deg", "driver": "slider"}
    assert job["objectives"] == {"peak_actuator_force": "minimise"}
    expect(page.get_by_label("slow stroke", exact=True)).to_have_count(0)
    page.get_by_label("driven end", exact=True).select_option("crank")
    force = page.get_by_label("peak actuator force", exact=True).and_(page.get_by_role("checkbox"))
    expect(force).to_have_attribute("aria-invalid", "true")
    said = page.locator(f"#{force.get_attribute('aria-describedby')}")
    expect(said).to_contain_text("or let the slider be the driven end")
    expect(said).not_to_contain_text("[")
    page.get_by_label("driven end", exact=True).select_option("slider")
    page.get_by_label("to crank angle", exact=True).fill("30")
    expect(page.get_by_text(re.compile("swing needs two different crank angles"))).to_be_visible()
    page.get_by_label("to crank angle", exact=True).fill("355")
    expect(page.get_by_role("complementary")).to_contain_text("No linkage within these ranges makes the swing.")
    page.get_by_label("the crank", exact=True).select_option("")
    expect(page.get_by_role("complementary")).to_contain_text("rotates fully")
    assert "motion" not in text_of(page)


def test_a_swing_is_stated_by_places_of_the_slider_or_by_its_angle(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=support")
    ready(page)
    page.get_by_label("stated by", exact=True).select_option("crank angle and swing")
    page.get_by_label("swing", exact=True).fill("90")
    ready(page)
    assert text_of(page)["motion"] | {"from": "11.16 deg", "swing": "90 deg"} == text_of(page)["motion"]
    assert "to" not in text_of(page)["motion"]
    beside = page.get_by_role("complementary")
    expect(beside).to_contain_text("from 11.16° to 101.16°, the slider travels")
    page.get_by_label("stated by", exact=True).select_option("two slider positions")
    page.get_by_label("from slider position", exact=True).fill("3100")
    page.get_by_label("to slider position", exact=True).fill("800")
    page.get_by_label("side of the crank pin", exact=True).select_option("left")
    motion = text_of(page)["motion"]
    assert (motion["slider_from"], motion["slider_to"]) == ("3100 mm", "800 mm")
    assert not {"from", "to", "swing"} & set(motion)
    require_accessible(page)


def test_a_swing_is_offered_what_it_can_have(form: Open, store: Store) -> None:
    """Gas cycles and several cylinders need a full turn; a spring on the crank needs a swing."""
    page = form(store, "#/new?preset=support")
    ready(page)
    folds = page.locator("details.more > summary")
    of_a_turn = [
        "Several cylinders",
        "Desired motion",
        "Motor and flywheel",
        "Robust designs",
        "Loose joint",
        "Costs of",
    ]
    for fold in of_a_turn:
        expect(folds.filter(has_text=fold)).to_have_count(0)
    expect(page.get_by_label("acceleration", exact=True)).to_have_count(0)
    page.get_by_role("button", name="Add a load").click()
    kind = page.get_by_label("kind of load", exact=True)
    kinds = kind.locator("option").all_text_contents()
    assert "spring on a swinging crank" in kinds
    assert not [title for title in kinds if "pressure" in title or "engine" in title or "compressor" in title]
    for title in ("torque on the crank", "table of torques on the crank over the crank angle", *kinds[-2:]):
        kind.select_option(label=title)
        ready(page)
        assert parse_job(text_of(page)).mechanism.loads
    page.get_by_label("the crank", exact=True).select_option("")
    for fold in of_a_turn:
        expect(folds.filter(has_text=fold)).to_have_count(1)
    turning = set(page.get_by_label("kind of load", exact=True).locator("option").all_text_contents())
    assert set(kinds) - turning == {"spring on a swinging crank"}
    assert len(turning - set(kinds)) == 4


def test_what_a_choice_leaves_without_a_meaning_is_taken_out(form: Open, store: Store) -> None:
    """The points of a table with another law, the duration of a slow swing, the tolerance of no actuator."""
    page = form(store, "#/new?preset=support")
    ready(page)
    law = page.get_by_label("motion over time", exact=True)
    law.select_option("table")
    page.get_by_label("duration of one stroke", exact=True).fill("20")
    page.get_by_label("points of the motion, one per line", exact=True).fill("0\t0\n0.2\t0.1\n0.8\t0.9\n1\t1")
    ready(page)
    motion = text_of(page)["motion"]
    assert (motion["law_times"], motion["law_shares"]) == ([0, 0.2, 0.8, 1], [0, 0.1, 0.9, 1])
    law.select_option("harmonic")
    ready(page)
    assert not {"law_times", "law_shares"} & set(text_of(page)["motion"])
    law.select_option("slow")
    ready(page)
    assert "duration" not in text_of(page)["motion"]
    page.get_by_label("driven end", exact=True).select_option("crank")
    assert "actuator_tolerance" not in text_of(page)["motion"]


def test_the_start_of_a_swing_may_vary(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=support")
    ready(page)
    page.get_by_label("stated by", exact=True).select_option("crank angle and swing")
    page.get_by_label("swing", exact=True).fill("90")
    page.locator("details.more > summary").filter(has_text="Extra variables").click()
    page.get_by_label("Add a variable", exact=True).select_option("motion.from")
    ready(page)
    problem = parse_job(text_of(page))
    assert [item.name for item in problem.mechanism.varying] == ["motion.from"]
