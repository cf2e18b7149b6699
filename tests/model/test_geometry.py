"""The inverse relations: each gives back the dimension that the forward formula was fed with."""

from __future__ import annotations

import numpy as np

from slidercrank.model.kinematics import geometry
from tests.model.cases import random_designs

DESIGNS = random_designs(1000, seed=21)


def test_rod_and_offset_from_stroke_give_back_rod_and_offset() -> None:
    # S - 2 r, which both divide by, is what the offset adds: with a small one it is lost in rounding.
    designs = DESIGNS[np.abs(DESIGNS[:, 2]) > 0.3 * DESIGNS[:, 0]]
    r, l, e = designs.T
    stroke = geometry.stroke(r, l, e)
    kept = stroke / (2.0 * r) > 1.001
    assert kept.sum() > 300
    r, l, e, stroke = r[kept], l[kept], e[kept], stroke[kept]
    # 1e-16 relative error of S over the 1e-3 that S exceeds 2 r by, and the same again for the offset.
    np.testing.assert_allclose(geometry.rod_from_stroke(stroke, r, e), l, rtol=1e-11)
    np.testing.assert_allclose(geometry.offset_from_stroke(stroke, r, l), np.abs(e), rtol=1e-11)


def test_offset_from_excess_angle_gives_back_the_offset() -> None:
    r, l, e = DESIGNS.T
    angle = geometry.excess_stroke_angle(r, l, e)
    found = geometry.offset_from_excess_angle(r, l, np.sin(angle), np.cos(angle))
    # The excess angle is a difference of two arcsines: its rounding 1e-16 counts against angles down to 1e-5.
    np.testing.assert_allclose(found, e, rtol=1e-10)


def test_excess_angle_has_the_sign_of_the_offset() -> None:
    r, l, e = DESIGNS.T
    np.testing.assert_array_equal(np.sign(geometry.excess_stroke_angle(r, l, e)), np.sign(e))


def test_stroke_is_the_difference_of_the_dead_centres() -> None:
    r, l, e = DESIGNS.T
    difference = geometry.outer_dead_centre(r, l, e) - geometry.inner_dead_centre(r, l, e)
    # The difference itself cancels: the form under test is the more exact one.
    np.testing.assert_allclose(geometry.stroke(r, l, e), difference, rtol=1e-12)
