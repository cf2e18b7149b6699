"""Commands on a run of levers: the same numbers everywhere, pictures of the lever, or an error with a remedy."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app
from slidercrank.service.jobs.job_toml import job_toml
from tests.optimise.problems import LEVER
from tests.service.conftest import Command


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a place with a run of levers whose frame angle is to be found."""
    place = tmp_path_factory.mktemp("levers")
    variables = LEVER["variables"] | {"mechanism.frame_angle": ["-75 deg", "-50 deg"]}
    search = {"method": "sobol", "evaluations": 400, "designs": 3, "seed": 1}
    file = place / "job.toml"
    file.write_text(job_toml(LEVER | {"variables": variables, "optimiser": search}), encoding="utf-8")
    done = CliRunner().invoke(app, ["optimise", str(file), "--runs", str(place / "runs")])
    assert done.exit_code == 0, done.stderr
    return place


def test_front_and_lever_tell_the_same_of_each_design(command: Command, place: Path) -> None:
    runs = ("--runs", place / "runs", "--json")
    rows: list[dict[str, Any]] = json.loads(command("front", "latest", *runs).stdout)["designs"]
    assert len(rows) == 3
    for number, row in enumerate(rows, 1):
        done = command("lever", "latest", "--design", number, *runs)
        assert done.exit_code == 0, done.stderr
        found = json.loads(done.stdout)
        assert row["frame_angle_deg"] == pytest.approx(found["frame_angle_deg"], rel=1e-12)
        assert row["peak_cylinder_push_N"] == pytest.approx(found["peak_push_N"], rel=1e-12)
        assert row["lever_angle_error_deg"] == pytest.approx(found["lever_angle_error_deg"], rel=1e-12)
        assert row["buckling_margin"] == pytest.approx(found["buckling_margin"], rel=1e-9)
        assert row["peak_cylinder_power_W"] == pytest.approx(found["peak_power_W"], rel=1e-9)
        assert row["cylinder_flow_L_min"] == pytest.approx(found["extending_flow_L_min"], rel=1e-9)


def test_figures_report_drawings_and_curves_are_of_the_lever(command: Command, place: Path) -> None:
    (run,) = (path for path in (place / "runs").iterdir() if path.is_dir())
    assert {"knee.png", "best_peak_cylinder_force.png"} <= {file.name for file in (run / "figures").iterdir()}
    runs = ("--design", 2, "--runs", place / "runs")
    report, drawing, curves = place / "report.html", place / "design.svg", place / "curves.csv"
    for given in (("report", "--out", report), ("export", "--svg", drawing), ("export", "--cycle", curves)):
        done = command(given[0], "latest", *given[1:], *runs)
        assert done.exit_code == 0, done.stderr
    text = report.read_text(encoding="utf-8")
    for part in ("The swing", "peak push", "peak cylinder force", "the rod is the frame", "Buckling: Euler"):
        assert part in text
    assert "The lever swings from -20 to 50 deg" in drawing.read_text(encoding="utf-8")
    rows = list(csv.DictReader(curves.read_text(encoding="utf-8").splitlines()))
    assert [float(rows[end]["lever_angle_deg"]) for end in (0, -1)] == pytest.approx([-20.0, 50.0])


def test_a_job_of_a_lever_is_checked_in_its_own_words(command: Command, place: Path) -> None:
    text = " ".join(command("check", place / "job.toml").stdout.split())
    for part in (
        "lever swings from -20 to 50 deg and back; driven at the cylinder",
        "the rod is the frame, at -75 to -50 deg from the lever's pivot",
        "cylinder: closed length 640 mm, stroke 440 mm, bore 40 mm, rod 25 mm",
        "margin of the cylinder against buckling at least 1 (default",
    ):
        assert part in text
    assert "slider:" not in text


@pytest.mark.parametrize(
    ("given", "part"),
    [
        (("analyse",), "the lever of this job swings; use lever to analyse its designs"),
        (("swing",), "needs a crank with rod and slider"),
        (("certify",), "has no bound over a range of designs of a lever or an arm"),
    ],
)
def test_what_a_lever_does_not_have_is_refused(
    command: Command, place: Path, given: tuple[str, ...], part: str
) -> None:
    design = () if given[0] == "certify" else ("--design", 1)
    done = command(given[0], "latest", *given[1:], *design, "--runs", place / "runs")
    assert done.exit_code == 2, done.stdout
    assert part in done.stderr
    assert "Traceback" not in done.stderr
