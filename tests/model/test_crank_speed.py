"""The speed of a crank over its angle: derivatives agree with each other, and the mean is one."""

from __future__ import annotations

import numpy as np
import pytest

from slidercrank.model.dynamics.speed_ratio import speed_ratio_at, speed_ratio_of
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics, SpeedTable

PROFILES = [
    Harmonics(cosines=(0.2, -0.05, 0.03), sines=(0.1, 0.04, -0.02)),
    SpeedTable(angles=(0.2, 1.1, 2.0, 3.5, 5.0), speeds=(9.0, 12.0, 10.0, 8.0, 11.0)),
]


@pytest.mark.parametrize("profile", PROFILES, ids=["harmonics", "table"])
def test_each_derivative_of_the_speed_is_that_of_the_one_before(profile: Harmonics | SpeedTable) -> None:
    """Also beyond a turn. Central differences: the fourth derivatives, up to 30, times the step's square over six."""
    pace = speed_ratio_of(Mechanism(speed=10.0, speed_profile=profile))
    step = 1e-5
    for theta in np.random.default_rng(7).uniform(-10.0, 20.0, 200).tolist():
        here, ahead, behind = (np.array(speed_ratio_at(theta + s * step, pace)) for s in (0.0, 1.0, -1.0))
        if abs(ahead[3] - behind[3]) < 0.01:  # no knot between
            np.testing.assert_allclose(here[1:], (ahead - behind)[:3] / (2.0 * step), rtol=1e-7, atol=1e-8)


@pytest.mark.parametrize("profile", PROFILES, ids=["harmonics", "table"])
def test_the_speed_is_that_of_its_profile_and_one_on_the_mean(profile: Harmonics | SpeedTable) -> None:
    pace = speed_ratio_of(Mechanism(speed=10.0, speed_profile=profile))
    theta = np.linspace(0.0, 2.0 * np.pi, 3000, endpoint=False)
    held = [speed_ratio_at(angle + 2.0 * np.pi * turn, pace)[0] for turn in (-1, 0, 2) for angle in theta.tolist()]
    np.testing.assert_allclose(held, np.tile(profile.speed_ratio(theta), 3), rtol=1e-12)
    assert np.mean(held) == pytest.approx(1.0, rel=1e-6)  # of a cubic spline, whose third derivatives jump at knots
