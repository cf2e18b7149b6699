"""`slidercrank check` and `slidercrank schema`."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from slidercrank.optimise.job import job_schema
from tests.service import fronts
from tests.service.conftest import Command


def test_check_says_what_was_understood(tmp_path: Path, command: Command) -> None:
    done = command("check", fronts.job_file(tmp_path))
    assert done.exit_code == 0, done.stderr
    for words in (
        "is a valid job: Short test [job]",
        "crank speed 300 rpm (counter-clockwise)",
        "slider: 2 kg",
        "rod 60 to 600 mm",
        "stroke = 280 mm",
        "least transmission angle at least 40 deg",
        "maximise time ratio",
        "2 of 3 dimensions left to choose",
        "stroke met exactly by elimination",
        "seed 1",
    ):
        assert words in done.stdout


def test_check_gives_json(tmp_path: Path, command: Command) -> None:
    record = json.loads(command("check", fronts.job_file(tmp_path), "--json").stdout)
    assert record["degrees_of_freedom"] == 2
    assert record["eliminated"] == ["stroke"]


def test_check_calls_a_job_of_fixed_lengths_fixed_with_its_stroke_as_an_equality(
    tmp_path: Path, command: Command
) -> None:
    text = fronts.job_file(tmp_path).read_text()
    for name, length in (("crank", "140 mm"), ("rod", "500 mm"), ("offset", "0 mm")):
        text = re.sub(rf"(?m)^{name} = \[.*\]$", f'{name} = "{length}"', text)
    text = text.replace('time_ratio = "maximise"', 'footprint = "minimise"')
    job = tmp_path / "fixed.toml"
    job.write_text(text)
    done = command("check", job)
    assert done.exit_code == 0, done.stderr
    assert "all dimensions are fixed; requirements are only checked" in done.stdout
    assert json.loads(command("check", job, "--json").stdout)["degrees_of_freedom"] == 0


@pytest.mark.parametrize("name", ["feeder", "sieve", "support", "compressor", "servo_press", "tipper"])
def test_shipped_jobs_pass_the_check(name: str, pytestconfig: pytest.Config, command: Command) -> None:
    done = command("check", pytestconfig.rootpath / "runs" / f"{name}.toml")
    assert done.exit_code == 0, done.stderr


def test_check_refuses_a_wrong_job(tmp_path: Path, runs: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text().replace("300 rpm", "fast"))
    done = command("check", job)
    assert (done.exit_code, done.stdout) == (2, "")
    assert "fast" in done.stderr
    assert not runs.exists()


def test_schema_is_that_of_job_files(command: Command) -> None:
    assert json.loads(command("schema").stdout) == job_schema()


def test_a_number_without_a_unit_is_told_as_it_is_read(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text().replace('["20 mm", "200 mm"]', "[0.02, 0.2]"))
    assert (
        "numbers without a unit are read in SI: variables.crank = 0.02 is 0.02 m = 20 mm"
        in command("check", job).stdout
    )


def test_doubtful_numbers_come_first_in_a_check_and_are_said_by_every_command(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    text = job.read_text().replace('"300 rpm"', "120").replace('rod = ["60 mm", "600 mm"]', 'rod = ["60 mm", 0.6]')
    job.write_text(text)
    speed = "mechanism.speed = 120 has no unit and is read as 120 rad/s (1145.92 rpm); if you mean 120 rpm, write "
    done = command("check", job)
    assert [line[:72] for line in done.stdout.splitlines()[1:3]] == [
        f"  warning       {speed}"[:72],
        '  warning       variables.rod = ["60 mm", 0.6] mixes numbers with and without a unit'[:72],
    ]
    assert done.stderr == ""
    assert json.loads(command("check", job, "--json").stdout)["warnings"][0].startswith(speed)
    done = command("analyse", job, "--crank", "50 mm", "--rod", "300 mm", "--offset", "0 mm", "--json")
    assert json.loads(done.stdout)
    assert [line.startswith("warning: ") for line in done.stderr.splitlines()] == [True, True]
    assert f"warning: {speed}" in done.stderr


def test_speeds_of_plates_are_checked_in_rpm_and_one_that_nothing_follows_may_be_left_out(
    tmp_path: Path, command: Command
) -> None:
    job = fronts.job_file(tmp_path)
    text = job.read_text()
    for plate in ("300 1/min", "300 U/min", "5 Hz"):
        job.write_text(text.replace("300 rpm", plate))
        assert "crank speed 300 rpm (counter-clockwise)" in command("check", job).stdout
    job.write_text(text.replace('speed = "300 rpm"\n', ""))
    assert "no crank speed: static" in command("check", job).stdout
    job.write_text(job.read_text() + 'peak_torque = "minimise"\n')
    done = command("check", job)
    assert done.exit_code == 2  # peak_torque stands in the last table, [optimiser]
    assert "it belongs in [constraints] or [objectives]; move it there" in done.stderr


def test_what_varies_is_checked_as_a_range_and_speeds_in_rpm(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    text = job.read_text() + '[[load]]\nforce = "350 N"\nopposes = "outward stroke"\n'

    def checked(*variables: str) -> list[str]:
        job.write_text(text.replace("[variables]\n", "\n".join(["[variables]", *variables, ""])))
        return [line.strip() for line in command("check", job).stdout.splitlines()]

    lines = checked('"load.1.force" = ["200 N", "400 N"]')
    assert "load: 200 to 400 N inward, resists the outward stroke, throughout" in lines
    lines = checked('"mechanism.speed" = { min = "1 Hz", max = "2 Hz", step = "0.5 Hz" }')
    assert "mechanism.speed multiples of 0.5 Hz: 3 values, 60, 90, 120 rpm" in lines
    assert any(line.endswith("crank speed 60 to 120 rpm (counter-clockwise)") for line in lines)
    assert "cycle time 0.5 to 1 s, 60 to 120 strokes per minute" in lines
    lines = checked('"mechanism.speed" = { min = "1 Hz", max = "2 Hz", step = "0.05 Hz" }')
    assert "mechanism.speed multiples of 0.05 Hz: 21 values, 60, 63, ..., 120 rpm" in lines
    lines = checked('"mechanism.speed" = { choices = ["1 rev/s", "120 rpm"] }')
    assert "speed: 1 rev/s (60 rpm), 120 rpm" in lines


def test_a_number_of_another_unit_is_said_before_a_search(tmp_path: Path, runs: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text().replace('"300 rpm"', "30"))
    done = command("submit", job, "--store", tmp_path / "store.db", "--json")
    assert json.loads(done.stdout)["state"] == "queued"
    assert "warning: mechanism.speed = 30 has no unit and is read as 30 rad/s (286.479 rpm)" in done.stderr


@pytest.mark.parametrize(("gravity", "told"), [(None, True), ("0", False), ('"9.81 m/s^2"', False)])
def test_forgotten_gravity_is_told(gravity: str | None, told: bool, tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    lines = [line for line in job.read_text().splitlines() if not line.startswith("gravity")]
    if gravity is not None:
        lines.insert(lines.index("[mechanism]") + 1, f"gravity = {gravity}")
    job.write_text("\n".join(lines))
    done = command("check", job)
    assert done.exit_code == 0, done.stderr
    assert ("masses are given without gravity" in done.stdout) == told


@pytest.mark.parametrize(
    ("module", "said"), [(None, "no module mine was found"), ("x = 1", "has no jerk"), ("def jerk(d): ...", None)]
)
def test_a_missing_function_is_found_without_running_anything(
    module: str | None, said: str | None, tmp_path: Path, command: Command
) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text() + '\n[quantity.own]\nfunction = "mine:jerk"\n')
    if module is not None:
        (tmp_path / "mine.py").write_text(module)
    done = command("check", job)
    assert done.exit_code == (0 if said is None else 2)
    assert (said or "") in done.stderr
