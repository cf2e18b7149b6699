"""`analyse --show uneven_speed`: numbers, text, figure, profiles in files, and sentences where they do not fit."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics, SpeedTable
from slidercrank.optimise.job import load_job
from slidercrank.service.questions.uneven_speed import analysis
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
    assert "2 harmonics of the crank angle; quantities follow this profile" in " ".join(
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
    assert machine.speed_profile.speed_ratio(at) == pytest.approx(1.0 + 0.05 * np.cos(at), abs=2e-6)


def _write_record(folder: Path, times: np.ndarray, speeds: np.ndarray, digits: int = 12) -> None:
    """Write a record over time, its numbers to some digits."""
    rows = [f"{at:.{digits}g},{one:.{digits}g}" for at, one in zip(times, speeds, strict=True)]
    (folder / "speed.csv").write_text("\n".join(["time_s,speed_rpm", *rows, ""]))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_record_of_one_turn_is_one_though_its_numbers_are_rounded(
    way: float, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    """60 rpm over 1 s, 41 points, and last times that are off by rounding."""
    job = job_with('{ file = "speed.csv" }', pytestconfig, tmp_path)
    job.write_text(job.read_text().replace('speed = "900 rpm"', f'speed = "{60.0 * way} rpm"'))
    times, speeds = np.linspace(0.0, 1.0, 41), np.full(41, 60.0 * way)
    for last in (1.0, 0.9999997, 0.9999):
        _write_record(tmp_path, np.where(times == 1.0, last, times), speeds)
        profile = load_job(job).mechanism.speed_profile
        assert isinstance(profile, SpeedTable)
        assert len(profile.angles) == 40  # the last point is the first, a turn later
        assert np.diff(profile.angles) == pytest.approx(math.radians(9.0), abs=math.radians(0.04))  # as the last step
        assert profile.speed_ratio(np.linspace(0.0, 6.0, 30)) == pytest.approx(1.0, abs=1e-12)


def test_a_record_of_one_turn_at_an_uneven_speed_has_its_profile(pytestconfig: pytest.Config, tmp_path: Path) -> None:
    """W = w0 (1 + a cos theta) of one turn, in five digits of time and speed."""
    theta = np.linspace(0.0, 2.0 * math.pi, 61)
    at = np.linspace(0.0, 2.0 * math.pi, 6001)
    slow = 1.0 / (900.0 * math.pi / 30.0 * (1.0 + 0.05 * np.cos(at)))
    time = np.concatenate([[0.0], np.cumsum(0.5 * (slow[1:] + slow[:-1]) * np.diff(at))])[::100]
    _write_record(tmp_path, time, 900.0 * (1.0 + 0.05 * np.cos(theta)), digits=5)
    profile = load_job(job_with('{ file = "speed.csv" }', pytestconfig, tmp_path)).mechanism.speed_profile
    assert isinstance(profile, SpeedTable)
    assert len(profile.angles) == 60
    assert profile.speed_ratio(theta) == pytest.approx(1.0 + 0.05 * np.cos(theta), abs=1e-4)


def test_points_about_the_end_of_the_first_turn_are_its_end(pytestconfig: pytest.Config, tmp_path: Path) -> None:
    """A noisy sample just before 360 deg would give a second speed at the same crank angle."""
    job = job_with('{ file = "speed.csv" }', pytestconfig, tmp_path)
    job.write_text(job.read_text().replace('speed = "900 rpm"', 'speed = "60 rpm"'))
    times = np.linspace(0.0, 2.0, 81)
    speeds = 60.0 + 0.02 * np.random.default_rng(3).standard_normal(81)
    speeds[40:] -= 0.02  # so that the turn ends just before the forty-first point
    _write_record(tmp_path, times, speeds)
    profile = load_job(job).mechanism.speed_profile
    assert isinstance(profile, SpeedTable)
    assert profile.speed_ratio(np.linspace(0.0, 2.0 * math.pi, 2000)) == pytest.approx(1.0, abs=3e-3)


@pytest.mark.slow
@pytest.mark.parametrize("lines", [10_002, 25_000])
def test_a_record_of_too_many_lines_is_refused_and_taken_once_it_is_thinned_out_as_told(
    lines: int, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    job = job_with('{ file = "speed.csv" }', pytestconfig, tmp_path)
    job.write_text(job.read_text().replace('speed = "900 rpm"', 'speed = "60 rpm"'))
    times = np.linspace(0.0, 1.0, lines)
    _write_record(tmp_path, times, np.full(lines, 60.0), digits=9)
    said = r"file: \"speed\.csv\" must have at most 10,000 significant points; got [\d,]+; .* keep one line in"
    with pytest.raises(InputError, match=said) as told:
        load_job(job)
    assert "crank_angles" not in str(told.value)
    found = re.search(r"keep one line in (\d+)", str(told.value))
    assert found is not None
    kept = np.unique([*range(0, lines, int(found[1])), lines - 1])
    _write_record(tmp_path, times[kept], np.full(len(kept), 60.0), digits=9)
    profile = load_job(job).mechanism.speed_profile
    assert isinstance(profile, SpeedTable)
    assert 5000 <= len(profile.angles) <= 10_000


def test_one_harmonic_is_told_as_one() -> None:
    assert Harmonics(cosines=(0.05,)).description == "1 harmonic of the crank angle"
    assert Harmonics(sines=(0.0, 0.05)).description == "2 harmonics of the crank angle"


@pytest.mark.parametrize(
    ("points", "last", "said"),
    [
        (40, 0.975, "got 351 deg"),  # the last point is lost
        (41, 0.998, r"got 359\.28 deg"),
        (1001, 0.9994, r"got 359\.784 deg"),  # more than half of a step of 0.36 deg
    ],
)
def test_a_record_that_lacks_a_part_of_the_turn_is_refused(
    points: int, last: float, said: str, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    _write_record(tmp_path, np.linspace(0.0, last, points), np.full(points, 60.0))
    with pytest.raises(InputError, match=rf"must cover at least one turn; {said}"):
        load_job(job_with('{ file = "speed.csv" }', pytestconfig, tmp_path))


@pytest.mark.parametrize(
    ("profile", "said"),
    [
        ("{ cosines = [1.2] }", "got -20 % of the mean at 180 deg"),
        ("{ }", "harmonics or points; got neither"),
        ('{ file = "no.csv" }', r"speed_profile\.file: \"no\.csv\" not found"),
        (
            '{ crank_angles = [0, 1, 2, 3], speeds = ["9 rpm", "-8 rpm", "9 rpm", "9 rpm"] }',
            "must not be zero or change its sign, .*; got -8 rpm at 57.2958 deg",
        ),
        (
            '{ crank_angles = ["0 deg", 1, 2, "360 deg"], speeds = ["9 rpm", "8 rpm", "9 rpm", "7 rpm"] }',
            "one turn after the first, differs from it by -2 rpm",
        ),
        ('{ file = "gap.csv" }', "row 3, column .speed_rpm.: must be a number; got .nan.; write the number alone"),
        ('{ file = "short.csv" }', "must cover at least one turn; got 54 deg"),
        ('{ file = "rising.csv" }', r"must repeat after a turn, within 2 %; got 900 rpm at its start and 1024\.7"),
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
    (tmp_path / "gap.csv").write_text("time_s,speed_rpm\n0,900\n0.01,nan\n0.02,900\n0.1,900\n")
    rows = "".join(f"{0.01 * k},{900 + 20 * k}\n" for k in range(20))
    (tmp_path / "rising.csv").write_text("time_s,speed_rpm\n" + rows)
    with pytest.raises(InputError, match=said):
        load_job(job_with(profile, pytestconfig, tmp_path))


def test_a_constant_speed_is_told_what_to_add() -> None:
    with pytest.raises(InputError, match="the speed of this job is constant; for example, add to the job"):
        analysis.numbers(Mechanism(speed=3.0), Linkage(0.03, 0.1, 0.0))
