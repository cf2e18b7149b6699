"""`slidercrank certify`: what it prints and keeps, and its exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from slidercrank.service.runs.result import json_ready, rows_from_csv
from tests.service import fronts
from tests.service.conftest import Command


@pytest.fixture
def kept(tmp_path: Path, command: Command) -> Path:
    """Return the folder of a small run."""
    job = tmp_path / "job.toml"
    job.write_text(fronts.JOB)
    return Path(json.loads(command("optimise", job, "--no-figures", "--json").stdout)["run"])


def test_a_run_is_certified_and_the_added_designs_are_kept(kept: Path, command: Command) -> None:
    done = command("certify", "latest", "--epsilon", 0.02, "--seconds", 60)
    assert done.exit_code == 0, done.output
    assert "proven: for every feasible design, one of the 8 designs and" in done.stdout
    record = json.loads((kept / "certificate.json").read_text())
    assert record["status"] == "proven"
    assert record["epsilon"] <= record["epsilon_asked"] == 0.02
    assert record["gap_of_delivered"] <= record["epsilon_of_delivered"]
    assert record["ranges"].keys() == {"time_ratio", "least_transmission_angle_deg"}
    assert record["hole"].keys() == {"crank_mm", "rod_mm", "offset_mm"}
    assert json_ready(rows_from_csv((kept / "certificate.csv").read_text())) == record["added"]
    assert record["added"]
    assert all(abs(row["stroke_mm"] - 280.0) < 1e-6 for row in record["added"])
    assert "certificate.json" in command("front", "latest").stdout


def test_json_is_what_is_kept(kept: Path, command: Command) -> None:
    done = command("certify", kept, "--epsilon", 0.05, "--json")
    assert done.exit_code == 0
    assert json.loads(done.stdout) == json.loads((kept / "certificate.json").read_text())


def test_a_budget_that_does_not_suffice_says_what_remains(kept: Path, command: Command) -> None:
    done = command("certify", kept, "--epsilon", 1e-5, "--seconds", 0.01)
    assert done.exit_code == 4
    assert "open (" in done.stdout
    assert "Largest gap in the proof: crank" in done.stdout
    assert json.loads((kept / "certificate.json").read_text())["status"] == "out of budget"


def test_a_run_without_designs_is_proven_infeasible(tmp_path: Path, command: Command) -> None:
    job = tmp_path / "job.toml"
    job.write_text(fronts.JOB.replace('"40 deg"', '"80 deg"'))
    assert command("optimise", job, "--no-figures").exit_code == 3
    done = command("certify", "latest")
    assert done.exit_code == 0
    assert "proven: no design within the ranges meets all requirements" in done.stdout
    assert json.loads(command("certify", "latest", "--json").stdout)["infeasible"] is True


def test_a_run_without_its_job_is_refused(kept: Path, command: Command) -> None:
    (kept / "job.toml").unlink()
    done = command("certify", kept)
    assert done.exit_code == 2
    assert "job.toml or job.json" in done.stderr
