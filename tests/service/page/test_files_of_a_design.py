"""The motion and the report of a design as files of their own, in a browser."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.swing.swing import Swing
from slidercrank.service.designs.design_curves import cycle_table
from slidercrank.service.motion.player_page import player_page
from slidercrank.service.report.design_report import design_report
from slidercrank.service.report.document import Picture
from slidercrank.service.report.html import html_file
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import result_of
from tests.service import fronts
from tests.service.page.accessibility import findings

OFFSET, BELOW = Linkage(0.14, 0.31, 0.06), Linkage(0.14, 0.31, -0.06)


def test_the_page_plays_in_a_browser_and_fetches_nothing(browser: Browser, tmp_path: Path) -> None:
    linkage = BELOW
    mechanism = replace(fronts.MACHINE, speed=-4.0)
    file = tmp_path / "motion.html"
    file.write_bytes(player_page(mechanism, linkage, name="Sieve", design="design 3"))
    page = browser.new_page()
    wrong: list[str] = []
    asked: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.on("console", lambda message: wrong.append(message.text))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(file.as_uri())
    before = page.locator("#crank").get_attribute("transform")
    page.wait_for_function(f"document.getElementById('crank').getAttribute('transform') !== {json.dumps(before)}")
    page.get_by_role("button", name="Pause").click()
    assert page.get_by_role("button", name="Play").is_visible()
    angle = page.get_by_label("Crank angle")
    angle.focus()
    angle.fill("90")
    position = next(c for c in cycle_table(mechanism, linkage, angles=4) if c.key == "slider_position_mm").values[1]
    shown = page.locator('output[data-curve="slider_position_mm"]').text_content()
    assert float(str(shown).replace("−", "-")) == pytest.approx(position, rel=1e-3)
    moved = page.locator("#slider").get_attribute("transform") or ""
    assert float(moved.split("(")[1].split()[0]) == pytest.approx(position, rel=1e-9)
    angle.press("ArrowRight")
    assert page.locator("#angle-now").text_content() == "91°"
    assert page.locator("option", has_text="as it runs").text_content() == "as it runs, 38.2 turns a minute"
    page.close()
    assert wrong == []
    assert asked == [file.as_uri()]


def test_a_swing_plays_with_its_cylinder_and_body(browser: Browser, tmp_path: Path) -> None:
    linkage, body = Linkage(1.4, 1.8, -0.05), RigidLink(mass=1200.0, centre=1.1, centre_across=0.15)
    swing = Swing(start=0.2, end=1.7, driver="slider", law="polynomial", duration=20.0)
    file = tmp_path / "swing.html"
    file.write_bytes(player_page(Mechanism(crank=body), linkage, name="Support", swing=swing))
    page = browser.new_page(reduced_motion="reduce")
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(file.as_uri())
    place = page.get_by_role("slider", name="Back and forth")
    ends = [1e3 * float(linkage.at(angle).slider_position) for angle in (0.2, 1.7)]
    for phase, x, degrees in (
        (0, ends[0], 11),
        (90, 0.5 * sum(ends), None),
        (180, ends[1], 97),
        (270, 0.5 * sum(ends), None),
    ):
        place.fill(str(phase))
        for part in ("slider", "push", "slider-pin"):
            moved = page.locator(f"#{part}").get_attribute("transform") or ""
            assert float(moved.split("(")[1].split()[0]) == pytest.approx(x, rel=1e-7), part
        if degrees is not None:
            assert page.locator("#angle-now").text_content() == f"{degrees}°"
    assert page.locator("option", has_text="as it runs").text_content() == "as it runs, 1.5 swings a minute"
    page.set_viewport_size({"width": 390, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    assert findings(page) == []
    page.close()
    assert wrong == []


def test_the_page_stands_still_for_who_wants_no_motion(browser: Browser, tmp_path: Path) -> None:
    file = tmp_path / "motion.html"
    file.write_bytes(player_page(Mechanism(), OFFSET, name="Sieve"))
    page = browser.new_page(reduced_motion="reduce")
    page.goto(file.as_uri())
    assert page.get_by_role("button", name="Play").is_visible()
    before = page.locator("#crank").get_attribute("transform")
    page.wait_for_timeout(200)
    assert page.locator("#crank").get_attribute("transform") == before
    page.close()


def test_the_files_are_accessible_and_as_wide_as_the_window(browser: Browser, tmp_path: Path) -> None:
    found = fronts.front(fronts.FOUR[:2], designs=3)
    report = design_report(Subject(found.problem, result_of(found, "kept"), 1, run="kept", versions={}))
    # Of the figures one will do: axe takes half a minute for all their lines.
    pictures = [block for section in report.sections for block in section.blocks if isinstance(block, Picture)]
    drawing = next(picture for picture in pictures if picture.title.startswith("The linkage"))
    sections = [
        replace(
            part, blocks=tuple(block for block in part.blocks if block is drawing or not isinstance(block, Picture))
        )
        for part in report.sections
    ]
    files = {
        "report": html_file(replace(report, sections=tuple(part for part in sections if part.blocks))),
        "motion": player_page(fronts.MACHINE, BELOW, name="Sieve", design="design 3"),
    }
    for name, content in files.items():
        file = tmp_path / f"{name}.html"
        file.write_bytes(content)
        page = browser.new_page(viewport={"width": 1440, "height": 900}, reduced_motion="reduce")
        page.goto(file.as_uri())
        assert findings(page) == [], name
        for width in (1440, 390):
            page.set_viewport_size({"width": width, "height": 900})
            assert page.evaluate("document.documentElement.scrollWidth") == width, name
        page.close()
