"""Static forces: the published in-line case, virtual work, and the project's dynamics without masses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.classical.loop_equations import static_forces
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Branch, Mechanism
from tests.model.cases import linkage_of, random_designs

THETA = np.linspace(0.1, 6.3, 50)


def test_in_line_forces_are_the_published_formulas() -> None:
    """In-line Slider Crank Mechanism, report, Amrita School of Engineering, 2021: Eqs. 12 and 13.

    Its load P presses the slider towards the crank; theta_3 is the size of the rod angle above the slider line.
    """
    r, l, p = 0.05, 0.15, 100.0
    found = static_forces(Linkage(r, l), THETA, load=-p)
    rod = np.arcsin(r * np.sin(THETA) / l)
    np.testing.assert_allclose(found.rod_force, p / np.cos(rod), rtol=1e-14)
    np.testing.assert_allclose(found.guide_reaction, p * np.tan(rod), rtol=0, atol=1e-13 * p)
    torque = -p * r * (np.sin(THETA) + np.cos(THETA) * np.tan(rod))
    np.testing.assert_allclose(found.crank_torque, torque, rtol=0, atol=1e-14 * p)
    np.testing.assert_allclose(found.tangential_force, torque / r, rtol=0, atol=1e-12 * p)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_forces_are_those_of_the_dynamics_without_masses(branch: Branch) -> None:
    machine = Mechanism(loads=(StrokeForce(outward=80.0, inward=80.0),), branch=branch)
    for design in random_designs(20, seed=61, least_margin=0.01):
        linkage = linkage_of(design, branch)
        found, at = static_forces(linkage, THETA, load=80.0), cycle(machine, linkage, THETA)
        steep = 1e-13 * 80.0 * np.abs(found.rod_force).max() / 80.0
        np.testing.assert_allclose(found.crank_torque, at.torque, rtol=0, atol=steep)
        np.testing.assert_allclose(found.guide_reaction, at.guide, rtol=0, atol=20.0 * steep)
        rod = np.hypot(at.slider_pin_x, at.slider_pin_y)
        np.testing.assert_allclose(np.abs(found.rod_force), rod, rtol=1e-12)
        phi = linkage.at(THETA).rod_angle
        compression = at.slider_pin_x * np.cos(phi) + at.slider_pin_y * np.sin(phi)
        np.testing.assert_allclose(found.rod_force, compression, rtol=1e-10)


def test_power_of_load_and_crank_is_zero() -> None:
    linkage = Linkage(0.14, 0.31, -0.06)
    found = static_forces(linkage, THETA, load=-50.0)
    velocity = linkage.at(THETA, speed=3.0).slider_velocity
    np.testing.assert_allclose(found.crank_torque * 3.0 - 50.0 * velocity, 0.0, atol=1e-12)


def test_mechanical_advantage_is_load_over_tangential_force_and_infinite_at_dead_centres() -> None:
    linkage = Linkage(0.14, 0.31, -0.06)
    found = static_forces(linkage, THETA, load=-50.0)
    np.testing.assert_allclose(found.mechanical_advantage, 50.0 / np.abs(found.tangential_force), rtol=1e-13)
    np.testing.assert_allclose(found.slider_force_per_torque, 50.0 / np.abs(found.crank_torque), rtol=1e-13)
    np.testing.assert_allclose(static_forces(linkage, THETA, load=0.0).mechanical_advantage, found.mechanical_advantage)
    for branch in ("open", "crossed"):
        dead = Linkage(0.14, 0.31, -0.06, branch).dead_centre_angles
        assert np.all(np.isinf(static_forces(Linkage(0.14, 0.31, -0.06, branch), dead, load=1.0).mechanical_advantage))


def test_loads_and_angles_broadcast_and_are_checked() -> None:
    found = static_forces(Linkage(0.1, [[0.3], [0.4]]), np.zeros(5), load=np.arange(5.0))
    assert found.rod_force.shape == found.mechanical_advantage.shape == (2, 5)
    with pytest.raises(InputError, match="load on the slider must be finite"):
        static_forces(Linkage(0.1, 0.3), 0.0, load=math.nan)
    with pytest.raises(AssemblyError, match="stay within the reachable angles"):
        static_forces(Linkage(0.1, 0.05), 0.5 * math.pi, load=1.0)
