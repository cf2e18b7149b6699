"""Prescribed motion: constant speed and acceleration as the cycle has them, energies, replayed simulations."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import Drive, LinearMotor
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.forward_dynamics import simulate
from slidercrank.model.transient.prescribed_motion import (
    SpeedOverAngle,
    SpeedOverTime,
    prescribed_over_angle,
    prescribed_over_time,
)
from tests.model.cases import MACHINES, SMOOTH, STROKES

LINKAGE = Linkage(0.05, 0.2, 0.03)


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_constant_acceleration_over_time_is_that_of_the_cycle(machine: Mechanism) -> None:
    linkage = replace(LINKAGE, branch=machine.branch)
    w, a = machine.speed, math.copysign(abs(machine.acceleration), machine.speed)
    motion = SpeedOverTime(lambda t: w + a * t, lambda t: np.full_like(t, a), lambda t: 0.3 + w * t + 0.5 * a * t * t)
    found = prescribed_over_time(machine, linkage, motion, np.linspace(0.0, 0.5, 40))
    for i in range(0, 40, 13):
        moving = replace(machine, speed=found.speed[i], acceleration=a)
        expected = cycle(moving, linkage, found.curves.crank_angle[i])
        for name in ("torque", "load", "guide", "pivot_x", "slider_acceleration"):
            assert getattr(found.curves, name)[i] == pytest.approx(getattr(expected, name)[0], rel=1e-12), name
    # Without the angle it is integrated.
    again = prescribed_over_time(machine, linkage, SpeedOverTime(motion.speed, motion.acceleration), found.time)
    np.testing.assert_allclose(again.curves.crank_angle, found.curves.crank_angle - 0.3, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_speed_over_angle_gives_time_and_acceleration(way: float) -> None:
    # w = way (20 + 5 cos(theta)): period 2 pi / sqrt(20^2 - 5^2) by the residue theorem.
    motion = SpeedOverAngle(lambda q: way * (20.0 + 5.0 * np.cos(q)), lambda q: -way * 5.0 * np.sin(q))
    found = prescribed_over_angle(SMOOTH, LINKAGE, motion, start=0.4, turns=2.0)
    assert found.time[-1] == pytest.approx(4.0 * math.pi / math.sqrt(375.0), rel=1e-12)
    assert found.curves.crank_angle[-1] == pytest.approx(0.4 + way * 4.0 * math.pi, rel=1e-14)
    rise = np.gradient(found.speed, found.time, edge_order=2)
    np.testing.assert_allclose(found.acceleration, rise, rtol=0, atol=2e-3 * np.abs(rise).max())
    np.testing.assert_allclose(found.power, found.curves.torque * found.speed, rtol=1e-15)


def test_a_table_over_angle_is_interpolated_smoothly_and_periodically() -> None:
    at = np.radians(np.arange(0.0, 360.0, 15.0))
    table = SpeedOverAngle.from_table(tuple(at), tuple(20.0 + 5.0 * np.cos(at)))
    exact = SpeedOverAngle(lambda q: 20.0 + 5.0 * np.cos(q), lambda q: -5.0 * np.sin(q))
    got, expected = (prescribed_over_angle(STROKES, LINKAGE, motion, start=-2.0) for motion in (table, exact))
    # Cubic: (15 deg)^4 / 384 of the fourth derivative, and (15 deg)^3 / 24 for the slope.
    np.testing.assert_allclose(got.speed, expected.speed, rtol=0, atol=5.0 * 1.3e-5)
    np.testing.assert_allclose(got.acceleration, expected.acceleration, rtol=0, atol=25.0 * 5.0 * 8e-4)
    assert got.speed[0] == pytest.approx(got.speed[-1], rel=1e-12)


def test_over_a_turn_the_work_is_that_on_the_loads_for_any_periodic_speed() -> None:
    motion = SpeedOverAngle(lambda q: 12.0 + 4.0 * np.sin(q), lambda q: 4.0 * np.cos(q))
    found = prescribed_over_angle(STROKES, LINKAGE, motion, samples=20_000)
    on_load = -np.trapezoid(found.curves.load * found.curves.slider_velocity, found.time)
    # The same speed at start and end: no kinetic energy gained. Steps of 3e-4 rad across jumps at the dead centres.
    assert np.trapezoid(found.power, found.time) == pytest.approx(on_load, rel=1e-6)
    assert abs(float(on_load)) > 10.0


def test_a_simulation_replayed_needs_the_torque_that_it_had() -> None:
    drive = Drive(motor=LinearMotor(stall_torque=60.0, no_load_speed=40.0), flywheel=0.2)
    run = simulate(SMOOTH, LINKAGE, drive, duration=0.6, samples=2000)
    motion = SpeedOverTime.from_table(run.time.tolist(), run.speed.tolist(), start=float(run.angle[0]))
    found = prescribed_over_time(SMOOTH, LINKAGE, motion, np.linspace(0.05, 0.55, 300))
    expected = np.interp(found.time, run.time, run.torque)
    # The table is interpolated by a cubic, the comparison linearly, both between 2,000 points a turn.
    np.testing.assert_allclose(found.curves.torque, expected, rtol=0, atol=1e-4 * np.abs(run.torque).max())
    np.testing.assert_allclose(found.curves.crank_angle, np.interp(found.time, run.time, run.angle), atol=1e-5)


def test_where_the_crank_reverses_the_loads_follow_the_way_it_moves_on() -> None:
    motion = SpeedOverTime(
        lambda t: 4.0 - 8.0 * t, lambda t: np.full_like(t, -8.0), lambda t: 1.0 + 4.0 * t - 4.0 * t * t
    )
    found = prescribed_over_time(STROKES, LINKAGE, motion, [0.25, 0.5, 0.75])
    assert found.speed[1] == pytest.approx(0.0, abs=1e-200)
    assert found.curves.load[1] - found.curves.load[2] == pytest.approx(0.0, abs=20.0)
    assert abs(found.curves.load[0] - found.curves.load[2]) > 200.0
    assert np.isfinite(found.curves.torque).all()


def test_a_kink_of_the_speed_is_no_mistake() -> None:
    motion = SpeedOverTime(lambda t: np.minimum(20.0 * t, 10.0), lambda t: np.where(t < 0.5, 20.0, 0.0))
    found = prescribed_over_time(SMOOTH, LINKAGE, motion, np.linspace(0.0, 1.0, 11))
    assert found.curves.crank_angle[-1] == pytest.approx(7.5, rel=1e-9)


GOOD: Any = (lambda q: 20.0 + np.cos(q), lambda q: -np.sin(q))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: SpeedOverAngle.from_table((0.0, 1.0, 2.0), (1.0, 1.0, 1.0)), "at least four; got 3 crank angles"),
        (lambda: SpeedOverAngle.from_table((0.0, 1.0, 2.0, 7.0), (1.0,) * 4), "span less than 360 deg; got 401"),
        (lambda: SpeedOverTime.from_table((0.0, 1.0, 3.0, 2.0), (1.0,) * 4), "times of a table must increase"),
        (lambda: SpeedOverTime.from_table((0.0, 1.0, 2.0, 3.0), (1.0, 1.0, 1.0, math.nan)), "finite throughout"),
        (
            lambda: prescribed_over_angle(SMOOTH, LINKAGE, SpeedOverAngle(np.cos, lambda q: -np.sin(q))),
            "must not be zero or change its sign, .*state the motion over time",
        ),
        (
            lambda: prescribed_over_angle(SMOOTH, LINKAGE, SpeedOverAngle(GOOD[0], lambda q: np.sin(q))),
            "must be the slope of its function; got",
        ),
        (
            lambda: prescribed_over_angle(SMOOTH, LINKAGE, SpeedOverAngle(lambda q: q * math.nan, GOOD[1])),
            "speed of a prescribed motion must be finite; got speed nan at 0",
        ),
        (lambda: prescribed_over_angle(SMOOTH, LINKAGE, SpeedOverAngle(*GOOD), turns=-1.0), "turns must be positive"),
        (
            lambda: prescribed_over_time(SMOOTH, LINKAGE, SpeedOverTime(*GOOD), [0.0, 0.0]),
            "times must be a list of finite, incr",
        ),
        (
            lambda: prescribed_over_time(
                SMOOTH, LINKAGE, SpeedOverTime.from_table((0, 1, 2, 3), (1, 2, 3, 5)), [0.0, 4.0]
            ),
            "times must lie within the table, 0 to 3 s; got 0 to 4 s",
        ),
    ],
)
def test_wrong_motions_are_refused(make: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()
