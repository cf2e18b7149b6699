"""[drive] in a job file: what becomes of it, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor, TorqueTable
from slidercrank.optimise.job import parse_job

SMALL: dict[str, Any] = {
    "name": "Small",
    "mechanism": {"speed": "300 rpm", "slider": {"mass": "2 kg"}},
    "variables": {"crank": "40 mm", "rod": ["100 mm", "200 mm"], "offset": 0},
    "objectives": {"peak_torque": "minimise"},
}
TURN = 2.0 * math.pi


def drive_of(**drive: Any) -> Drive | None:
    return parse_job(SMALL | {"drive": drive}).mechanism.drive


def test_without_a_drive_the_mechanism_has_none() -> None:
    assert parse_job(SMALL).mechanism.drive is None


@pytest.mark.parametrize(
    ("motor", "expected"),
    [
        ({"torque": "20 N m"}, ConstantTorque(torque=20.0)),
        ({"torque": "0 N m"}, ConstantTorque(torque=0.0)),
        (
            {"stall_torque": "0.06 kN m", "no_load_speed": "600 rpm"},
            LinearMotor(stall_torque=60.0, no_load_speed=10.0 * TURN),
        ),
        (
            {"rated_torque": "10 N m", "rated_speed": "1440 rpm", "no_load_speed": "1500 rpm"},
            LinearMotor.from_rated_point(torque=10.0, speed=24.0 * TURN, no_load_speed=25.0 * TURN),
        ),
        (
            {"speeds": ["0 rpm", "60 rpm", "120 rpm"], "torques": ["5 N m", "7 N m", "-1 N m"]},
            TorqueTable(speeds=(0.0, TURN, 2.0 * TURN), torques=(5.0, 7.0, -1.0)),
        ),
    ],
)
def test_motors_are_read_in_si(motor: dict[str, Any], expected: object) -> None:
    drive = drive_of(motor=motor, flywheel="0.5 kg m^2", motor_inertia="40 kg cm^2", gear_ratio=5)
    assert drive == Drive(motor=expected, flywheel=0.5, motor_inertia=0.004, gear_ratio=5.0)  # type: ignore[arg-type]


GOOD = {"torque": "20 N m"}


@pytest.mark.parametrize(
    ("drive", "words"),
    [
        ({"motor": GOOD, "flywheal": 1}, ["drive.flywheal: unknown key", "did you mean flywheel?"]),
        ({"motor": "20 N m"}, ["drive.motor: must be a table such as { torque }", '"20 N m"']),
        ({"motor": {}}, ["drive.motor: must be one of", "got no keys"]),
        ({"motor": {"stall_torqe": "1 N m"}}, ["drive.motor", "did you mean stall_torque?"]),
        ({"motor": {"torque": "1 N m", "stall_torque": "1 N m"}}, ["of one kind", "torque and stall_torque"]),
        ({"motor": {"stall_torque": "1 N m"}}, ["drive.motor.no_load_speed: is missing", '"400 rpm"']),
        ({"motor": {"torque": "20 N"}}, ["drive.motor.torque", "is a force", '"25 N m"']),
        ({"motor": {"torque": "-20 N m"}}, ["drive.motor.torque", "zero or more", '"-20 N m"']),
        ({"motor": {"torque": math.nan}}, ["drive.motor.torque", "finite"]),
        (
            {"motor": {"rated_torque": "1 N m", "rated_speed": "9 rpm", "no_load_speed": "8 rpm"}},
            ["drive.motor", "a speed below the no-load speed"],
        ),
        ({"motor": {"speeds": ["0 rpm"], "torques": ["1 N m", "1 N m"]}}, ["drive.motor.speeds", "at least 2 entries"]),
        (
            {"motor": {"speeds": ["0 rpm", "1 rpm"], "torques": ["1 N m", "1 N m", "1 N m"]}},
            ["drive.motor", "as many torques as speeds"],
        ),
        ({"motor": {"speeds": ["5 rpm", "1 rpm"], "torques": ["1 N m", "1 N m"]}}, ["drive.motor", "sort the table"]),
        ({"motor": {"speeds": ["5 rpm", "9 rpm"], "torques": ["1 N m", "1 N m"]}}, ["must be zero or negative"]),
        ({"motor": GOOD, "flywheel": "-1 kg m^2"}, ["drive.flywheel", "zero or more"]),
        ({"motor": GOOD, "flywheel": "1 kg"}, ["drive.flywheel", "is a mass"]),
        ({"motor": GOOD, "gear_ratio": 0}, ["drive.gear_ratio", "positive"]),
        ({"gear_efficiency": 0}, ["drive.gear_efficiency: must be positive; got 0; write it like 0.9"]),
        ({"gear_efficiency": -0.5}, ["drive.gear_efficiency: must be positive; got -0.5; write it like 0.9"]),
        ({"gear_efficiency": "94 %"}, ['fraction of at most 1; got "94 %"; write 0.94']),
        ({"gear_efficiency": "0 %"}, ['got "0 %"', "write it like 0.9"]),
        ({"braking_efficiency": 94}, ["at most 1; got 94", "write 90 % as 0.9"]),
        ({"recovery": -0.1}, ["drive.recovery: must be zero or more; got -0.1; write it like 0.8"]),
    ],
)
def test_a_bad_drive_is_refused_in_one_clear_message(drive: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(JobError) as caught:
        drive_of(**drive)
    message = str(caught.value)
    assert all(word in message for word in words), message
    assert len(message.splitlines()) == 1


def test_a_number_that_the_drive_does_not_state_must_be_stated_before_it_varies() -> None:
    variables = SMALL["variables"] | {"drive.braking_efficiency": [0.8, 0.95]}
    with pytest.raises(JobError, match=r"got drive\.braking_efficiency; give it in \[drive\] first"):
        parse_job(SMALL | {"drive": {"gear_efficiency": 0.9}, "variables": variables})
    with pytest.raises(JobError, match=r"did you mean drive\.gear_efficiency\?"):
        parse_job(
            SMALL
            | {
                "drive": {"gear_efficiency": 0.9},
                "variables": SMALL["variables"] | {"drive.gear_eficiency": [0.8, 0.95]},
            }
        )


def test_a_motor_that_gives_more_continuously_than_briefly_is_warned_of() -> None:
    drive = {"rated_torque": "20 N m", "greatest_torque": "10 N m"}
    assert parse_job(SMALL | {"drive": drive}).warnings == (
        "drive.rated_torque: a motor gives it continuously, and greatest_torque briefly; got 20 N m, more than 10 N m; "
        "swap the two, or correct one",
    )
    assert parse_job(SMALL | {"drive": drive | {"greatest_torque": "20 N m"}}).warnings == ()
    varied = SMALL["variables"] | {"drive.greatest_torque": ["10 N m", "40 N m"]}
    assert parse_job(SMALL | {"drive": drive, "variables": varied}).warnings == ()


def test_the_drive_in_words_names_heat_and_recovery() -> None:
    drive = drive_of(rated_torque="5 N m", copper_loss="120 W", recovery=0.8)
    assert drive is not None
    assert drive.text == "gear ratio 1, rated torque 5 N m, copper loss 120 W, recovery 0.8"


def test_numbers_of_the_drive_vary_and_come_with_the_motor_of_a_choice() -> None:
    motors = [
        {"name": "small", "values": {"drive.motor_inertia": "2 kg cm^2", "drive.rated_torque": "2 N m"}},
        {"name": "large", "values": {"drive.motor_inertia": "8 kg cm^2", "drive.rated_torque": "5 N m"}},
    ]
    problem = parse_job(
        SMALL
        | {
            "drive": {"gear_ratio": 10, "motor_inertia": "1 kg cm^2", "rated_torque": "1 N m"},
            "variables": SMALL["variables"] | {"drive.gear_ratio": [5, 20]},
            "choice": [{"name": "motor", "option": motors}],
            "constraints": {"thermal_use": {"max": 1.0}},
        }
    )
    assert [(item.paths, item.lower, item.upper) for item in problem.mechanism.varying] == [
        (("drive.gear_ratio",), 5.0, 20.0)
    ]
    drives = [problem.part(index).mechanism.drive for index in range(2)]
    assert [drive and (drive.motor_inertia, drive.rated_torque) for drive in drives] == [(2e-4, 2.0), (8e-4, 5.0)]
