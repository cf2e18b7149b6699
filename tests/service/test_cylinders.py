"""`analyse --show cylinders`: numbers, text and figure of several cylinders, and sentences where they do not fit."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.cylinders_and_turns import single_cylinder_machine
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.sizing.counterweight import best_balance
from slidercrank.service.questions.cylinders import analysis
from slidercrank.service.questions.motor import analysis as motor
from tests.service.conftest import Command

LINKAGE = Linkage(0.03, 0.12, 0.0)
TWO = Mechanism(speed=90.0, slider_mass=0.5, arrangement=Arrangement(phases=(0.0, 3.0), places=(0.0, 0.1)))


def test_the_figure_draws_the_whole_and_each() -> None:
    torque, *others, couple = analysis.figure(TWO, LINKAGE).panels
    assert len(torque.lines) == 3
    assert torque.lines[2].y == pytest.approx(torque.lines[0].y + torque.lines[1].y)
    assert couple.title == "rocking couple"
    assert len(others) == 2


def test_what_is_of_one_cylinder_says_so() -> None:
    with pytest.raises(InputError, match=r"one cylinder; got 2 cylinders at 0, 171.887 deg, at 0, 100 mm along"):
        best_balance(TWO, LINKAGE)


def test_the_motor_is_that_of_all_cylinders() -> None:
    found, whole = motor.numbers(TWO, LINKAGE), analysis.numbers(TWO, LINKAGE)
    assert found["peak_torque_Nm"] == pytest.approx(whole["peak_torque_Nm"], rel=1e-12)
    assert found["rms_torque_Nm"] == pytest.approx(whole["rms_torque_Nm"], rel=1e-12)
    one = motor.numbers(single_cylinder_machine(TWO), LINKAGE)["mean_reflected_inertia_kg_m2"]
    assert found["mean_reflected_inertia_kg_m2"] == pytest.approx(2.0 * one, rel=1e-9)
    assert found["least_reflected_inertia_kg_m2"] < found["mean_reflected_inertia_kg_m2"]


def test_the_command_tells_the_whole(pytestconfig: pytest.Config, command: Command, tmp_path: Path) -> None:
    text = (pytestconfig.rootpath / "runs/compressor.toml").read_text()
    job = tmp_path / "two.toml"
    job.write_text(text.replace("[mechanism]\n", '[mechanism]\ncylinders = { phases = ["0 deg", "180 deg"] }\n'))
    line = ("analyse", str(job), "--crank", "30 mm", "--rod", "120 mm", "--offset", "0 mm", "--show", "cylinders")
    found = json.loads(command(*line, "--json", "--figures", str(tmp_path)).stdout)
    whole = found["cylinders"]
    assert [one["phase_deg"] for one in whole["cylinders"]] == [0.0, pytest.approx(180.0)]
    assert whole["mean_torque_Nm"] == pytest.approx(found["mean_torque_Nm"], rel=1e-9)
    assert whole["peak_rocking_couple_Nm"] == 0.0
    assert whole["peak_rocking_couple_angle_deg"] is None
    assert (tmp_path / "cylinders.png").stat().st_size > 10_000
    assert "energy change" in command(*line).stdout
    said = command("check", str(job)).stdout
    assert "on one crankshaft: 2 cylinders at 0, 180 deg" in said
    assert "for all cylinders together: torque, power" in said


@pytest.mark.parametrize(
    ("cylinders", "said"),
    [
        ({"phases": ["0 deg", "360 deg"]}, "mechanism.cylinders: cylinders at one place must differ in phase or bank"),
        ({"phases": []}, "got 0 phases"),
        ({"phases": ["0 mm"]}, "mechanism.cylinders.phases"),
    ],
)
def test_impossible_cylinders_of_a_job_are_refused(
    cylinders: dict[str, list[str]], said: str, pytestconfig: pytest.Config
) -> None:
    import tomllib

    job = tomllib.loads((pytestconfig.rootpath / "runs/compressor.toml").read_text())
    job["mechanism"]["cylinders"] = cylinders
    with pytest.raises(InputError, match=said):
        parse_job(job)
