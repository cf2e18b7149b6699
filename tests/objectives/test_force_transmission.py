"""Force transmission, against Newton's law written out here and against the transmission angle."""

import math

import numpy as np
import pytest

from slidercrank.model.machine.links import RigidLink
from slidercrank.model.machine.loads import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import quantity

RATIO = quantity("force_transmission")
THETA = np.linspace(0.0, 2.0 * np.pi, 7201)[:-1]


def random_designs(count: int) -> np.ndarray:
    random = np.random.default_rng(7)
    crank, offset = random.uniform(0.02, 0.1, count), random.uniform(-0.05, 0.05, count)
    return np.stack([crank, (crank + abs(offset)) * random.uniform(1.2, 3.0, count), offset], axis=1)


@pytest.mark.parametrize("load", [0.0, 300.0])
def test_a_rod_without_mass_gives_the_sine_of_the_transmission_angle(load: float) -> None:
    loads = (StrokeForce(outward=-load, inward=load),) if load else ()
    machine = Mechanism(speed=30.0, slider_mass=2.0, loads=loads)
    designs = random_designs(50)
    angle = quantity("transmission_angle").evaluate(machine, designs).values
    np.testing.assert_allclose(RATIO.evaluate(machine, designs).values, np.sin(angle), rtol=1e-9)


def test_it_is_the_least_share_of_the_pin_force_of_a_heavy_rod() -> None:
    mass, inertia, slider, load, w = 0.4, 0.002, 2.0, 5000.0, 12.0
    for r, l, e in random_designs(12):
        s = 0.4 * l
        rod = RigidLink(mass=mass, inertia=inertia, centre=s)
        machine = Mechanism(speed=w, slider_mass=slider, rod=rod, loads=(StrokeForce(outward=-load, inward=-load),))
        phi = np.arcsin((e - r * np.sin(THETA)) / l)
        rate = -r * np.cos(THETA) / (l * np.cos(phi)) * w
        turn = (r * np.sin(THETA) * w**2 + l * np.sin(phi) * rate**2) / (l * np.cos(phi))
        a = -r * np.cos(THETA) * w**2 - l * np.cos(phi) * rate**2 - l * np.sin(phi) * turn
        b_x = slider * a + load
        # Moments about the crank pin: the rod's inertia, its centre's acceleration, and minus B at its end.
        g_x = -r * np.cos(THETA) * w**2 - s * np.cos(phi) * rate**2 - s * np.sin(phi) * turn
        g_y = -r * np.sin(THETA) * w**2 - s * np.sin(phi) * rate**2 + s * np.cos(phi) * turn
        moment = inertia * turn + mass * s * (np.cos(phi) * g_y - np.sin(phi) * g_x)
        b_y = (np.sin(phi) * b_x * l - moment) / (l * np.cos(phi))
        swept = np.min(np.abs(b_x) / np.hypot(b_x, b_y))
        found = RATIO.evaluate(machine, np.array([[r, l, e]])).values[0]
        assert math.isclose(found, swept, rel_tol=1e-5, abs_tol=1e-3 * (swept < 1e-2))


def test_nothing_that_gives_a_force_is_said() -> None:
    assert "got none" in (RATIO.lacks(Mechanism(), "undefined") or "")
