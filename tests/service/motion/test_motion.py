"""The moving linkage: what the page looks up is the model's motion, and both files show it whole."""

from __future__ import annotations

import io
import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser

from slidercrank.model.errors import AssemblyError
from slidercrank.model.linkage import Linkage
from slidercrank.model.mechanism import Mechanism
from slidercrank.service.designs.cycle_table import cycle_table
from slidercrank.service.motion.animated_gif import FRAMES, MILLISECONDS, animated_gif
from slidercrank.service.motion.player_page import player_page
from tests.service import fronts
from tests.service.page.conftest import browser

__all__ = ["browser"]  # the fixture

LINKAGES = {
    "offset": Linkage(0.14, 0.31, 0.06),
    "below": Linkage(0.14, 0.31, -0.06),
    "in line": Linkage(0.04, 0.2, 0.0),
    "crossed": Linkage(0.14, 0.31, 0.06, "crossed"),
    "watch": Linkage(2e-6, 7e-6, 1e-6),
    "crane": Linkage(30.0, 200.0, -25.0),
}


def machine(linkage: Linkage) -> Mechanism:
    return replace(fronts.MACHINE, branch=linkage.branch)


def data_of(page: bytes) -> dict[str, object]:
    match = re.search(r'<script type="application/json" id="data">(.*?)</script>', page.decode())
    assert match is not None
    found: dict[str, object] = json.loads(match[1])
    return found


@pytest.mark.parametrize("name", LINKAGES)
def test_the_page_has_the_curves_of_the_model(name: str) -> None:
    linkage = LINKAGES[name]
    data = data_of(player_page(machine(linkage), linkage, name="Sieve", number=3))
    table = {column.key: column.values for column in cycle_table(machine(linkage), linkage, angles=360)}
    curves = data["curves"]
    assert isinstance(curves, dict)
    assert len(curves) == 5
    for key, values in curves.items():
        np.testing.assert_allclose(values, table[key], rtol=1e-6, atol=1e-9 * max(map(abs, table[key])))
    np.testing.assert_allclose(data["slider"], table["slider_position_mm"], rtol=1e-9, atol=1e-8)
    # Crank and rod, put one behind the other, end at the slider pin.
    turn = np.radians(np.arange(360))
    rod = np.radians(data["rod"])
    l = 1e3 * float(linkage.rod)
    x = data["crank"] * np.cos(turn) + l * np.cos(rod)
    y = data["crank"] * np.sin(turn) + l * np.sin(rod)
    np.testing.assert_allclose(x, data["slider"], atol=1e-7 * l)
    np.testing.assert_allclose(y, data["offset"], atol=1e-7 * l)


@pytest.mark.parametrize("name", [r"$\frac{ <script>alert(1)</script> &amp; ${data} $title", "Größe 寸法", ""])
def test_any_name_can_be_shown(name: str) -> None:
    page = player_page(Mechanism(), LINKAGES["offset"], name=name, number=1).decode()
    assert page.count("<script") == 2
    assert "<title>" in page


def test_a_linkage_that_does_not_turn_fully_is_refused() -> None:
    for make in (player_page, animated_gif):
        with pytest.raises(AssemblyError, match="rod must exceed"):
            make(Mechanism(), Linkage(0.1, 0.11, 0.05), name="x")


def test_the_picture_is_one_turn_at_the_same_scale_in_both_directions() -> None:
    linkage = LINKAGES["in line"]
    content = animated_gif(Mechanism(), linkage, name=r"$\frac{ Größe")
    assert len(content) < 1_000_000
    frames = []
    with Image.open(io.BytesIO(content)) as picture:
        assert getattr(picture, "n_frames", 1) == FRAMES
        assert picture.info["duration"] == MILLISECONDS
        assert picture.info["loop"] == 0
        for step in range(0, FRAMES, FRAMES // 8):
            picture.seek(step)
            frames.append(np.asarray(picture.convert("RGB")).astype(int))
    assert (frames[0][0, 0] == 255).all()
    # What has the colour of links reaches over the circle of the crank pin, and along it to the far end of the rod.
    link = np.array([0xCF, 0xDC, 0xE8])
    where = np.concatenate([np.argwhere(np.abs(frame - link).max(axis=2) <= 6) for frame in frames])
    tall, wide = np.ptp(where, axis=0)
    width = 0.05 * 240.0  # mm, of a link
    assert wide / tall == pytest.approx((40.0 + 240.0 + width) / (80.0 + width), rel=0.02)


def test_the_page_plays_in_a_browser_and_fetches_nothing(browser: Browser, tmp_path: Path) -> None:
    linkage = LINKAGES["below"]
    mechanism = replace(machine(linkage), speed=-4.0)
    file = tmp_path / "motion.html"
    file.write_bytes(player_page(mechanism, linkage, name="Sieve", number=3))
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


def test_the_page_stands_still_for_who_wants_no_motion(browser: Browser, tmp_path: Path) -> None:
    file = tmp_path / "motion.html"
    file.write_bytes(player_page(Mechanism(), LINKAGES["offset"], name="Sieve"))
    page = browser.new_page(reduced_motion="reduce")
    page.goto(file.as_uri())
    assert page.get_by_role("button", name="Play").is_visible()
    before = page.locator("#crank").get_attribute("transform")
    page.wait_for_timeout(200)
    assert page.locator("#crank").get_attribute("transform") == before
    page.close()


def test_a_machine_turns_its_own_way_round() -> None:
    assert data_of(player_page(replace(Mechanism(), speed=-4.0), LINKAGES["offset"], name=""))["direction"] == -1
    data = data_of(player_page(replace(Mechanism(), speed=4.0), LINKAGES["offset"], name=""))
    assert data["direction"] == 1
    assert data["turnsPerSecond"] == pytest.approx(4.0 / (2.0 * math.pi))
