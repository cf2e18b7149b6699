"""Cycle time in place of a speed, in every interface; and other times with a speed profile."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.model.transient.speed_profile_cycle import speed_profile_cycle
from slidercrank.objectives.tables.measured_curves import samples_of_measured_table
from slidercrank.service.motion.playback import turn_playback
from tests.service.api.fixed_front import API, Solved, client_of
from tests.service.conftest import Command

JOB: dict[str, Any] = {
    "name": "Press",
    "mechanism": {
        "cycle_time": "25 ms",
        "direction": "clockwise",
        "speed_profile": {"cosines": [0.0, 0.5]},
        "slider": {"mass": "1 kg"},
    },
    "variables": {"crank": ["20 mm", "40 mm"], "rod": ["100 mm", "200 mm"], "offset": ["-10 mm", "10 mm"]},
    "objectives": {"peak_torque": "minimise"},
}
SIZES = ("--crank", "30 mm", "--rod", "120 mm", "--offset", "10 mm")
LINES = [
    "crank speed -2771.28 rpm (mean over the crank angle, clockwise)",
    "cycle time 0.025 s, 2400 strokes per minute",
]
"""With w = w0 (1 + cos(2 theta) / 2) the mean over time is w0 sqrt(1 - 1/4): w0 = 2400 rpm / 0.866."""


@pytest.fixture
def job(tmp_path: Path) -> Path:
    file = tmp_path / "press.json"
    file.write_text(json.dumps(JOB))
    return file


def test_check_says_speed_time_and_strokes(job: Path, command: Command) -> None:
    assert " ".join(LINES) in " ".join(command("check", job).stdout.split())
    assert json.loads(command("check", job, "--json").stdout)["given"][:2] == LINES
    constant = json.loads(job.read_text()) | {"mechanism": {"strokes_per_minute": 30, "slider": {"mass": "1 kg"}}}
    job.write_text(json.dumps(constant))
    said = json.loads(command("check", job, "--json").stdout)["given"]
    assert said[:2] == ["crank speed 30 rpm (counter-clockwise)", "cycle time 2 s, 30 strokes per minute"]
    four = [{"torque_angles": ["0 deg", "300 deg", "600 deg"], "torques": [0.0, -20.0, 0.0], "cycle": "720 deg"}]
    job.write_text(json.dumps(constant | {"load": four}))
    said = json.loads(command("check", job, "--json").stdout)["given"]
    assert said[1] == "cycle time (two turns) 4 s, 30 strokes per minute"


def test_analyse_takes_the_time_and_other_times(job: Path, command: Command) -> None:
    found = json.loads(command("analyse", job, *SIZES, "--show", "uneven_speed", "--json").stdout)
    assert found["uneven_speed"]["mean_speed_over_time_rpm"] == pytest.approx(-2400.0, rel=1e-9)
    slower = command("analyse", job, *SIZES, "--set", "mechanism.cycle_time=50 ms", "--json")
    assert json.loads(slower.stdout)["peak_torque_Nm"] == pytest.approx(found["peak_torque_Nm"] / 4.0, rel=1e-9)


def test_the_api_understands_a_time_and_previews_its_direction(solved: Solved) -> None:
    with client_of(solved.store) as client:

        def asked(path: str, **body: Any) -> dict[str, Any]:
            answer: httpx.Response = client.post(f"{API}/{path}", json=body)
            assert answer.status_code == 200, answer.text
            found: dict[str, Any] = answer.json()
            return found

        assert asked("check", job=JOB)["given"][:2] == LINES
        look = asked("preview", job=JOB)
        assert (look["wrong"], look["example"]["clockwise"]) == ([], True)
        unfinished = {key: part for key, part in JOB.items() if key != "objectives"}
        assert asked("preview", job=unfinished)["example"]["clockwise"]
        wrong = {**JOB, "mechanism": {**JOB["mechanism"], "speed": "60 rpm"}}
        (said,) = asked("preview", job=wrong)["wrong"]
        assert said["path"] == "mechanism"
        assert "got speed and cycle_time; leave out all but one" in said["sentence"]


def test_what_moves_takes_the_time_of_a_turn() -> None:
    problem, linkage = sc.problem(JOB), sc.Linkage(0.03, 0.12, 0.01)
    period = speed_profile_cycle(problem.mechanism, linkage).period
    assert period == pytest.approx(0.025, rel=1e-12)
    assert turn_playback(problem.mechanism, linkage).record["perSecond"] == pytest.approx(1.0 / period, rel=1e-12)


def test_curves_over_time_are_refused_along_a_profile() -> None:
    """An angle was the time times the mean speed, which is off by half a radian here."""
    problem, linkage = sc.problem(JOB), sc.Linkage(0.03, 0.12, 0.01)
    table = {"time_s": [0.0, 0.005, 0.01, 0.015], "slider_position_mm": [149.0, 140.0, 120.0, 110.0]}
    with pytest.raises(
        InputError,
        match="needs a constant speed; got a speed profile, 2 harmonics of the crank angle; give",
    ):
        samples_of_measured_table(table, problem.mechanism, linkage)
    assert (
        len(samples_of_measured_table(table, replace(problem.mechanism, speed_profile=None), linkage).crank_angle) == 4
    )
