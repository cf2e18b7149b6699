"""Target motions in jobs: linkages recovered from their motion, files of points, refusals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import load_job, parse_job
from slidercrank.optimise.job.problem_from_tables import problem
from slidercrank.optimise.solve import solve

KNOWN = np.array([0.05, 0.16, 0.03])
ANGLES = np.arange(0.0, 360.0, 15.0)
RANGES = {"crank": ["20 mm", "80 mm"], "rod": ["120 mm", "300 mm"], "offset": ["0 mm", "60 mm"]}


def job(motion: dict[str, Any] | None, objectives: dict[str, Any], **parts: Any) -> dict[str, Any]:
    data = {
        "name": "Motion",
        "mechanism": {"speed": "100 rpm", "slider": {"mass": "1 kg"}},
        "variables": RANGES,
        "objectives": objectives,
        "optimiser": {"samples": 300, "designs": 6},
        **parts,
    }
    return data if motion is None else {**data, "target_motion": motion}


def motion(turned: float = 0.0, moved: float = 0.0, **freedom: str) -> dict[str, Any]:
    positions = Linkage(*KNOWN).at(np.radians(ANGLES + turned)).slider_position + moved
    return {
        "crank_angles": [f"{angle} deg" for angle in ANGLES],
        "positions": [f"{1e3 * position} mm" for position in positions],
        **freedom,
    }


@pytest.mark.slow
@pytest.mark.parametrize(
    ("given", "name"),
    [
        (motion(), "motion_deviation"),
        (motion(), "motion_deviation_rms"),
        (motion(40.0, 0.02, phase="free", shift="free"), "motion_deviation"),
        (motion(40.0, 0.02, phase="free", shift="free"), "motion_deviation_rms"),
    ],
    ids=["greatest", "rms", "greatest-free", "rms-free"],
)
def test_linkage_is_recovered_from_its_motion(given: dict[str, Any], name: str) -> None:
    front = solve(parse_job(job(given, {name: "minimise"})))
    best = front.designs.iloc[0]
    assert best[f"{name}_mm"] < 1e-6
    np.testing.assert_allclose(front.dimensions[0], KNOWN, atol=1e-7)
    if "phase" in given:
        suffix = "_rms" if name.endswith("rms") else ""
        assert best[f"motion_phase{suffix}_deg"] == pytest.approx(40.0, abs=1e-3)
        assert best[f"motion_shift{suffix}_mm"] == pytest.approx(20.0, abs=1e-3)


@pytest.mark.usefixtures("little")
def test_deviation_as_a_constraint_keeps_designs_near_the_motion() -> None:
    limits = {"motion_deviation": {"max": "0.5 mm"}}
    front = solve(parse_job(job(motion(), {"time_ratio": "maximise", "peak_torque": "minimise"}, constraints=limits)))
    assert len(front) > 3
    assert front.designs["motion_deviation_mm"].max() <= 0.5 * (1.0 + 1e-8)
    assert "slack_motion_deviation_mm" in front.designs
    assert (front.designs["status"] == "stationary").all()


def test_points_may_come_from_a_file_beside_the_job(tmp_path: Path) -> None:
    given = motion()
    rows = zip(ANGLES, given["positions"], strict=True)
    lines = [f"{angle},{position.removesuffix(' mm')}" for angle, position in rows]
    (tmp_path / "motion.csv").write_text("\n".join(["crank_angle_deg,position_mm", *lines]) + "\n")
    (tmp_path / "job.toml").write_text(TOML)
    assert load_job(tmp_path / "job.toml").own == parse_job(job(given, {"motion_deviation": "minimise"})).own


TOML = """
name = "Motion"
[mechanism]
speed = "100 rpm"
[target_motion]
file = "motion.csv"
[variables]
crank = ["20 mm", "80 mm"]
rod = ["120 mm", "300 mm"]
offset = ["0 mm", "60 mm"]
[objectives]
motion_deviation = "minimise"
"""


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "not found; check the name"),
        (
            "angle,position\n0,1\n",
            'the columns have no units; got "angle", "position"; write, for example, "angle .deg.,position .mm.',
        ),
        ("crank_angle_deg,position_mm\n0,100\n90\n", "row 3 must have 2 cells, like the first line; got 1"),
        (
            "crank_angle_deg,position_mm\n0,100\n90,wide\n180,120\n",
            'row 3, column "position_mm": must be a number; got "wide"',
        ),
        ("crank_angle_deg,position_mm\n0,100\n90,110\n80,120\n", "must increase"),
        ("crank_angle_deg,position_mm\n0,100\n90,110\n", "at least 3 different points"),
        ('crank_angle_deg,position_mm\n"0,100\n', "must be a table in CSV; got unexpected end of data in row 2"),
        ("", "must begin with a line of column names"),
    ],
)
def test_a_wrong_file_of_points_is_refused(content: str | None, said: str, tmp_path: Path) -> None:
    (tmp_path / "job.toml").write_text(TOML)
    if content is not None:
        (tmp_path / "motion.csv").write_text(content)
    with pytest.raises(JobError, match=said):
        load_job(tmp_path / "job.toml")


def test_a_file_of_too_many_points_is_named_with_what_to_do(tmp_path: Path) -> None:
    lines = [f"{0.03 * place:.2f},100" for place in range(11_000)]
    (tmp_path / "motion.csv").write_text("\n".join(["crank_angle_deg,position_mm", *lines]), encoding="utf-8")
    given = job({"file": "motion.csv"}, {"motion_deviation": "minimise"})
    said = r"target_motion\.file: \"motion\.csv\" must have at most 10,000 significant points; got 11,000; .* line in 2"
    with pytest.raises(JobError, match=said):
        problem(given, folder=tmp_path)


def test_a_file_elsewhere_is_refused(tmp_path: Path) -> None:
    for file in ("../motion.csv", "/etc/passwd"):
        (tmp_path / "job.toml").write_text(TOML.replace("motion.csv", file))
        with pytest.raises(JobError, match="must be in the folder of the job file"):
            load_job(tmp_path / "job.toml")
    with pytest.raises(JobError, match="a file must be in the folder of the job file"):
        parse_job(job({"file": "motion.csv"}, {"motion_deviation": "minimise"}))


@pytest.mark.parametrize("table", ["objectives", "constraints"])
def test_a_deviation_without_a_target_is_refused(table: str) -> None:
    asked = {"objectives": {"motion_deviation_rms": "minimise"}, "constraints": {"motion_deviation_rms": {"max": 1e-3}}}
    data = job(None, {"time_ratio": "maximise"})
    with pytest.raises(JobError, match=rf"{table}.motion_deviation_rms: .* needs a target motion; got none"):
        parse_job({**data, table: asked[table]})


def test_a_target_without_points_is_refused() -> None:
    with pytest.raises(JobError, match="needs crank_angles and positions, or a file"):
        parse_job(job({"phase": "free"}, {"motion_deviation": "minimise"}))
    with pytest.raises(JobError, match="never negative"):
        parse_job(job(motion(), {"time_ratio": "maximise"}, constraints={"motion_deviation": {"max": "-1 mm"}}))
