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


def locate_fact(page: Page, name: str) -> Locator:
    return page.locator(f".facts dt:text-is('{name}') + dd")


def require_no_mechanism(page: Page) -> None:
    for part in (".machines svg", ".curves .chart", ".facts", "text=Search from here"):
        expect(page.locator(part).first).to_be_hidden()


def place_of(grip: Locator) -> tuple[float, float]:
    """Return where to take a grip: the guide near its outer end, where nothing lies over it."""
    box = grip.bounding_box()
    assert box is not None
    outer = "guide" in (grip.get_attribute("aria-label") or "").lower()
    return box["x"] + box["width"] * (0.98 if outer else 0.5), box["y"] + box["height"] / 2


def drag(page: Page, grip: Locator, right: float, down: float) -> None:
    """Drag a grip once it rests. On a busy machine, the answer to an earlier input may still move it."""
    page.wait_for_load_state("networkidle")
    place = (0.0, 0.0)
    while place != (place := place_of(grip)):
        page.wait_for_timeout(250)
    x, y = place
    page.mouse.move(x, y)
    assert grip.evaluate("(grip, [x, y]) => document.elementFromPoint(x, y) === grip", [x, y])
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
    expect(locate_fact(page, "Time ratio")).to_have_text(f"{(180 + excess) / (180 - excess):#.4g}, slow outward")
    expect(locate_fact(page, "Outward stroke")).to_contain_text(f"{180 + excess:.4g}°")
    expect(page.locator("text.stroke-angle.outward")).to_have_text(f"{180 + excess:.4g}°")
    least = math.degrees(math.acos((r + e) / l))
    expect(locate_fact(page, "Least transmission angle")).to_have_text(f"{least:.4g}°")
    expect(page.locator(".curves .chart .curve")).to_have_count(4)
    angles = [2.0 * math.pi * k / 100_000 for k in range(100_000)]
    omega = -3.0 * math.pi
    rises = [(e - r * math.sin(angle)) / math.sqrt(l**2 - (e - r * math.sin(angle)) ** 2) for angle in angles]
    speeds = [
        1e-3 * omega * (-r * math.sin(angle) + r * math.cos(angle) * rise)
        for angle, rise in zip(angles, rises, strict=True)
    ]
    ends = [f"{end:.4g}".replace("-", "−") for end in (min(speeds), max(speeds))]
    expect(locate_fact(page, "Slider velocity")).to_have_text(f"{ends[0]} to {ends[1]}\xa0m/s")
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
    lengthen = page.get_by_role("button", name="Lengthen the rod to")
    longer = float(lengthen.inner_text().split()[-2])
    assert longer == pytest.approx(1.25 * needed, abs=0.01)
    lengthen.press("Enter")
    expect(lengthen).to_be_hidden()
    assert number(page, "Rod") == longer
    expect(page.get_by_role("link", name="Search from here")).to_be_visible()
    page.get_by_label("Rod", exact=True).fill("60")
    expect(lengthen).to_be_visible()
    drag(page, guide, 0.0, -800.0)  # no further than the links reach
    assert needed < number(page, "Offset") < number(page, "Crank") + 60.0
    expect(page.locator(".curves .chart").first).to_be_hidden()
    offset = page.get_by_label("Offset", exact=True)
    offset.fill("-300")
    expect(page.get_by_role("alert")).to_contain_text("cannot be assembled: the offset, −300 mm, must be less than")
    require_no_mechanism(page)
    page.goto(shared)
    page.reload()
    for typed in ("NaN", "0", "-50", ""):
        offset.fill("30")
        expect(page.locator(".curves .chart .curve")).to_have_count(4)
        expect(locate_fact(page, "Stroke")).to_be_visible()
        page.get_by_label("Crank", exact=True).fill(typed)
        expect(page.get_by_label("Crank", exact=True)).to_have_accessible_description(re.compile("length"))
        require_no_mechanism(page)
        offset.fill("31")  # another field that is right does not bring the old crank back
        require_no_mechanism(page)
        assert f"crank_mm={typed}" in page.url if typed else "crank_mm" not in page.url
        page.get_by_label("Crank", exact=True).fill("40")
        expect(page.get_by_role("alert")).to_have_text("")

    page.goto(f"{shared.split('#')[0]}#/look?crank_mm=abc&rod_mm=-5&offset_mm=NaN")
    page.reload()
    for title, text in (("Crank", "abc"), ("Rod", "-5"), ("Offset", "NaN")):
        field = page.get_by_label(title, exact=True)
        expect(field).to_have_value(text)
        expect(field).to_have_attribute("aria-invalid", "true")
        expect(field).to_have_accessible_description(re.compile(re.escape(text)))
    require_no_mechanism(page)

    page.goto(shared)
    page.reload()
    expect(locate_fact(page, "Stroke")).to_be_visible()
    lengths = [number(page, title) for title in ("Crank", "Rod", "Offset")]
    page.get_by_role("link", name="Search from here").press("Enter")
    ready(page)
    job: dict[str, Any] = text_of(page)
    for name, length in zip(("crank", "rod", "offset"), lengths, strict=True):
        low, high = (float(end.split()[0]) for end in job["variables"][name])
        assert low < length < high
    assert job["mechanism"]["speed"] == "-90 rpm"
    r, l, e = lengths
    exact = math.sqrt((l + r) ** 2 - e**2) - math.sqrt((l - r) ** 2 - e**2)
    assert float(job["constraints"]["stroke"]["equals"].split()[0]) == pytest.approx(exact, rel=1e-7)
    assert list(store.jobs()) == []


