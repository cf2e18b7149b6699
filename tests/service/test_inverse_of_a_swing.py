"""Crank angles of random swings for the place of their slider: those within the swing, and all of these."""

from __future__ import annotations

import math

import numpy as np

from slidercrank.model.swing.swing import require_swing, swing_between_crank_angles
from slidercrank.service.questions.inverse.analysis import numbers
from tests.model.swing.swings import random_swings


def test_the_angle_that_a_place_comes_from_is_found_within_the_swing() -> None:
    """Both ends included, on both branches and past dead points, where a place is passed twice."""
    random, twice = np.random.default_rng(3), 0
    for mechanism, linkage, swing in random_swings(40, seed=99):
        own = require_swing(mechanism, linkage, swing)
        between = swing_between_crank_angles(mechanism, own, swing)
        low, high = sorted(math.degrees(angle) for angle in (between.start, between.end))
        for share in (0.0, 1.0, *random.random(3)):
            angle = between.start + (between.end - between.start) * share
            place = float(own.at(angle).slider_position)
            found = numbers(mechanism, linkage, swing=swing, slider_position=place)["solutions"]
            angles = [each["crank_angle_deg"] for each in found]
            assert min(abs(each - math.degrees(angle)) for each in angles) < 1e-5
            assert low - 1e-6 <= min(angles) <= max(angles) <= high + 1e-6
            twice += len(angles) == 2
    assert twice > 5
