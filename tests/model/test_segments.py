"""The crowded angle and the crank angles of slider positions."""

from __future__ import annotations

import math

import numpy as np

from slidercrank.model.dynamics.segments import (
    crank_angle_at,
    crank_angle_from_crowded,
    crowded_from_crank_angle,
    crowding_parameter,
)
from slidercrank.model.linkage.linkage import Linkage
from tests.model.cases import random_designs


def test_crowded_angle_leads_back_to_the_crank_angle() -> None:
    random = np.random.default_rng(71)
    for r, l, e in random_designs(100, seed=71):
        kappa = crowding_parameter(r, l, e)
        assert 0.0 < kappa <= 1.0
        for theta in random.uniform(-7.0, 14.0, 20):
            tau = crowded_from_crank_angle(theta, kappa)
            assert abs(tau - (theta - 0.5 * math.pi)) <= 0.5 * math.pi  # the same quarter turn
            # The map stretches by 1 / kappa at most.
            assert (
                crank_angle_from_crowded(tau, kappa) == np.float64(theta)
                or abs(crank_angle_from_crowded(tau, kappa) - theta) < 1e-14 / kappa
            )


def test_crowded_angle_grows_by_a_turn_with_every_turn() -> None:
    theta = np.linspace(-6.5, 13.0, 2000)
    tau = np.array([crowded_from_crank_angle(angle, 0.2) for angle in theta])
    assert np.all(np.diff(tau) > 0.0)
    turned = np.array([crowded_from_crank_angle(angle + 2.0 * math.pi, 0.2) for angle in theta])
    np.testing.assert_allclose(turned - tau, 2.0 * math.pi, rtol=1e-13)


def test_angles_crowd_where_the_linkage_comes_close_to_locking() -> None:
    kappa = crowding_parameter(0.1, 0.1501, 0.05)
    tau = np.linspace(0.0, 2.0 * math.pi, 64, endpoint=False)
    theta = np.array([crank_angle_from_crowded(angle, kappa) for angle in tau])
    gaps = np.diff(theta)
    assert gaps.min() < 0.3 * gaps.max()
    closest = theta[np.argmin(gaps)] % math.pi
    assert abs(closest - 0.5 * math.pi) < 0.1


def test_slider_is_at_a_position_at_the_crank_angles_found_for_it() -> None:
    random = np.random.default_rng(72)
    for r, l, e in random_designs(200, seed=72):
        linkage = Linkage(r, l, e)
        inner, outer = linkage.dead_centres
        x = float(inner + random.uniform(0.001, 0.999) * (outer - inner))
        outward = []
        for second in (False, True):
            at = linkage.at(crank_angle_at(x, r, l, e, second), speed=1.0)
            # acos loses half the digits towards the dead centres; at a 1000th of the stroke 1e-16 / 0.03 remain.
            assert abs(at.slider_position - x) < 1e-12 * l
            outward.append(bool(at.slider_velocity > 0.0))
        assert sorted(outward) == [False, True]
