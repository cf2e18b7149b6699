"""`slidercrank like`: the design that a run's front has near a given one, with more asked of it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.service.conftest import Command


@pytest.mark.slow
def test_a_design_like_another_with_more_transmission_angle(kept: Path, command: Command) -> None:
    front = json.loads(command("front", "latest", "--runs", kept, "--json").stdout)
    row = front["designs"][2]
    least = row["least_transmission_angle_deg"] + 1.5
    arguments = ("like", "latest", 3, "--runs", kept, "--where", f"transmission_angle >= {least} deg")
    record = json.loads(command(*arguments, "--json").stdout)
    design = record["design"]
    assert record["before"] == row
    assert design["least_transmission_angle_deg"] == pytest.approx(least, rel=1e-8)
    assert design["stroke_mm"] == pytest.approx(280.0, rel=1e-9)
    assert design["status"] == "stationary"
    # The front is a curve: more of one objective is less of the other, and no more of it than asked is the nearest.
    assert design["time_ratio"] < row["time_ratio"]
    assert record["moved"]["least_transmission_angle_deg"] == pytest.approx(1.5, rel=1e-6)
    assert record["moved"]["crank_mm"] == design["crank_mm"] - row["crank_mm"]
    spans = [
        max(each[key] for each in front["designs"]) - min(each[key] for each in front["designs"])
        for key in ("time_ratio", "least_transmission_angle_deg")
    ]
    moved = [record["moved"][key] for key in ("time_ratio", "least_transmission_angle_deg")]
    assert record["distance"] == pytest.approx(
        sum((move / span) ** 2 for move, span in zip(moved, spans, strict=True)) ** 0.5, rel=1e-9
    )
    shown = command(*arguments).stdout
    assert "like design 3, with transmission_angle >= " in shown
    assert f"{design['crank_mm']:.6g}" in shown
    assert f"distance {record['distance']:.4g}" in shown


def test_what_cannot_be_met_is_exit_code_3(kept: Path, command: Command) -> None:
    done = command("like", "latest", 1, "--runs", kept, "--where", "stroke <= 200 mm", "--json")
    assert done.exit_code == 3
    assert "stroke at most 200 mm, where exactly 280 mm is already required" in done.stderr
    assert json.loads(done.stdout)["status"] == "infeasible"


@pytest.mark.parametrize(
    ("number", "where", "message"),
    [
        (99, ["rod <= 300 mm"], "the run has designs 1 to"),
        (1, ["rod < 300 mm"], ">=, <= or =; got 'rod < 300 mm'"),
        (1, ["rod <= 300"], "the value in 'rod <= 300'"),
        (
            1,
            ["slow_stroke = inward"],
            "condition must begin with a quantity, a dimension or a formula of these; got 'slow_stroke = inward'",
        ),
        (1, ["residual <= 1"], "must begin with a quantity, a dimension or a formula of these"),
        (1, ["rod <= 200 mm", "rod >= 300 mm"], "the conditions on rod must not contradict each other"),
        (1, ["rod >= 60 mm"], "already meets the added conditions"),
    ],
)
def test_a_wrong_request_is_exit_code_2(
    number: int, where: list[str], message: str, kept: Path, command: Command
) -> None:
    options = [part for text in where for part in ("--where", text)]
    done = command("like", "latest", number, "--runs", kept, *options)
    assert done.exit_code == 2
    assert message in done.stderr


def test_a_run_without_its_job_is_said(kept: Path, tmp_path: Path, command: Command) -> None:
    run = next(path for path in kept.iterdir() if path.is_dir())
    copy = shutil.copytree(run, tmp_path / run.name)
    (copy / "job.toml").unlink()
    done = command("like", copy, 1, "--where", "rod <= 300 mm")
    assert done.exit_code == 2
    assert "has neither; name another run" in done.stderr
