"""Newton-Raphson on the loop equations against the closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.classical.loop_equations import solve_loop
from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch
from tests.model.cases import linkage_of, random_designs


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_iteration_agrees_with_the_closed_form(branch: Branch) -> None:
    designs = random_designs(5000, seed=41, least_margin=0.01)
    theta = np.random.default_rng(42).uniform(-10.0, 10.0, 5000)
    linkage = linkage_of(designs, branch)
    found = solve_loop(linkage, theta, speed=-3.0, acceleration=20.0)
    at = linkage.at(theta, speed=-3.0, acceleration=20.0)
    np.testing.assert_allclose(found.slider_position / linkage.rod, at.slider_position / linkage.rod, atol=1e-12)
    np.testing.assert_allclose(np.exp(1j * (found.rod_angle - at.rod_angle)), 1.0, atol=1e-12)
    # Rates grow with 1 / cos(phi), to its third power in the acceleration: relative to the greatest of them.
    steep = 1.0 / np.abs(np.cos(at.rod_angle))
    for name, power in (
        *(("slider_velocity", 1), ("rod_velocity", 1)),
        *(("slider_acceleration", 3), ("rod_acceleration", 3)),
    ):
        scale = 20.0 * steep**power
        np.testing.assert_allclose(getattr(found, name) / scale, getattr(at, name) / scale, atol=1e-12)
    assert found.iterations.min() >= 1
    assert found.iterations.max() <= 10


def test_iteration_takes_more_steps_close_to_locking() -> None:
    linkage = Linkage(0.1, 0.1 + 1e-9, 0.0)
    steps = solve_loop(linkage, [0.0, 0.5 * math.pi]).iterations
    assert steps[0] == 1  # the rod starts where it ends
    assert steps[1] > 10


def test_published_start_finds_the_published_assembly() -> None:
    """J. Gupta, course report ME748, section 3.1: from a rod angle of 180 deg and a slider position of 40 mm."""
    theta = np.linspace(0.0, 2.0 * math.pi, 200)
    sieve = Linkage(0.140, 0.310, -0.060)
    found = solve_loop(sieve, theta, start=(0.040, 0.0))  # the report's rod points the other way
    np.testing.assert_allclose(found.slider_position, sieve.at(theta).slider_position, rtol=1e-13)


def test_start_decides_the_branch() -> None:
    linkage = Linkage(3.0, 8.0, 2.0)
    found = solve_loop(linkage, 0.3, start=(0.0, 3.0))
    assert found.slider_position == pytest.approx(Linkage(3.0, 8.0, 2.0, "crossed").at(0.3).slider_position, rel=1e-13)


def test_what_cannot_be_assembled_is_refused_with_its_angle() -> None:
    with pytest.raises(AssemblyError, match=r"at 90\.000 deg"):
        solve_loop(Linkage(0.1, 0.09), [0.0, 0.5 * math.pi])


def test_what_does_not_converge_is_refused_with_its_angle() -> None:
    with pytest.raises(InputError, match=r"must converge within 2 steps; it did not at crank angle 57\.2958 deg"):
        solve_loop(Linkage(0.1, 0.12), [0.0, 1.0], iteration_limit=2)
    with pytest.raises(InputError, match="starting point must be finite"):
        solve_loop(Linkage(0.1, 0.12), 0.0, start=(math.nan, 0.0))
