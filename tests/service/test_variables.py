"""Varying numbers and choices on the command line: checked, optimised, drawn, analysed."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from tests.service.conftest import Command

JOB = """
name = "Choices"
[mechanism]
speed = "300 rpm"
slider = { mass = "1 kg" }
rod = { width = "30 mm", depth = "10 mm", density = "7800 kg/m^3" }
[variables]
crank = "40 mm"
rod = { choices = ["150 mm", "200 mm"] }
offset = "10 mm"
mechanism.slider.mass = ["0.5 kg", "2 kg"]
[objectives]
peak_torque = "minimise"
transmission_angle = "maximise"
[[choice]]
name = "rod section"
[[choice.option]]
name = "30 x 10"
values = { mechanism.rod.width = "30 mm" }
[[choice.option]]
name = "25 x 12"
values = { mechanism.rod.width = "25 mm", mechanism.rod.depth = "12 mm" }
[optimiser]
designs = 4
samples = 64
"""


@pytest.fixture
def job(tmp_path: Path) -> Path:
    file = tmp_path / "choices.toml"
    file.write_text(JOB, encoding="utf-8")
    return file


def test_check_says_what_varies_and_what_there_is_to_choose(job: Path, command: Command) -> None:
    shown = command("check", job).stdout
    assert "rod 150, 200 mm, one of these" in shown
    assert "mechanism.slider.mass 0.5 to 2 kg" in shown
    assert "rod section: 30 x 10, 25 x 12" in shown
    assert "4 combinations of choices" in shown
    assert "1 of 4 dimensions and other numbers" in shown


def test_a_run_keeps_what_was_chosen_and_draws_each_design_with_its_own_machine(
    job: Path, tmp_path: Path, command: Command
) -> None:
    done = command("optimise", job, "--runs", tmp_path / "runs", "--json")
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    run = Path(found["run"])
    rows = list(csv.DictReader((run / "front.csv").read_text().splitlines()))
    assert len(rows) == len(found["designs"]) >= 2
    assert {row["slider_mass_kg"] for row in rows} == {"0.5"}  # a heavier slider needs more torque
    assert {row["choice_rod_section"] for row in rows} <= {"30 x 10", "25 x 12"}
    assert {row["rod_mm"] for row in rows} == {"150.0", "200.0"}
    assert (run / "figures" / "best_peak_torque.png").is_file()
    # The same machine analysed by itself.
    best = rows[0]
    put = ["--set", "mechanism.slider.mass=0.5 kg"]
    if best["choice_rod_section"] == "25 x 12":
        put += ["--set", "mechanism.rod.width = 25 mm", "--set", "mechanism.rod.depth=0.012"]
    alone = command("analyse", job, "--rod", f"{best['rod_mm']} mm", *put, "--json")
    assert json.loads(alone.stdout)["peak_torque_Nm"] == pytest.approx(float(best["peak_torque_Nm"]), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("mechanism.slider.mass", "--set must look like"),
        ("mechanism.slidr.mass=2 kg", "did you mean mechanism.slider.mass"),
        ("mechanism.slider.mass=2 mm", "must be a mass"),
    ],
)
def test_wrong_settings_are_exit_code_2(text: str, words: str, job: Path, command: Command) -> None:
    done = command("analyse", job, "--rod", "150 mm", "--set", text)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
