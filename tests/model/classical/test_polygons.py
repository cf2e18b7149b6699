"""Kinematic polygons: vertices, and the motion read off them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.classical.loop_equations import Polygons, motion_polygons
from slidercrank.model.errors import AssemblyError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch
from tests.model.cases import linkage_of, random_designs


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_motion_read_off_the_polygons_is_that_of_the_closed_form(branch: Branch) -> None:
    designs = random_designs(2000, seed=51, least_margin=0.01)
    theta = np.random.default_rng(52).uniform(-4.0, 9.0, 2000)
    linkage = linkage_of(designs, branch)
    at = linkage.at(theta, speed=-15.0, acceleration=-10.0)
    found = motion_polygons(linkage, theta, speed=-15.0, acceleration=-10.0)
    steep = 1.0 / np.abs(np.cos(at.rod_angle))
    slider = found.position[:, 2]
    np.testing.assert_allclose(slider, np.stack([at.slider_position, linkage.offset], axis=1), rtol=1e-12)
    for polygon, slider_rate, power in (
        (found.velocity, at.slider_velocity, 1),
        (found.acceleration, at.slider_acceleration, 3),
    ):
        np.testing.assert_array_equal(polygon[:, -1, 1], 0.0)
        scale = 225.0 * steep**power
        np.testing.assert_allclose(polygon[:, -1, 0] / scale, slider_rate / scale, atol=1e-13)
    np.testing.assert_allclose(found.rod_velocity, at.rod_velocity, atol=1e-11)
    np.testing.assert_allclose(found.rod_acceleration / steep**3, at.rod_acceleration / steep**3, atol=1e-11)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_sides_have_the_published_lengths_and_directions(branch: Branch) -> None:
    """Boyle and Liu, Fig. 2 and Fig. 6: normal parts lie along the links, tangential ones across."""
    speed, acceleration = -15.0, -10.0
    found = motion_polygons(Linkage(3.0, 8.0, 2.0, branch), math.radians(-30.0), speed=speed, acceleration=acceleration)
    (origin, pin, slider), (_, a, b) = found.position, found.velocity
    _, a11, a1, b11, b1 = found.acceleration
    np.testing.assert_array_equal(origin, 0.0)
    assert np.hypot(*pin) == pytest.approx(3.0, rel=1e-15)
    assert np.hypot(*(slider - pin)) == pytest.approx(8.0, rel=1e-15)
    assert slider[1] == 2.0
    rod = slider - pin
    assert np.hypot(*a) == pytest.approx(45.0, rel=1e-15)
    assert np.hypot(*(b - a)) == pytest.approx(8.0 * abs(found.rod_velocity), rel=1e-14)
    assert np.hypot(*a11) == pytest.approx(3.0 * speed**2, rel=1e-15)
    assert np.hypot(*(a1 - a11)) == pytest.approx(3.0 * abs(acceleration), rel=1e-13)
    assert np.hypot(*(b11 - a1)) == pytest.approx(8.0 * found.rod_velocity**2, rel=1e-13)
    assert np.hypot(*(b1 - b11)) == pytest.approx(8.0 * abs(found.rod_acceleration), rel=1e-13)
    for one, other in ((a, pin), (b - a, rod), (a1 - a11, pin), (b1 - b11, rod)):
        assert one @ other == pytest.approx(0.0, abs=1e-12 * np.hypot(*one) * np.hypot(*other))
    # Fig. 3 of the paper: the sense of the rod's rotation from the order of the vertices.
    assert (found.rod_velocity >= 0.0) == ((slider[0] > pin[0]) == (b[1] >= a[1]))
    assert (found.rod_acceleration >= 0.0) == ((slider[0] > pin[0]) == (b1[1] >= b11[1]))


def test_twenty_two_coordinates_of_which_nine_are_given() -> None:
    """Boyle and Liu: "With nine given input values, an additional thirteen co-ordinates completely define these"."""
    vertices = len(Polygons.POSITION) + len(Polygons.VELOCITY) + len(Polygons.ACCELERATION)
    assert 2 * vertices == 9 + 13


def test_polygons_broadcast_and_refuse_what_cannot_be_assembled() -> None:
    found = motion_polygons(Linkage(0.1, [[0.3], [0.4]]), np.zeros(5), speed=np.ones(5))
    assert found.position.shape == found.velocity.shape == (2, 5, 3, 2)
    assert found.acceleration.shape == (2, 5, 5, 2)
    with pytest.raises(AssemblyError, match=r"at 90\.000 deg"):
        motion_polygons(Linkage(0.1, 0.05), 0.5 * math.pi)