def test_a_crank_that_locks_stops_at_the_ends_of_its_arc(form: Open, store: Store) -> None:
    page = form(store, "#/look?crank_mm=60&rod_mm=123.5&offset_mm=70", viewport={"width": 1280, "height": 900})
    expect(page.get_by_role("alert")).to_contain_text("longer than crank + offset, 130 mm; got 123.5 mm")
    angle = page.get_by_label("Crank angle")
    low, high = (math.degrees(math.asin((70 - 123.5) / 60)), 180 - math.degrees(math.asin((70 - 123.5) / 60)))
    for turned, end in (("265", math.floor(high)), ("280", 360 + math.ceil(low))):
        angle.fill(turned)
        expect(page.locator("output.angle")).to_have_text(f"{end}°")
        expect(page.locator("output.where")).to_have_text(re.compile(r"slider at −?\d"))
    page.get_by_role("button", name="Play").click()
    seen = set()
    for _ in range(40):
        seen.add(int(page.locator("output.angle").inner_text()[:-1]))
        page.wait_for_timeout(20)
    assert len(seen) > 5
    assert not seen & set(range(244, 297))
    page.get_by_role("button", name="Pause").click()


def test_a_crank_dragged_outwards_stays_in_the_picture(form: Open, store: Store) -> None:
    page = form(store, "#/look?crank_mm=50&rod_mm=150&offset_mm=40", viewport={"width": 1280, "height": 900})
    expect(locate_fact(page, "Stroke")).to_be_visible()
    grip = page.get_by_role("slider", name=re.compile("^Crank pin"))
    x, y = place_of(grip)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 9):
        page.mouse.move(x + 10 * step, y - 8 * step)
    assert number(page, "Crank") > 75.0
    circle, picture = (page.locator(f".machines {part}").first.bounding_box() for part in ("circle.path", "svg"))
    assert circle is not None
    assert picture is not None
    assert circle["y"] >= picture["y"]
    assert circle["y"] + circle["height"] <= picture["y"] + picture["height"]
    page.mouse.up()


CLEARANCE = """range => {
  const label = document.querySelector("text.dimension.radius").getBoundingClientRect();
  const crank = document.querySelector(".machines .link.crank");
  const width = crank.getBBox().height;
  return [270, 280, 290, 296, 297, 300, 310].map(angle => {
    range.value = angle;
    range.dispatchEvent(new Event("input", { bubbles: true }));
    const box = crank.parentNode.querySelectorAll(".pin")[1].getBoundingClientRect();
    const [x, y] = [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
    const across = Math.max(label.left - x, 0, x - label.right);
    const down = Math.max(label.top - y, 0, y - label.bottom);
    return Math.hypot(across, down) - width / 2;
  });
}"""
"""Pixels between the end of the crank and its dimension as the pin passes it."""


@pytest.mark.slow
def test_the_crank_does_not_hide_its_dimension_as_it_passes(form: Open, store: Store) -> None:
    page = form(store, "#/look?crank_mm=60&rod_mm=230&offset_mm=70", viewport={"width": 1280, "height": 900})
    expect(page.locator("text.dimension.radius")).to_have_text("crank 60\xa0mm")
    gaps = page.locator(".strip input[type=range]").first.evaluate(CLEARANCE)
    assert len({round(gap, 6) for gap in gaps}) == len(gaps)  # the crank has moved
    assert min(gaps) >= 0.0
    picture = page.locator(".machines svg").first.bounding_box()
    label = page.locator("text.dimension.radius").bounding_box()
    assert picture is not None
    assert label is not None
    assert label["y"] + label["height"] <= picture["y"] + picture["height"]
