"""Motor laws: their points, their slopes, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor, Motor, TorqueTable, speed_range

LINE = LinearMotor(stall_torque=8.0, no_load_speed=200.0)
TABLE = TorqueTable(speeds=(-5.0, 0.0, 50.0, 90.0), torques=(7.0, 6.0, 9.0, 0.0))
LAWS: dict[str, Motor] = {"constant": ConstantTorque(torque=3.0), "line": LINE, "table": TABLE}


def test_a_line_goes_through_stall_and_no_load_and_beyond() -> None:
    assert LINE.torque_at(0.0) == 8.0
    assert LINE.torque_at(200.0) == 0.0
    np.testing.assert_allclose(LINE.torque_at([-100.0, 100.0, 250.0]), [12.0, 4.0, -2.0], rtol=1e-15)


def test_a_line_can_be_given_by_its_rated_point() -> None:
    motor = LinearMotor.from_rated_point(torque=5.0, speed=148.0, no_load_speed=157.0)
    assert motor.torque_at(148.0) == pytest.approx(5.0, rel=1e-14)
    assert motor.torque_at(157.0) == 0.0


def test_a_table_is_met_at_its_points_does_not_overshoot_and_is_undefined_beyond() -> None:
    np.testing.assert_allclose(TABLE.torque_at(TABLE.speeds), TABLE.torques, rtol=1e-14, atol=1e-14)
    between = TABLE.torque_at(np.linspace(-5.0, 90.0, 300))
    assert between.min() >= 0.0
    assert between.max() <= 9.0
    assert np.isnan(TABLE.torque_at([-5.1, 90.1])).all()


@pytest.mark.parametrize("motor", LAWS.values(), ids=LAWS)
def test_slopes_are_those_of_the_torque(motor: Motor) -> None:
    speeds = np.array([1.0, 30.0, 70.0])
    rise = (motor.torque_at(speeds + 1e-4) - motor.torque_at(speeds - 1e-4)) / 2e-4
    np.testing.assert_allclose(motor.torque_slope(speeds), rise, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_gear_multiplies_torque_and_divides_speed(way: float) -> None:
    drive = Drive(motor=LINE, flywheel=0.5, motor_inertia=0.01, gear_ratio=5.0)
    assert drive.inertia == 0.75
    assert drive.torque_on_crank(way * 20.0, way) == pytest.approx(way * 5.0 * 4.0, rel=1e-14)
    assert speed_range(Drive(motor=TABLE, gear_ratio=5.0)) == (-1.0, 18.0)
    assert speed_range(drive) == (-math.inf, math.inf)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ConstantTorque(torque=math.nan), "torque of a ConstantTorque must be finite; got nan"),
        (lambda: LinearMotor(stall_torque=0.0, no_load_speed=9.0), "stall_torque of a LinearMotor must be positive"),
        (
            lambda: LinearMotor(stall_torque=1.0, no_load_speed=math.inf),
            "no_load_speed .* positive and finite; got inf",
        ),
        (
            lambda: LinearMotor.from_rated_point(torque=5.0, speed=160.0, no_load_speed=157.0),
            "below the no-load speed; got 5 N m",
        ),
        (lambda: TorqueTable(speeds=(0.0,), torques=(1.0,)), "as many torques as speeds, at least two; got 1 speeds"),
        (lambda: TorqueTable(speeds=(0.0, 1.0), torques=(1.0, math.nan)), "torque table must be finite throughout"),
        (lambda: TorqueTable(speeds=(0.0, 2.0, 1.0), torques=(1.0, 1.0, 1.0)), "must increase; got 1 after 2; sort"),
        (lambda: TorqueTable(speeds=(1.0, 2.0), torques=(1.0, 1.0)), "be zero or negative; got 1 rad/s"),
        (lambda: Drive(motor=LINE, flywheel=-1.0), "flywheel of a Drive must be zero or more and finite; got -1"),
        (lambda: Drive(motor=LINE, motor_inertia=math.nan), "motor_inertia of a Drive must be zero or more"),
        (lambda: Drive(motor=LINE, gear_ratio=0.0), "gear_ratio of a Drive must be positive and finite; got 0"),
        (lambda: Drive(motor=3.0), "motor must be a ConstantTorque, LinearMotor or TorqueTable; got 3.0"),  # type: ignore[arg-type]
    ],
)
def test_a_wrong_drive_is_refused(make: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()
