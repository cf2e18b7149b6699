"""Peak slider jerk, against differences of the acceleration and a closed form."""

import math

import numpy as np

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import quantity

JERK = quantity("peak_slider_jerk")


def test_it_is_the_greatest_slope_of_the_acceleration_over_time() -> None:
    theta = np.linspace(0.0, 2.0 * np.pi, 40_001)
    random = np.random.default_rng(3)
    for branch in ("open", "crossed"):
        for _ in range(5):
            r = random.uniform(0.02, 0.1)
            e = random.uniform(-0.05, 0.05)
            l = (r + abs(e)) * random.uniform(1.3, 4.0)
            w, alpha = random.uniform(-40.0, 40.0), random.uniform(-50.0, 50.0)
            machine = Mechanism(speed=w, acceleration=alpha, branch=branch)
            x = Linkage(r, l, e, branch).at(theta, speed=1.0)
            # d/dt (x'' w^2 + x' alpha) at constant alpha, x''' by central differences of x''
            third = np.gradient(x.slider_acceleration, theta, edge_order=2)
            swept = np.abs(third * w**3 + 3.0 * x.slider_acceleration * w * alpha).max()
            found = JERK.evaluate(machine, np.array([[r, l, e]])).values[0]
            assert math.isclose(found, swept, rel_tol=1e-5)


def test_a_very_long_rod_gives_the_jerk_of_a_sine() -> None:
    found = JERK.evaluate(Mechanism(speed=10.0), np.array([[0.05, 5e4, 0.0]])).values[0]
    assert math.isclose(found, 0.05 * 10.0**3, rel_tol=1e-5)


def test_without_a_speed_it_is_said_to_need_one() -> None:
    assert "needs a crank speed; got none" in (JERK.unmet_need(Mechanism(), "undefined") or "")
