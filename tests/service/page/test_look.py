"""View of one mechanism: lengths typed, dragged by mouse and keyboard, shared as a link, taken to a search."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, ready, text_of


def number(page: Page, title: str) -> float:
    return float(page.get_by_label(title, exact=True).input_value())


def fact(page: Page, name: str) -> Locator:
    return page.locator(f".facts dt:text-is('{name}') + dd")


def drag(page: Page, grip: Locator, right: float, down: float) -> None:
    box = grip.bounding_box()
    assert box is not None
    # Where nothing lies over the guide: near its outer end.
    x = box["x"] + box["width"] * (0.98 if "guide" in (grip.get_attribute("aria-label") or "").lower() else 0.5)
    y = box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + right / 2, y + down / 2)
    page.mouse.move(x + right, y + down)
    page.mouse.up()


@pytest.mark.slow
def test_a_lecture_drags_a_mechanism_until_it_locks_and_starts_a_search_from_it(form: Open, store: Store) -> None:
    page = form(store, "", viewport={"width": 1280, "height": 900})
    page.get_by_role("main").get_by_role("link", name="Look at one mechanism").click()
    expect(page.get_by_role("heading", name="One mechanism")).to_be_visible()
    page.get_by_label("Crank", exact=True).fill("2 in")
    page.get_by_label("Rod", exact=True).fill("160")
    page.get_by_label("Offset", exact=True).fill("30")
    page.get_by_label("Speed", exact=True).fill("-90")
    r, l, e = 50.8, 160.0, 30.0
    excess = math.degrees(math.asin(e / (l - r)) - math.asin(e / (l + r)))
    expect(fact(page, "Time ratio")).to_have_text(f"{(180 + excess) / (180 - excess):.4g}, slow outward")
    expect(fact(page, "Outward stroke")).to_contain_text(f"{180 + excess:.4g}°")
    expect(page.locator(".stroke-angle.outward text")).to_have_text(f"{180 + excess:.4g}°")
    least = math.degrees(math.acos((r + e) / l))
    expect(fact(page, "Least transmission angle")).to_have_text(f"{least:.4g}°")
    expect(page.locator(".curves .chart .curve")).to_have_count(4)
    require_accessible(page)

    crank, slider, guide = (
        page.get_by_role("slider", name=re.compile(name)) for name in ("^Crank pin", "^Slider", "^Guide")
    )
    drag(page, slider, 40.0, 0.0)
    assert number(page, "Rod") > 165.0
    drag(page, guide, 0.0, -30.0)
    assert number(page, "Offset") > 35.0
    drag(page, crank, -12.0, 15.0)
    assert number(page, "Crank") < 48.0
    lengths = [number(page, title) for title in ("Crank", "Rod", "Offset")]
    for grip, title, n in ((crank, "Crank", 0), (slider, "Rod", 1), (guide, "Offset", 2)):
        grip.focus()
        page.keyboard.press("PageUp")
        page.keyboard.press("ArrowLeft")
        assert number(page, title) > lengths[n]
    page.wait_for_url(re.compile(rf"rod_mm={number(page, 'Rod'):g}\b"))
    shared = page.url

    page.get_by_label("Rod", exact=True).fill("60")
    needed = number(page, "Crank") + number(page, "Offset")
    expect(page.get_by_role("alert")).to_contain_text(f"lengthen the rod by more than {needed - 60.0:g} mm")
    expect(page.get_by_role("link", name="Search from here")).to_be_hidden()
    page.get_by_label("Rod", exact=True).fill("long")
    expect(page.get_by_role("alert")).to_contain_text("“long” is not a valid length")

    page.goto(shared)
    page.reload()
    stroke = fact(page, "Stroke").inner_text()
    lengths = [number(page, title) for title in ("Crank", "Rod", "Offset")]
    page.get_by_role("link", name="Search from here").press("Enter")
    ready(page)
    job: dict[str, Any] = text_of(page)
    for name, length in zip(("crank", "rod", "offset"), lengths, strict=True):
        low, high = (float(end.split()[0]) for end in job["variables"][name])
        assert low < length < high
    assert job["mechanism"]["speed"] == "-90 rpm"
    assert float(job["constraints"]["stroke"]["equals"].split()[0]) == pytest.approx(float(stroke.split()[0]), rel=1e-3)
    assert list(store.jobs()) == []
