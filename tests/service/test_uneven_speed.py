"""`analyse --show uneven_speed`: numbers, text, figure, profiles in files, and sentences where they do not fit."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.job import load_job
from slidercrank.service.topics.uneven_speed import analysis
from tests.service.conftest import Command

DIMENSIONS = ("--crank", "30 mm", "--rod", "110 mm", "--offset", "-10 mm")


def job_with(profile: str, pytestconfig: pytest.Config, folder: Path) -> Path:
    """Return the file of the shipped compressor with a speed profile."""
    text = (pytestconfig.rootpath / "runs/compressor.toml").read_text()
    job = folder / "uneven.toml"
    job.write_text(text.replace("[mechanism]\n", f"[mechanism]\nspeed_profile = {profile}\n"))
    return job


def test_the_command_tells_and_draws(pytestconfig: pytest.Config, command: Command, tmp_path: Path) -> None:
    job = job_with("{ cosines = [0.0, 0.05] }", pytestconfig, tmp_path)
    line = ("analyse", job, *DIMENSIONS, "--show", "uneven_speed")
    found = json.loads(command(*line, "--json", "--figures", tmp_path).stdout)
    uneven = found["uneven_speed"]
    # Mean over time of w0 (1 + a cos 2 theta): w0 sqrt(1 - a^2), by the residue theorem.
    assert uneven["mean_speed_over_time_rpm"] == pytest.approx(900.0 * math.sqrt(1.0 - 0.05**2), rel=1e-12)
    assert uneven["least_speed_rpm"] == pytest.approx(855.0)
    assert uneven["peak_torque_Nm"] == pytest.approx(found["peak_torque_Nm"], rel=1e-9)
    assert uneven["mean_power_W"] == pytest.approx(found["mean_power_W"], rel=1e-9)
    assert uneven["mean_torque_Nm"] == pytest.approx(found["mean_torque_Nm"], rel=1e-9)
    assert (tmp_path / "uneven_speed.png").stat().st_size > 10_000
    assert "at constant speed" in command(*line).stdout
    assert "2 harmonics of the crank angle; quantities are those along it" in " ".join(
        command("check", job).stdout.split()
    )


@pytest.mark.parametrize("over", ["crank_angle_deg", "time_s"])
def test_speeds_come_from_a_file(over: str, pytestconfig: pytest.Config, tmp_path: Path) -> None:
    """W = w0 (1 + a cos theta): time by the integral of 1 / w, trapezia."""
    theta = np.linspace(0.0, 3.0 * math.pi, 4801)
    speed = 900.0 * (1.0 + 0.05 * np.cos(theta))
    slow = 1.0 / (speed * math.pi / 30.0)
    time = np.concatenate([[0.0], np.cumsum(0.5 * (slow[1:] + slow[:-1]) * np.diff(theta))])
    kept = slice(0, None if over == "time_s" else 3200, 40)
    first = time[kept] if over == "time_s" else np.degrees(theta[kept])
    rows = [f"{at:.12g},{one:.12g}" for at, one in zip(first, speed[kept], strict=True)]
    (tmp_path / "speed.csv").write_text("\n".join([f"{over},speed_rpm", *rows, ""]))
    machine = load_job(job_with('{ file = "speed.csv" }', pytestconfig, tmp_path)).mechanism
    assert machine.speed_profile is not None
    at = np.linspace(0.0, 6.0, 30)
    assert machine.speed_profile.ratio(at) == pytest.approx(1.0 + 0.05 * np.cos(at), abs=2e-6)


@pytest.mark.parametrize(
    ("profile", "said"),
    [
        ("{ cosines = [1.2] }", "got -20 % of the mean at 180 deg"),
        ("{ }", "harmonics or of points; got neither"),
        ('{ file = "no.csv" }', r"speed_profile\.file: \"no\.csv\" cannot be read"),
        (
            '{ crank_angles = [0, 1, 2, 3], speeds = ["9 rpm", "-8 rpm", "9 rpm", "9 rpm"] }',
            "must not be zero or change its sign, .*; got -8 rpm at 57.2958 deg",
        ),
        (
            '{ crank_angles = ["0 deg", 1, 2, "360 deg"], speeds = ["9 rpm", "8 rpm", "9 rpm", "7 rpm"] }',
            "a turn later and differs by -2 rpm",
        ),
        ('{ file = "short.csv" }', "must be of a turn at least; got 54 deg"),
        ('{ file = "rising.csv" }', r"must repeat after a turn, to 2 %; got 900 rpm at its start and 1024\.7"),
        (
            '{ crank_angles = ["0 deg", "90 deg", "180 deg", "270 deg"], '
            'speeds = ["90 rpm", "91 rpm", "92 rpm", "91 rpm"] }',
            'mean of speed_profile over the crank angle, 91 rpm; got 900 rpm; give speed = "91 rpm"',
        ),
    ],
)
def test_profiles_that_cannot_be_are_refused(
    profile: str, said: str, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    (tmp_path / "short.csv").write_text("time_s,speed_rpm\n0,900\n0.002,900\n0.005,900\n0.01,900\n")
    rows = "".join(f"{0.01 * k},{900 + 20 * k}\n" for k in range(20))
    (tmp_path / "rising.csv").write_text("time_s,speed_rpm\n" + rows)
    with pytest.raises(InputError, match=said):
        load_job(job_with(profile, pytestconfig, tmp_path))


def test_a_constant_speed_is_told_what_to_add() -> None:
    with pytest.raises(InputError, match="got a constant speed; add to the job"):
        analysis.numbers(Mechanism(speed=3.0), Linkage(0.03, 0.1, 0.0))
