"""Two-mass rod and series: where they are exact, their published values, and how their error grows."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.classical.approximations import (
    TORQUE,
    approximation_errors_over_offset,
    compare_approximations,
    drive_torque_equation_48,
    link_mass_properties,
    mechanism_with_lumped_rod,
    rod_mass_share_at_crank_pin,
    rotating_and_reciprocating_masses,
    series_acceleration,
    series_torque,
)
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from tests.model.cases import SMOOTH, linkage_of, random_designs, random_machine

THETA = np.linspace(0.0, 2.0 * math.pi, 73)
FEEDER = Mechanism(speed=251.0, crank=RigidLink(mass=0.2), rod=RigidLink(mass=0.5), slider_mass=0.8)
"""Obaseki and Alfred, Table 1: crank 0.2, rod 0.5, slider 0.8 kg; both links half and half."""


def test_two_masses_are_exact_for_a_rod_of_inertia_m_a_b() -> None:
    random = np.random.default_rng(71)
    for design in random_designs(40, seed=72, least_margin=0.02):
        machine = random_machine(random)
        a = random.uniform(0.0, 1.0) * design[1]
        mass = random.uniform(0.1, 3.0)
        rod = RigidLink(mass=mass, centre=a, inertia=mass * a * (design[1] - a))
        machine = replace(machine, rod=rod)
        linkage = linkage_of(design, machine.branch)
        exact, two = cycle(machine, linkage, THETA), cycle(mechanism_with_lumped_rod(machine, linkage), linkage, THETA)
        for name in ("torque", "guide", "pivot_x", "pivot_y"):
            one, other = getattr(exact, name), getattr(two, name)
            np.testing.assert_allclose(other, one, rtol=0, atol=1e-12 * np.abs(one).max())


def test_two_masses_are_wrong_for_any_other_inertia() -> None:
    linkage = Linkage(0.14, 0.31, -0.06)
    machine = replace(SMOOTH, rod=RigidLink(mass=1.3))  # m l^2 / 12 rather than m l^2 / 4
    exact, two = cycle(machine, linkage, THETA), cycle(mechanism_with_lumped_rod(machine, linkage), linkage, THETA)
    assert np.abs(exact.torque - two.torque).max() > 1e-3 * np.abs(exact.torque).max()


def test_masses_of_the_feeder_are_lumped_half_and_half() -> None:
    linkage = Linkage(0.040, 0.064, -0.020)
    # By moments about the pins, Eqs. 32 to 36: 0.25 + 0.1 and 0.25 + 0.8 kg.
    assert rotating_and_reciprocating_masses(FEEDER, linkage) == pytest.approx((0.35, 1.05), rel=1e-14)
    off_centre = replace(FEEDER, rod=RigidLink(mass=0.5, centre=0.016))
    assert rotating_and_reciprocating_masses(off_centre, linkage) == pytest.approx((0.475, 0.925), rel=1e-14)
    assert rotating_and_reciprocating_masses(off_centre, linkage, crank_pin_share=0.5)[1] == pytest.approx(
        1.05, rel=1e-14
    )


def test_lumping_keeps_mass_and_mass_centre() -> None:
    linkage = Linkage(0.14, 0.31, -0.06)
    two = mechanism_with_lumped_rod(SMOOTH, linkage)
    crank, rod = link_mass_properties(SMOOTH.crank, 0.14), link_mass_properties(SMOOTH.rod, 0.31)
    whole = link_mass_properties(two.crank, 0.14)
    assert whole.mass + two.slider_mass == pytest.approx(crank.mass + rod.mass + SMOOTH.slider_mass, rel=1e-14)
    added = (two.slider_mass - SMOOTH.slider_mass) * 0.31
    assert added == pytest.approx(rod.mass * rod.centre, rel=1e-14)
    # About the pivot the crank has gained a point mass at its pin.
    about = whole.inertia + whole.mass * (whole.centre**2 + whole.centre_across**2)
    before = crank.inertia + crank.mass * crank.centre**2
    assert about == pytest.approx(before + rod_mass_share_at_crank_pin(SMOOTH, linkage) * rod.mass * 0.14**2, rel=1e-14)


def test_a_mass_centre_beyond_the_pins_cannot_be_lumped() -> None:
    machine = Mechanism(rod=RigidLink(mass=1.0, centre=-0.01))
    with pytest.raises(InputError, match=r"mass centre between the pins; got -10 mm"):
        mechanism_with_lumped_rod(machine, Linkage(0.1, 0.3))
    with pytest.raises(InputError, match=r"share of the mass must be from 0 to 1; got 1\.5"):
        mechanism_with_lumped_rod(Mechanism(), Linkage(0.1, 0.3), crank_pin_share=1.5)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_series_are_the_first_power_of_crank_over_rod(branch: str) -> None:
    """Halving the ratio quarters the remainder of the torque; that of the acceleration has no second power."""
    errors = []
    for ratio in (0.02, 0.01, 0.005):
        linkage = Linkage(1.0, 1.0 / ratio, 0.0, branch)  # type: ignore[arg-type]
        at = linkage.at(THETA, speed=2.0)
        exact_torque = 3.0 * at.slider_velocity / 2.0 * at.slider_acceleration
        error = np.abs(series_acceleration(linkage, THETA, speed=2.0) - at.slider_acceleration).max()
        torque = np.abs(series_torque(linkage, THETA, speed=2.0, reciprocating_mass=3.0) - exact_torque).max()
        errors.append((error, torque))
    for finer, coarser in zip(errors[1:], errors, strict=False):
        assert np.divide(coarser, finer) == pytest.approx([8.0, 4.0], rel=0.05)
    assert max(errors[0]) < 5.0 * 12.0 * 0.02**2


def test_series_acceleration_has_the_published_extremes() -> None:
    """Obaseki and Alfred, Table 3, "existing model", with the opposite axis: k = 38.1, c = 152.4 mm, 20.994 rad/s."""
    ends = series_acceleration(Linkage(0.0381, 0.1524), [math.pi, 0.0], speed=20.994)
    # Given with eight digits.
    np.testing.assert_allclose(ends, [12.594375, -20.990625], rtol=0, atol=5e-7)


@pytest.mark.parametrize(
    ("offset", "of_s", "of_equation_20"), [(0.0, 80.02, 70.94), (0.010, 176.00, 168.34), (0.020, 772.30, 769.23)]
)
def test_peaks_of_the_published_torque_formula(offset: float, of_s: float, of_equation_20: float) -> None:
    """The paper prints 80, 120 and 250 N m. Its formula gives none but the first, in one of its two readings.

    Computed once more from Eqs. 6, 7, 20 and 48 as they stand, in the paper's own notation.
    """
    k, c, w, m2, m3 = 0.040, 0.064, 251.0, 0.35, 1.05
    t = np.linspace(0.0, 2.0 * math.pi, 7201)
    lever = offset + k * np.sin(t)
    under = c * c - lever**2
    slope = k * (k * np.cos(2.0 * t) - offset * np.sin(t)) / under**0.5 + (k * np.cos(t) * lever) ** 2 / under**1.5
    equation_20 = -w * w * (k * np.cos(t) + slope)
    alpha = np.arcsin(lever / c)
    for figure, a_s, flag in ((of_s, -equation_20, False), (of_equation_20, equation_20, True)):
        torque = k * -(m2 * w * w * k * np.cos(t) + m3 * a_s) * np.tan(alpha)
        found = drive_torque_equation_48(
            Linkage(k, c, -offset), t, speed=w, rotating_mass=m2, reciprocating_mass=m3, as_equation_20=flag
        )
        np.testing.assert_allclose(found, -torque, rtol=0, atol=1e-12 * np.abs(torque).max())
        assert np.abs(found).max() == pytest.approx(figure, rel=0.0, abs=0.02)  # peaks fall between the angles


def test_tangent_formula_mirrors_on_the_crossed_branch() -> None:
    masses = {"speed": 9.0, "rotating_mass": 0.4, "reciprocating_mass": 1.2}
    for flag in (False, True):
        one = drive_torque_equation_48(Linkage(0.05, 0.2, 0.02), THETA, **masses, as_equation_20=flag)
        other = drive_torque_equation_48(
            Linkage(0.05, 0.2, 0.02, "crossed"), math.pi - THETA, **masses, as_equation_20=flag
        )
        np.testing.assert_allclose(other, -one, rtol=0, atol=1e-12)


def test_comparison_is_of_inertia_alone_at_constant_speed() -> None:
    linkage = Linkage(0.14, 0.31, -0.06)
    found = compare_approximations(SMOOTH, linkage, THETA)
    bare = replace(SMOOTH, loads=(), gravity=(0.0, 0.0), acceleration=0.0)
    exact = cycle(bare, linkage, THETA)
    np.testing.assert_array_equal(found.torque, exact.torque)
    np.testing.assert_array_equal(found.acceleration, exact.slider_acceleration)
    assert tuple(found.torques) == TORQUE
    reciprocating = rotating_and_reciprocating_masses(SMOOTH, linkage)[1]
    np.testing.assert_allclose(
        found.torques["series"],
        series_torque(linkage, THETA, speed=SMOOTH.speed, reciprocating_mass=reciprocating),
        rtol=1e-14,
    )
    with pytest.raises(InputError, match="need a crank speed"):
        compare_approximations(Mechanism(), linkage, THETA)


def test_errors_of_the_series_grow_with_the_offset_and_those_of_the_exact_split_do_not() -> None:
    a, b = 0.024, 0.040
    machine = replace(FEEDER, rod=RigidLink(mass=0.5, centre=a, inertia=0.5 * a * b))
    found = approximation_errors_over_offset(machine, Linkage(0.040, 0.064), [0.0, 0.010, 0.020])
    assert np.all(found.torques[TORQUE[0]] < 1e-12)
    assert np.all(found.torques[TORQUE[1]] > 1e-2)
    assert np.all(np.diff(found.accelerations["series"]) > 0.0)
    assert np.all(np.diff(found.torques["k F tan(alpha)"]) > 0.0)
    with pytest.raises(AssemblyError, match="full rotation"):
        approximation_errors_over_offset(machine, Linkage(0.040, 0.064), [0.030])


def test_error_of_a_torque_that_is_zero_throughout_is_not_defined() -> None:
    found = approximation_errors_over_offset(Mechanism(speed=3.0), Linkage(0.05, 0.2), 0.0)
    assert np.isnan(found.torques["series"][0])
    assert found.accelerations["series"][0] > 0.0
