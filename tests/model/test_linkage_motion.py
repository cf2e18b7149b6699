"""Velocities and accelerations against derivatives of positions, taken by independent means."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch
from tests.model.cases import linkage_of, random_designs
from tests.model.contour import distance_to_locking, motion_in_time
from tests.model.virtual_work import path

# The contour loses 1e-16 / reach^2, so linkages closer to locking than 2 % would need looser tolerances.
DESIGNS = random_designs(25, seed=5, least_margin=0.02)
THETA = np.linspace(-3.0, 9.0, 40)
SIGNS: dict[Branch, float] = {"open": 1.0, "crossed": -1.0}
SPEED, ACCELERATION = -7.0, 90.0


def close(actual: Any, expected: Any, scale: float) -> None:
    # Rounding of the contour: 1e-16 / (0.35 * 0.2)^2 of the position, in units of speed^2.
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-12 * scale)


def loop(design: np.ndarray, sign: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return slider position and rod angle as functions of a complex crank angle."""
    r, l, e = design

    def rod_angle(theta: Any) -> Any:
        angle = np.arcsin((e - r * np.sin(theta)) / l)
        return angle if sign > 0.0 else math.pi - angle

    return lambda theta: r * np.cos(theta) + l * np.cos(rod_angle(theta)), rod_angle


@pytest.mark.parametrize("branch", SIGNS)
def test_rates_of_slider_and_rod_are_time_derivatives_of_their_positions(branch: Branch) -> None:
    sign = SIGNS[branch]
    for design in DESIGNS:
        slider, rod = loop(design, sign)
        reach = distance_to_locking(*design)
        at = linkage_of(design, branch).at(THETA, speed=SPEED, acceleration=ACCELERATION)
        x, v, a = motion_in_time(slider, THETA, speed=SPEED, acceleration=ACCELERATION, reach=reach)
        size = float(design[1])
        close(at.slider_position, x, size)
        close(at.slider_velocity, v, 7.0 * size)
        close(at.slider_acceleration, a, max(49.0 * size, float(np.abs(a).max())))
        angle, w, alpha = motion_in_time(rod, THETA, speed=SPEED, acceleration=ACCELERATION, reach=reach)
        close(np.exp(1j * at.rod_angle), np.exp(1j * angle), 1.0)
        close(at.rod_velocity, w, 7.0)
        close(at.rod_acceleration, alpha, max(49.0, float(np.abs(alpha).max())))


@pytest.mark.parametrize("branch", SIGNS)
def test_points_on_the_links_move_as_their_positions_say(branch: Branch) -> None:
    sign = SIGNS[branch]
    along, across = 0.03, -0.015
    for design in DESIGNS:
        _, rod = loop(design, sign)
        r = design[0]
        machine = linkage_of(design, branch)
        reach = distance_to_locking(*design)

        def on_rod_x(theta: Any, r: float = r, rod: Callable[[Any], Any] = rod) -> Any:
            return r * np.cos(theta) + along * np.cos(rod(theta)) - across * np.sin(rod(theta))

        def on_rod_y(theta: Any, r: float = r, rod: Callable[[Any], Any] = rod) -> Any:
            return r * np.sin(theta) + along * np.sin(rod(theta)) + across * np.cos(rod(theta))

        cases = (
            (machine.rod_point, on_rod_x, on_rod_y),
            (
                machine.crank_point,
                lambda theta: along * np.cos(theta) - across * np.sin(theta),
                lambda theta: along * np.sin(theta) + across * np.cos(theta),
            ),
        )
        for point, x, y in cases:
            got = point(THETA, along=along, across=across, speed=SPEED, acceleration=ACCELERATION)
            for axis, position in enumerate((x, y)):
                expected = motion_in_time(position, THETA, speed=SPEED, acceleration=ACCELERATION, reach=reach)
                size = float(design[1])
                close(got.position[..., axis], expected[0], size)
                close(got.velocity[..., axis], expected[1], 7.0 * size)
                close(got.acceleration[..., axis], expected[2], max(49.0 * size, float(np.abs(expected[2]).max())))


def test_rates_close_to_locking_are_complex_step_derivatives() -> None:
    designs = random_designs(500, seed=8)
    random = np.random.default_rng(8)
    theta = random.uniform(0.0, 2.0 * math.pi, 500)
    step = 1e-30
    for branch, sign in SIGNS.items():
        at = linkage_of(designs, branch).at(theta, speed=1.0)
        moved = path(designs, theta + 1j * step, sign)
        # Near locking cos(phi) comes from a difference that cancels: 1e-16 / 2e-3, to its third power in x''.
        np.testing.assert_allclose(at.slider_velocity, moved.x.imag / step, rtol=1e-10, atol=1e-14)
        np.testing.assert_allclose(at.slider_acceleration, moved.x_1.imag / step, rtol=1e-9, atol=1e-13)
        np.testing.assert_allclose(at.rod_velocity, moved.rod_1.real, rtol=1e-11, atol=1e-14)
        np.testing.assert_allclose(at.rod_acceleration, moved.rod_1.imag / step, rtol=1e-10, atol=1e-12)


def test_ends_of_the_rod_are_crank_pin_and_slider_pin() -> None:
    machine = Linkage(0.14, 0.31, -0.06)
    pin, slider = machine.rod_point(THETA, along=0.0), machine.rod_point(THETA, along=0.31)
    np.testing.assert_allclose(pin.position, machine.crank_point(THETA, along=0.14).position, atol=1e-16)
    np.testing.assert_allclose(slider.position[:, 0], machine.at(THETA).slider_position, rtol=1e-14)
    np.testing.assert_allclose(slider.position[:, 1], -0.06, rtol=1e-14)


def test_error_influences_are_complex_step_derivatives_of_the_slider_position() -> None:
    designs = random_designs(500, seed=9)
    theta = np.random.default_rng(9).uniform(0.0, 2.0 * math.pi, 500)
    step = 1e-30
    for branch, sign in SIGNS.items():
        influences = linkage_of(designs, branch).error_influences(theta)
        for v, got in enumerate((influences.crank, influences.rod, influences.offset)):
            moved = designs.astype(complex)
            moved[:, v] += 1j * step
            # As above: cos(phi) to the first power.
            np.testing.assert_allclose(got, path(moved, theta, sign).x.imag / step, rtol=1e-10, atol=1e-13)
        angle = path(designs, theta + 1j * step, sign).x.imag / step
        np.testing.assert_allclose(influences.crank_angle, angle, rtol=1e-10, atol=1e-14)


def test_error_influence_is_the_limit_of_a_finite_error() -> None:
    exact, small = Linkage(0.05, 0.2, 0.03), 1e-6
    moved = Linkage(0.05, 0.2 + small, 0.03)
    change = moved.at(THETA).slider_position - exact.at(THETA).slider_position
    # The second-order part is small^2 x''(l) / 2 < 1e-12 / 0.2; rounding 1e-16.
    np.testing.assert_allclose(change, small * exact.error_influences(THETA).rod, rtol=0, atol=5e-12)
