"""Levers moved by a cylinder that turns, in a browser: one design, its front, and other lengths."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from slidercrank.service.store import Store
from tests.optimise.problems import LEVER
from tests.service.api.swinging import solved_at_once
from tests.service.page.accessibility import findings
from tests.service.page.conftest import Pages, watched
from tests.service.page.looks import faults
from tests.service.page.test_swing_design import move_slider

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def service(pages: Pages, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str]]:
    variables: dict[str, Any] = LEVER["variables"] | {"mechanism.frame_angle": ["-75 deg", "-50 deg"]}
    with Store(tmp_path_factory.mktemp("page") / "store.db") as store:
        solved_at_once(store, LEVER | {"variables": variables})
        with watched(pages, store) as opened:
            yield opened


def number(page: Page, key: str) -> float:
    """Return a number of the design."""
    return float(page.locator(f'section.numbers [data-key="{key}"]').first.get_attribute("data-value") or "nan")


def placement_of_group(page: Page, parts: str) -> tuple[float, float, float]:
    """Return where a group of the drawing is laid, px, and how it is turned counter-clockwise, deg."""
    text = page.locator(f"section.stage svg.moving {parts}").get_attribute("transform") or ""
    x, y, angle = map(float, re.findall(r"-?[\d.]+", text))
    return x, y, -angle


def test_a_lever_moves_between_the_ends_of_its_swing(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/1/designs/1")
    lengths = {end: number(page, f"{end}_cylinder_length_mm") for end in ("least", "greatest")}
    for place, angle, length in ((0, "−20°", lengths["least"]), (180, "50°", lengths["greatest"])):
        move_slider(page, "Back and forth", place)
        expect(page.locator("output.angle")).to_have_text(angle)
        expect(page.locator("output.where")).to_have_text(f"cylinder {float(f'{length:.4g}'):g} mm")
        *_, drawn = placement_of_group(page, "g:has(> path.crank)")
        assert drawn == pytest.approx(float(angle.removesuffix("°").replace("−", "-")), abs=0.01)
    expect(page.locator("section.stage svg.still .ghost")).to_have_count(2)
    expect(page.locator("section.stage svg.still .bearing")).to_have_count(2)
    expect(page.locator("section.stage svg.moving rect.slider")).to_be_hidden()
    for words in ("crank ", "rod ", "offset ", "50°", "−20°"):
        expect(page.locator("section.stage svg.still text", has_text=words)).to_have_count(1)


def test_the_cylinder_is_drawn_to_scale(service: tuple[Page, str]) -> None:
    """The cylinder line has the stated length to the pin, and its distance from the pivot is the offset."""
    page, address = service
    page.goto(f"{address}/#/jobs/1/designs/1")
    move_slider(page, "Back and forth", 180)
    x, y, lever = placement_of_group(page, "g:has(> path.crank)")
    pins = page.locator("section.stage svg.moving g:has(> path.crank) circle.pin")
    crank = float(pins.nth(1).get_attribute("cx") or "nan")
    scale = crank / number(page, "crank_mm")
    foot = placement_of_group(page, "g.turning-cylinder")
    box = page.locator("section.stage svg.moving g.turning-cylinder path").evaluate("node => node.getBBox().width")
    assert box == pytest.approx(scale * number(page, "greatest_cylinder_length_mm"), rel=1e-3)
    pin = page.locator("section.stage svg.moving g.turning-cylinder circle.pin")
    assert float(pin.get_attribute("cy") or "nan") == pytest.approx(scale * number(page, "offset_mm"), rel=1e-3)
    base = math.hypot(foot[0] - x, foot[1] - y) / scale  # off the pivot A by the offset
    assert abs(base - number(page, "rod_mm")) <= abs(number(page, "offset_mm")) + 0.1
    assert lever == pytest.approx(50.0, abs=0.01)


def test_curves_and_analyses_are_those_of_a_lever(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/1/designs/1")
    titles = page.locator(".curves .title")
    for words in ("Cylinder length", "Push without seal friction", "Cylinder speed", "Lever pin force"):
        expect(titles.filter(has_text=words)).to_have_count(1)
    over = page.locator('select[name="over"]')
    assert over.locator("option").all_text_contents() == ["both strokes", "time", "lever angle", "cylinder length"]
    over.select_option("position")
    expect(page.locator('figure[data-key="push_N"] svg.chart')).to_have_attribute(
        "aria-label", re.compile("over the cylinder length")
    )
    expect(page.locator("section.topics h2")).to_have_text("Moved by a cylinder that turns")
    page.locator("section.topics").scroll_into_view_if_needed()
    start = page.locator("section.topics").get_by_role("row", name="start length")
    expect(start.get_by_role("cell").first).to_have_text(
        re.compile(f"^{int(number(page, 'least_cylinder_length_mm'))}")
    )
    expect(page.get_by_text("From slider position to crank angle")).to_have_count(0)


def test_other_lengths_are_drawn_and_have_curves(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/1/designs/2")
    rod = page.locator("#what-if-rod_mm")
    rod.fill(f"{float(rod.input_value()) + 5.0}")
    expect(page.locator("section.what-if .results")).to_contain_text("peak cylinder force")
    expect(page.locator("section.curves .legend")).to_contain_text("What if")
    expect(page.locator("section.stage svg.still text", has_text="rod ")).to_contain_text(
        f"{float(rod.input_value()):.4g}"
    )


def test_a_front_has_pictures_of_its_levers(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/1")
    picture = page.locator("section.linkage")
    expect(picture.locator("svg.still .bearing")).to_have_count(2)
    expect(picture.locator("svg.moving g.turning-cylinder")).to_be_visible()
    expect(page.locator(".marks .small-linkage circle.pivot")).to_have_count(2 * page.locator(".marks li").count())
    expect(page.locator(".marks .small-linkage .block")).to_have_count(0)


@pytest.mark.parametrize("view", ["jobs/1", "jobs/1/designs/1", "jobs/1/designs/1?beside=3"])
def test_levers_fit_every_screen(service: tuple[Page, str], view: str) -> None:
    page, address = service
    for width in (390, 1280):
        page.goto("about:blank")
        page.set_viewport_size({"width": width, "height": 900})
        page.goto(f"{address}/#/{view}")
        expect(page.locator("svg.moving g.turning-cylinder").first).to_be_visible()
        expect(page.locator(".marks .small-linkage, .curves .chart").first).to_be_visible()
        assert faults(page) == {}
    assert findings(page) == []
