"""One-at-a-time variation of the dimensions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.dimension_variation import motion_variations
from slidercrank.model.linkage.linkage import Linkage

# J. Gupta, "Offset-Slider Crank Mechanism", course report ME748: crank 140 -> 150 mm, rod 310 -> 320 mm.
SIEVE = Linkage(0.14, 0.31, 0.06)
SPEED = 10.0 * math.pi
TURN = np.linspace(0.0, 2.0 * math.pi, 181)


def test_each_change_is_made_alone() -> None:
    found = motion_variations(
        SIEVE, [("crank", 0.15), ("rod", 0.32), ("offset", 0.0)], TURN, speed=SPEED, acceleration=3.0
    )
    others = (Linkage(0.15, 0.31, 0.06), Linkage(0.14, 0.32, 0.06), Linkage(0.14, 0.31, 0.0))
    for variation, linkage in zip(found.varied, others, strict=True):
        expected = linkage.at(TURN, speed=SPEED, acceleration=3.0)
        np.testing.assert_array_equal(variation.motion.slider_acceleration, expected.slider_acceleration)
    np.testing.assert_array_equal(found.nominal.slider_velocity, SIEVE.at(TURN, speed=SPEED).slider_velocity)


def test_small_variation_is_the_first_order_influence() -> None:
    step = 1e-6
    found = motion_variations(SIEVE, [("crank", 0.14 + step), ("rod", 0.31 + step), ("offset", 0.06 + step)], TURN)
    i = SIEVE.error_influences(TURN)
    for variation, influence in zip(found.varied, (i.crank, i.rod, i.offset), strict=True):
        moved = variation.motion.slider_position - found.nominal.slider_position
        # The second order is step / l, 1e-5.
        np.testing.assert_allclose(moved / step, influence, rtol=0.0, atol=2e-5)


def test_longer_crank_of_case_two_lengthens_the_stroke_and_a_longer_rod_hardly_does() -> None:
    found = motion_variations(
        SIEVE, [("crank", 0.15), ("rod", 0.32)], np.linspace(0.0, 2.0 * math.pi, 20001), speed=SPEED
    )
    strokes = [np.ptp(motion.slider_position) for motion in (found.nominal, *(v.motion for v in found.varied))]
    exact = [SIEVE.stroke, Linkage(0.15, 0.31, 0.06).stroke, Linkage(0.14, 0.32, 0.06).stroke]
    np.testing.assert_allclose(strokes, exact, rtol=1e-7)
    assert strokes[1] - strokes[0] > 0.02
    assert abs(strokes[2] - strokes[0]) < 0.002
    accelerations = [np.abs(v.motion.slider_acceleration).max() for v in found.varied]
    assert accelerations[0] > np.abs(found.nominal.slider_acceleration).max() > accelerations[1]


def test_wrong_changes_are_refused() -> None:
    with pytest.raises(InputError, match="a dimension must be one of crank, rod, offset; got 'speed'"):
        motion_variations(SIEVE, [("speed", 1.0)], TURN)  # type: ignore[list-item]
    with pytest.raises(InputError, match="must be finite"):
        motion_variations(SIEVE, [("crank", math.nan)], TURN)
    with pytest.raises(InputError, match="one linkage is needed"):
        motion_variations(Linkage([0.1, 0.2], 0.5), [("crank", 0.15)], TURN)
    with pytest.raises(AssemblyError, match="rod must exceed"):
        motion_variations(SIEVE, [("crank", 0.3)], TURN)
