"""Loads over position or angle, and desired motions, in the form: curves that are drawn, dragged and moved by keys."""

from __future__ import annotations

import json
from typing import Any

from playwright.sync_api import Page, expect

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.service.store import Store
from tests.service.page.conftest import Open

READY = "Ready to start."


def job_of(page: Page) -> dict[str, Any]:
    """Return the job as the form has it."""
    job: dict[str, Any] = json.loads(page.locator("#job-text").input_value())
    return job


def test_a_load_is_drawn_dragged_and_moved_by_keys_with_the_dead_centres_in_sight(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    expect(page.get_by_text(READY)).to_be_visible(timeout=30_000)
    page.get_by_label("kind of load").select_option("positions")
    drawn = page.locator(".curve-drawn:visible")
    expect(drawn.get_by_text("inner dead centre")).to_be_visible(timeout=30_000)
    expect(drawn.get_by_text("outer dead centre")).to_be_visible()
    points = drawn.get_by_role("slider")
    expect(points).to_have_count(2)

    before = job_of(page)["load"][0]
    points.first.press("ArrowUp")
    after = job_of(page)["load"][0]
    assert after["positions"] == before["positions"]
    assert float(after["forces"][0].split()[0]) > float(before["forces"][0].split()[0])
    expect(points.first).to_be_focused()

    box = points.nth(1).bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 2 - 20, box["y"] - 40, steps=3)
    page.mouse.up()
    dragged = job_of(page)["load"][0]
    assert float(dragged["forces"][1].split()[0]) > float(after["forces"][1].split()[0])
    assert float(dragged["positions"][0].split()[0]) < float(dragged["positions"][1].split()[0])

    drawn.dblclick(position={"x": 200, "y": 90})
    expect(points).to_have_count(3)
    points.nth(1).press("Delete")
    expect(points).to_have_count(2)
    assert job_of(page)["load"][0] == dragged


def test_two_points_at_one_position_are_a_step_and_neither_key_nor_mouse_puts_a_third_one_there(
    form: Open, store: Store
) -> None:
    page = form(store, "#/new")
    page.get_by_label("kind of load").select_option("positions")
    page.get_by_label("points, one per line", exact=True).fill("0\t0\n20\t-600\n20\t0\n30\t0")
    expect(page.get_by_text(READY)).to_be_visible(timeout=30_000)
    drawn = page.locator(".curve-drawn:visible")
    points = drawn.get_by_role("slider")
    expect(points).to_have_count(4)
    expect(page.get_by_text("Two points at one position make a step.")).to_be_visible()
    points.nth(2).press("ArrowLeft")  # past the point before it
    assert job_of(page)["load"][0]["positions"] == ["0 mm", "20 mm", "20 mm", "30 mm"]
    points.nth(2).press("ArrowUp")
    assert float(job_of(page)["load"][0]["forces"][2].split()[0]) > 0.0
    page.get_by_label("points, one per line", exact=True).fill("0\t0\n20\t-600\n20\t0\n20\t5")
    expect(page.get_by_text("Must increase, except for two equal ones at a step")).to_be_visible(timeout=30_000)


def test_a_wanted_motion_begins_with_that_of_the_linkage_beside_the_form(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    expect(page.get_by_text(READY)).to_be_visible(timeout=30_000)
    with page.expect_response("**/preview") as answered:
        page.get_by_label("crank, from").fill("21")
    example = answered.value.json()["example"]
    expect(page.get_by_text(READY)).to_be_visible(timeout=30_000)
    page.get_by_text("Desired motion of the slider").click()
    page.get_by_role("button", name="Add points of a motion").click()
    wanted = job_of(page)["target_motion"]
    lengths = (example[f"{name}_mm"] / 1e3 for name in ("crank", "rod", "offset"))
    linkage = Linkage(*lengths)
    for angle, position in zip(wanted["crank_angles"], wanted["positions"], strict=True):
        degrees, millimetres = float(angle.split()[0]), float(position.split()[0])
        where = float(linkage.at([degrees * 3.141592653589793 / 180.0], speed=1.0).slider_position[0])
        assert abs(where * 1e3 - millimetres) <= 0.51
    drawn = page.locator("details", has_text="Desired motion of the slider").locator(".curve-drawn:visible")
    expect(drawn.get_by_role("slider")).to_have_count(8)
    expect(page.get_by_text(READY)).to_be_visible(timeout=30_000)
    page.get_by_label("phase", exact=True).select_option("free")
    assert job_of(page)["target_motion"]["phase"] == "free"
    page.get_by_role("button", name="Remove the desired motion").click()
    assert "target_motion" not in job_of(page)
