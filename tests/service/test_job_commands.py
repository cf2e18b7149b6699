"""`slidercrank check` and `slidercrank schema`."""

from __future__ import annotations

import json
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


@pytest.mark.parametrize("name", ["feeder", "sieve", "support"])
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
