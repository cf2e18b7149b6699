"""A boom, which is an inverted slider-crank, as a slider-crank: lengths, lever and errors of its actuator."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage


def length(frame: float, boom: float, angle: float) -> float:
    """Return the actuator's length by the law of cosines."""
    return math.sqrt(frame * frame + boom * boom - 2.0 * frame * boom * math.cos(angle))


def test_the_triangle_of_a_boom_is_that_of_a_slider_crank_whose_crank_is_held() -> None:
    """Angle between crank and rod, and the lever by virtual work, dL/dbeta, of 200 booms."""
    random = np.random.default_rng(41)
    for _ in range(200):
        frame, boom = random.uniform(0.2, 1.5, 2).tolist()
        angle = float(random.uniform(0.2, 2.9))
        x = length(frame, boom, angle)
        ahead = boom > frame or frame * frame - boom * boom < x * x  # of the crank pin, so that the branch is open
        states = Linkage(frame, boom, 0.0, "open" if ahead else "crossed").from_slider(x)
        assert len(states) == 2  # one to either side of the actuator
        theta = abs(math.remainder(states[0].crank_angle, 2.0 * math.pi))
        pin = np.array([frame * math.cos(theta), frame * math.sin(theta)])
        to_foot, to_boom = -pin, np.array([x, 0.0]) - pin
        between = math.acos(float(to_foot @ to_boom) / frame / boom)
        assert between == pytest.approx(angle, abs=1e-9)
        h = 1e-5
        lever = (length(frame, boom, angle + h) - length(frame, boom, angle - h)) / (2.0 * h)
        assert frame * math.sin(theta) == pytest.approx(lever, rel=1e-7)
        assert lever == pytest.approx(frame * boom * math.sin(angle) / x, rel=1e-7)
