"""A design that swings, and one whose cycle has two turns, in a browser."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from slidercrank.service.store import Store
from tests.service.api.swinging import ENGINE, solved_at_once, support
from tests.service.page.accessibility import findings
from tests.service.page.conftest import Pages, watched


@pytest.fixture(scope="module")
def service(pages: Pages, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str]]:
    with Store(tmp_path_factory.mktemp("page") / "store.db") as store:
        for job in (support(law="cycloidal", duration="20 s"), ENGINE):
            solved_at_once(store, job)
        with watched(pages, store) as opened:
            yield opened


LEFT = "node => node.getBBox().x + new DOMMatrix(getComputedStyle(node.parentNode).transform).e"
RIGHT = f"{LEFT} + node.getBBox().width"
"""Ends of an element in the units of its picture."""


def move_slider(page: Page, name: str, place: int) -> None:
    page.get_by_role("slider", name=name, exact=True).fill(str(place))


def test_a_design_moves_between_the_ends_of_its_swing(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/1/designs/1")
    told = page.locator("output.angle")
    for place, angle in ((0, "11°"), (180, "101°"), (359, "11°")):
        move_slider(page, "Back and forth", place)
        expect(told).to_have_text(angle)
    move_slider(page, "Back and forth", 0)
    turned = page.locator("svg.moving g:has(> path.crank)").get_attribute("transform") or ""
    assert float(turned.split("rotate(")[1].rstrip(")")) == pytest.approx(-11.16, abs=0.01)
    expect(page.locator("svg.still .ghost")).to_have_count(2)
    expect(page.get_by_text("travel ", exact=False).first).to_be_visible()
    titles = page.locator(".curves .title")
    expect(titles.filter(has_text="Force on the slider")).to_have_count(1)
    expect(titles.filter(has_text="Power of the drive")).to_have_count(1)
    over = page.locator('select[name="over"]')
    assert over.locator("option").all_text_contents() == ["both strokes", "time", "crank angle", "slider position"]
    over.select_option("crank")
    expect(page.locator('figure[data-key="drive_N"] svg.chart')).to_have_attribute(
        "aria-label", re.compile("over the crank angle")
    )
    numbers = page.locator("section.topics")
    numbers.scroll_into_view_if_needed()
    expect(numbers.get_by_role("heading", name="The swing")).to_be_visible()
    start = numbers.get_by_role("row", name="crank angle at the start")
    expect(start.get_by_role("cell").first).to_have_text("11.16", timeout=30_000)
    page.set_viewport_size({"width": 390, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.set_viewport_size({"width": 1280, "height": 900})
    assert findings(page) == []


def test_the_stage_draws_the_body_and_the_actuator(service: tuple[Page, str]) -> None:
    """The mass centre of the body lies as stated in the job; the actuator rod spans slider and barrel."""
    page, address = service
    page.goto(f"{address}/#/jobs/1/designs/1")
    crank = tomllib.loads(Path("runs/support.toml").read_text(encoding="utf-8"))["mechanism"]["crank"]
    along = float(crank["centre"].split()[0]) * {"m": 1e3, "mm": 1.0}[crank["centre"].split()[1]]
    long = float(page.locator('section.numbers [data-key="crank_mm"]').first.get_attribute("data-value") or "nan")
    for place in (0, 180):
        move_slider(page, "Back and forth", place)
        box = page.locator("section.stage g.body > rect").evaluate(
            "node => [node.x, node.width].map(of => of.baseVal.value)"
        )
        pins = page.locator("section.stage svg.moving g:has(> path.crank) circle.pin").evaluate_all(
            "nodes => nodes.map(node => node.cx.baseVal.value)"
        )
        assert (box[0] + 0.5 * box[1]) / (pins[1] - pins[0]) == pytest.approx(along / long, rel=1e-6)
        rod = page.locator("section.stage svg.moving rect.actuator").evaluate(RIGHT)
        barrel = page.locator("section.stage svg.still rect.actuator").evaluate(LEFT)
        assert rod == pytest.approx(barrel, abs=0.02)


def test_the_stage_draws_the_cylinder_to_scale(service: tuple[Page, str]) -> None:
    """At the top the piston leaves a ninth of the stroke, of an engine that compresses ten times."""
    page, address = service
    page.goto(f"{address}/#/jobs/2/designs/1")
    move_slider(page, "Crank angle", 0)
    expect(page.locator("output.angle")).to_have_text("0°")
    piston = page.locator("section.stage svg.moving rect.slider")
    (wall,) = page.locator("section.stage svg.still path.cylinder").all()
    edges = wall.evaluate("node => { const box = node.getBBox(); return [box.x, box.x + box.width, box.height]; }")
    right = {}
    for at in (0, 90):  # a cycle is two turns
        move_slider(page, "Crank angle", at)
        right[at] = piston.evaluate(RIGHT)
        assert piston.evaluate("node => node.height.baseVal.value") == pytest.approx(edges[2], abs=0.1)
    stroke = right[0] - right[90]
    assert edges[1] - right[0] == pytest.approx(stroke / 9.0, abs=0.05)
    assert edges[2] == pytest.approx(stroke, abs=0.1)  # 86 mm of bore and of stroke
    page.set_viewport_size({"width": 390, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.set_viewport_size({"width": 1280, "height": 900})


def test_other_lengths_swing_too(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/1")
    page.goto(f"{address}/#/jobs/1/designs/2")
    rod = page.locator("#what-if-rod_mm")
    rod.fill(f"{float(rod.input_value()) + 20.0}")
    expect(page.locator("section.what-if .results")).to_contain_text("peak actuator force")
    expect(page.locator("section.curves .legend")).to_contain_text("What if")


def test_curves_of_two_turns_are_both_there(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/2/designs/1")
    chart = page.locator('figure[data-key="torque_Nm"]')
    expect(chart.locator(".axes text", has_text="720°")).to_have_count(1)
    expect(chart.locator(".centre")).to_have_count(4)
    move_slider(page, "Crank angle", 270)
    expect(page.locator("output.angle")).to_have_text("540°")
    turned = page.locator("svg.moving g:has(> path.crank)").get_attribute("transform") or ""
    assert math.isclose(abs(float(turned.split("rotate(")[1].rstrip(")"))), 180.0, abs_tol=0.01)


def test_the_picture_of_a_front_swings_between_the_ends(service: tuple[Page, str]) -> None:
    page, address = service
    page.goto(f"{address}/#/jobs/1")
    picture = page.locator("section.linkage svg.still")
    expect(picture.locator(".ghost")).to_have_count(2)
    expect(picture.locator("path.path")).to_have_count(1)  # an arc in place of the circle
    expect(picture.locator("circle.path")).to_have_count(0)
    page.goto(f"{address}/#/jobs/2")
    expect(picture.locator("circle.path")).to_have_count(1)
