"""The moving linkage: what the page looks up is the model's motion, and both files show it whole."""

from __future__ import annotations

import io
import json
import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from PIL import Image

from slidercrank.model.errors import AssemblyError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.engine import FourStroke
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.service.designs.design_curves import cycle_table
from slidercrank.service.motion.animated_gif import FRAMES, MILLISECONDS, animated_gif
from slidercrank.service.motion.player_page import player_page
from tests.service import fronts

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


def data_of(page: bytes) -> dict[str, Any]:
    match = re.search(r'<script type="application/json" id="data">(.*?)</script>', page.decode())
    assert match is not None
    found: dict[str, Any] = json.loads(match[1])
    return found


@pytest.mark.parametrize("name", LINKAGES)
def test_the_page_has_the_curves_of_the_model(name: str) -> None:
    linkage = LINKAGES[name]
    data = data_of(player_page(machine(linkage), linkage, name="Sieve", design="design 3"))
    table = {column.key: column.values for column in cycle_table(machine(linkage), linkage, angles=360)}
    curves = data["curves"]
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
    page = player_page(Mechanism(), LINKAGES["offset"], name=name, design="design 1").decode()
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
        for step in range(0, FRAMES, FRAMES // 12):
            picture.seek(step)
            frames.append(np.asarray(picture.convert("RGB")).astype(int))
    assert (frames[0][0, 0] == 255).all()
    # What has the colour of links reaches over the circle of the crank pin, and along it to the far end of the rod.
    link = np.array([0xCF, 0xDC, 0xE8])
    where = np.concatenate([np.argwhere(np.abs(frame - link).max(axis=2) <= 6) for frame in frames])
    tall, wide = np.ptp(where, axis=0)
    width = 0.05 * 240.0  # mm, of a link
    assert wide / tall == pytest.approx((40.0 + 240.0 + width) / (80.0 + width), rel=0.02)


def test_a_machine_turns_its_own_way_round() -> None:
    assert data_of(player_page(replace(Mechanism(), speed=-4.0), LINKAGES["offset"], name=""))["direction"] == -1
    data = data_of(player_page(replace(Mechanism(), speed=4.0), LINKAGES["offset"], name=""))
    assert data["direction"] == 1
    assert data["perSecond"] == pytest.approx(4.0 / (2.0 * math.pi))


def four_strokes() -> Mechanism:
    load = FourStroke(
        bore=0.086,
        low=1e5,
        high=5e6,
        clearance=0.1,
        compression_exponent=1.3,
        expansion_exponent=1.25,
        exhaust=1.2e5,
    )
    return replace(Mechanism(speed=300.0), loads=(load,))


def test_a_cycle_of_two_turns_plays_both_with_the_pressure() -> None:
    linkage = LINKAGES["in line"]
    page = player_page(four_strokes(), linkage, name="engine")
    data = data_of(page)
    assert data["turns"] == 2
    assert b'max="720"' in page
    assert b"2 turns of the crank" in page
    assert {len(values) for values in (data["slider"], data["rod"], *data["curves"].values())} == {720}
    pressure = np.array(data["curves"]["pressure_1_bar"])
    # Open branch, head at the outer dead centre: intake from 0 deg, compression to 360, expansion to 540, exhaust.
    assert pressure[1:180] == pytest.approx(1.0, rel=1e-6)
    assert pressure[361] == pytest.approx(50.0, rel=0.01)
    assert pressure[541:720] == pytest.approx(1.2, rel=1e-6)
    assert data["slider"][:360] == pytest.approx(data["slider"][360:], abs=1e-6)
    marks = {float(x) for x in re.findall(r'class="dead" x1="([\d.]+)"', page.decode())}
    assert marks == {0.0, 90.0, 180.0, 270.0}


@pytest.mark.slow
def test_the_picture_of_a_cycle_of_two_turns_has_both() -> None:
    with Image.open(io.BytesIO(animated_gif(four_strokes(), LINKAGES["in line"], name="engine"))) as picture:
        assert getattr(picture, "n_frames", 1) == 2 * FRAMES
        pictures = []
        for step in (5, FRAMES + 5):
            picture.seek(step)
            pictures.append(np.asarray(picture.convert("RGB")).astype(int))
    differs = np.argwhere((pictures[0] != pictures[1]).any(axis=2))
    foot = pictures[0].shape[0] - 35  # 0.35 inch of 100 dots: angle and pressure are told there
    assert len(differs) > 0
    assert differs[:, 0].min() >= foot
