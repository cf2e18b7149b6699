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
from slidercrank.model.turning_cylinder.lever_of_design import lever_machine, lever_swing
from slidercrank.optimise.job import parse_job
from slidercrank.service.drawings.lever_parts import lever_extent, moving_lever_shapes
from slidercrank.service.drawings.shapes import Circle, Line, Outline
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


@pytest.mark.parametrize("lengths", [(0.12, 0.3, -0.02), (0.4, 0.2, 0.05)])
def test_arm_and_ram_of_a_drawing_join_and_stay_within_its_extent(lengths: tuple[float, float, float]) -> None:
    """The ram moves by y = R sin(gamma - direction of OA), its pin on the arm's line through A."""
    problem, linkage = parse_job(SHAPER), Linkage(*lengths)
    assert problem.motion is not None
    machine, _ = lever_machine(problem.mechanism, linkage, problem.motion)
    swing = lever_swing(problem.mechanism, linkage, problem.motion)
    left, bottom, right, top = lever_extent(machine, swing)
    for angle in np.linspace(0.0, 2.0 * np.pi, 13):
        line = complex(machine.sizes.motion_at(np.array([angle])).line[0])
        shapes = moving_lever_shapes(machine, swing, angle)
        pin = -1j * lengths[1] + 0.5 * line
        assert [1e3 * pin.real, 1e3 * pin.imag] in [
            pytest.approx(shape.centre) for shape in shapes if isinstance(shape, Circle)
        ]
        foot = -1j * lengths[1] + 1j * lengths[2] * line
        lug = next(shape for shape in shapes if isinstance(shape, Line))
        assert lug.start == pytest.approx((0.0, -1e3 * lengths[1]), abs=1e-9)
        assert lug.end == pytest.approx((1e3 * foot.real, 1e3 * foot.imag), abs=1e-9)
        ram = next(shape for shape in shapes[3:] if isinstance(shape, Outline))
        x, y = np.transpose(ram.corners)
        assert x.mean() == pytest.approx(500.0 * line.real, abs=1e-6)
        assert left <= x.min() < x.max() <= right
        assert bottom <= y.min() < y.max() <= top


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
