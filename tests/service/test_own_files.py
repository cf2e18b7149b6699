"""Jobs with files beside them: functions of your own, points of a target motion."""

from __future__ import annotations

import json
from pathlib import Path

from tests.service import fronts
from tests.service.conftest import Command

OWN = """
[quantity.mine]
function = "judges:judge"
unit = "m/s^3"
limit = "1 s"
[target_motion]
file = "points/motion.csv"
shift = "free"
"""
POINTS = "crank_angle_deg,position_mm\n0,400\n90,300\n180,120\n270,300\n"


def job_file(folder: Path, judge: str) -> Path:
    """Return a job that minimises a function of its own, with the files that it needs."""
    job = fronts.job_file(folder)
    text = job.read_text().replace('transmission_angle = "maximise"', 'mine = "minimise"')
    job.write_text(text + OWN)
    (folder / "judges.py").write_text(judge)
    (folder / "points").mkdir()
    (folder / "points" / "motion.csv").write_text(POINTS)
    return job


def test_a_run_keeps_the_files_that_its_job_needs(tmp_path: Path, runs: Path, command: Command) -> None:
    job = job_file(tmp_path, "def judge(designs):\n    return designs.rod / designs.crank\n")
    done = command("optimise", job, "--no-figures", "--json")
    assert done.exit_code == 0, done.stderr
    record = json.loads(done.stdout)
    assert {"mine_m_s3", "motion_deviation_mm", "motion_deviation_rms_mm", "motion_shift_mm"} <= set(
        record["designs"][0]
    )
    kept = Path(record["run"])
    for file in ("judges.py", "points/motion.csv"):
        assert (kept / file).read_bytes() == (tmp_path / file).read_bytes()
    shown = command("front", "latest", "--columns", "mine,motion_deviation")
    assert shown.exit_code == 0, shown.stderr
    checked = command("check", kept / "job.toml")
    assert checked.exit_code == 0
    assert "target motion: 4 points, phase fixed, shift free" in checked.stdout
    assert "mine: mine, by judges:judge" in checked.stdout
    lengths = ("--crank", "140 mm", "--rod", "400 mm", "--offset", "0 mm")
    numbers = json.loads(command("analyse", kept / "job.toml", *lengths, "--json").stdout)
    assert abs(numbers["mine_m_s3"] - 400.0 / 140.0) < 1e-12
    # Positions 540, about 374.7 twice and 260 mm against 400, 300, 300 and 120: from 74.7 to 140 apart.
    side = (400.0**2 - 140.0**2) ** 0.5
    assert abs(numbers["motion_deviation_mm"] - 0.5 * (140.0 - (side - 300.0))) < 1e-9


def test_an_endless_function_ends_the_run_with_exit_code_2_and_keeps_nothing(
    tmp_path: Path, runs: Path, command: Command
) -> None:
    job = job_file(tmp_path, "def judge(designs):\n    while True:\n        pass\n")
    assert command("check", job).exit_code == 0
    done = command("optimise", job, "--no-figures")
    assert done.exit_code == 2
    assert "slidercrank: the quantity mine (judges:judge) must return within 1 s" in done.stderr
    assert "judges.py:" in done.stderr
    assert [path for path in runs.iterdir() if path.is_dir()] == []
