"""Animations of levers and of arms that a crank turns: their parts join at every point of the motion."""

from __future__ import annotations

import io
import json
import math
import re
from typing import Any

import numpy as np
import pytest
from PIL import Image

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import parse_job
from slidercrank.service.motion.animated_gif import FRAMES, animated_gif
from slidercrank.service.motion.player_page import player_page
from tests.optimise.problems import LEVER, SHAPER

CASES = [
    pytest.param(LEVER | {"mechanism": LEVER["mechanism"] | {"pin_angle": "10 deg"}}, (0.35, 0.9, 0.04), id="lever"),
    pytest.param(SHAPER, (0.12, 0.3, -0.02), id="shaper"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("tables", "lengths"), CASES)
def test_lever_and_cylinder_of_the_player_join_at_every_point(
    tables: dict[str, Any], lengths: tuple[float, float, float]
) -> None:
    problem = parse_job(tables)
    page = player_page(problem.mechanism, Linkage(*lengths), name="Lever", swing=problem.motion).decode()
    found = re.search(r'id="data">(.*?)</script>', page)
    assert found is not None
    data = json.loads(found[1])
    crank, rod, offset = (1e3 * length for length in lengths)
    angle, line = (np.exp(1j * np.radians(data[name])) for name in ("angles", "rod"))
    pin = crank * angle * np.exp(1j * math.radians(data["pin"]))
    base = np.array(data["slider"]) + 1j * data["offset"]
    assert np.abs(base) == pytest.approx(rod, rel=1e-12)
    foot = base + 1j * offset * line
    joined = foot + np.array(data["curves"]["length_mm"]) * line  # the curves have seven digits
    assert np.abs(joined - pin).max() < 1e-6 * rod
    for part in ("rod", "slider", "crank", "pivot", "crank-pin", "slider-pin"):
        assert f'id="{part}"' in page


@pytest.mark.slow
@pytest.mark.parametrize(("tables", "lengths"), CASES)
def test_the_gif_of_a_lever_moves(tables: dict[str, Any], lengths: tuple[float, float, float]) -> None:
    problem = parse_job(tables)
    content = animated_gif(problem.mechanism, Linkage(*lengths), name="Lever", swing=problem.motion)
    picture = Image.open(io.BytesIO(content))
    assert getattr(picture, "n_frames", 1) == FRAMES
    frames = []
    for place in (0, FRAMES // 4, FRAMES // 2):
        picture.seek(place)
        frames.append(np.asarray(picture.convert("L")).astype(int))
    assert np.abs(frames[1] - frames[0]).max() > 100
    assert np.abs(frames[2] - frames[1]).max() > 100
