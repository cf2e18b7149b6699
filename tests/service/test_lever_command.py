"""`slidercrank lever`: the same numbers at every door, refusals with amounts, and the guide."""

from __future__ import annotations

import contextlib
import csv
import json
import math
import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.service.agents.call import Call
from slidercrank.service.agents.questions import ask
from slidercrank.service.agents.tool import Tool
from slidercrank.service.questions.discovery import DESIGN_QUESTIONS
from slidercrank.service.runs.result import json_ready
from tests.service.conftest import Command
from tests.service.test_answers import assert_declared, assert_in_inches

TIPPER = ("--crank", "350 mm", "--rod", "900 mm", "--frame-angle=-60 deg", "--from=-20 deg", "--to", "50 deg")
LOADED = (*TIPPER, "--mass", "80 kg", "--centre", "700 mm")
SUPPORT = [1.1, 2.6, 0.0]


def answered(command: Command, *arguments: object) -> dict[str, Any]:
    done = command("lever", *arguments, "--json")
    assert done.exit_code == 0, done.stderr
    record: dict[str, Any] = json.loads(done.stdout)
    return record


def test_a_tipper_has_the_lengths_and_forces_of_the_law_of_cosines(command: Command) -> None:
    record = answered(command, *LOADED)
    assert record["start_length_mm"] == pytest.approx(670.740, abs=5e-4)
    assert record["end_length_mm"] == pytest.approx(1071.435, abs=5e-4)
    assert (record["peak_push_N"], record["push_at_end_N"]) == pytest.approx((1710.09, 1278.19), abs=5e-3)
    assert record["work_out_J"] == pytest.approx(608.726, abs=5e-4)
    assert record["single_stage"] is True
    assert record["notes"] == []


def test_a_swing_that_no_single_stage_cylinder_makes_is_said_to_be_one(command: Command) -> None:
    done = command("lever", *LOADED, "--crank", "400 mm", "--rod", "600 mm")
    assert done.exit_code == 0
    assert "no single-stage cylinder is 827.145 mm long open and 390.255 mm closed" in done.stderr
    assert answered(command, *LOADED, "--crank", "400 mm", "--rod", "600 mm")["single_stage"] is False


def test_a_lever_of_a_job_is_the_same_in_python_on_the_command_line_and_for_agents(
    command: Command, pytestconfig: pytest.Config
) -> None:
    """Column, gravity, tolerances and swing are those of the job, with 1 mm of its actuator."""
    job = pytestconfig.rootpath / "runs/support.toml"
    sizes = {"crank": "1.1 m", "rod": "2.6 m", "offset": "0 mm"}
    inputs = {"frame_angle": "-35 deg", "bore": "125 mm", "law": "harmonic", "duration": "20 s"}
    options = [f"--{name.replace('_', '-')}={text}" for name, text in (sizes | inputs).items()]
    record = answered(command, job, *options)
    assert json_ready(sc.load_job(job).ask("lever", SUPPORT, **inputs)) == record
    call = Call(job.parent, frozenset(), lambda: False, lambda _: None)
    asked = {"job": job.read_text(encoding="utf-8"), **sizes, "topics": ["lever"], "inputs": inputs}
    agent = Tool("ask", ask).execute(call, asked).record
    assert json_ready(agent) == record
    assert record["notes"] == [
        "pull pressure and retracting flow are based on the full bore, because no piston rod was given",
        "left out of the job, as a lever has neither rod nor slider: masses of rod and slider",
    ]
    weight, psi = 1200.0 * 9.81, math.radians(11.16 + 35.0)
    arm = 1.1 * math.cos(math.radians(11.16)) - 0.15 * math.sin(math.radians(11.16))
    assert record["push_at_start_N"] == pytest.approx(
        weight * arm * record["start_length_mm"] / (1.1 * 2.6 * math.sin(psi) * 1e3), rel=1e-9
    )
    errors = 1.1e-3 * abs(1.1 - 2.6 * math.cos(psi)) + 2.6e-3 * abs(2.6 - 1.1 * math.cos(psi))
    length = 1e-3 * record["start_length_mm"]
    at_start = (errors + 1e-3 * length) / (1.1 * 2.6 * math.sin(psi))
    assert record["lever_angle_error_deg"] >= math.degrees(at_start) * (1.0 - 1e-9)


def test_answers_of_random_levers_are_as_declared_and_the_same_in_inches(pytestconfig: pytest.Config) -> None:
    random, support = np.random.default_rng(3), sc.load_job(pytestconfig.rootpath / "runs/support.toml")
    question, answers = DESIGN_QUESTIONS["lever"], 0
    for _ in range(12):
        inputs: dict[str, Any] = {"frame_angle": float(random.uniform(-0.8, -0.3))}
        if random.random() < 0.5:
            inputs |= {"law": "cycloidal", "duration": 2.0, "bore": 0.125}
        if random.random() < 0.5:
            inputs |= {"piston_rod": 0.07, "closed_length": 1.6, "cylinder_stroke": 1.55, "seal_friction": 90.0}
        try:
            asked = question.bind_to_problem(support.mechanism.nominal, sc.Linkage(1.0, 2.3, 0.1), support, inputs)
            numbers = asked.numbers()
        except InputError:
            continue
        answers += 1
        assert_declared(question.record_type, json_ready(numbers))
        assert_in_inches(numbers, asked.numbers_in_units(numbers, "inch"))
    assert answers >= 4


def test_the_pivot_of_the_cylinder_lies_farthest_from_both_dead_points_by_default(command: Command) -> None:
    record = answered(command, *TIPPER[:4], *TIPPER[5:], "--pin-angle", "10 deg")
    assert record["frame_angle_deg"] == pytest.approx(15.0 + 10.0 - 90.0)
    assert record["dead_point_margin_deg"] == pytest.approx(90.0 - 35.0)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (("--from=-80 deg",), "has one at -60 deg; swing on one side of it, or turn the frame"),
        (
            ("--closed-length", "700 mm", "--cylinder-stroke", "500 mm"),
            "needs 670.74 mm, 29.2601 mm less; choose",
        ),
        (
            ("--closed-length", "650 mm", "--cylinder-stroke", "400 mm"),
            "21.4349 mm more; choose another cylinder, or",
        ),
        (("--bore", "40 mm", "--supply-pressure", "10 bar"), "needs 13.609 bar; got 10 bar; raise it"),
        (("--bore", "20 mm", "--piston-rod", "20 mm"), "the bore must exceed the piston rod"),
        (("--duration", "2 s"), "got 2 s; name a motion law such as cycloidal, or leave out the duration"),
        (("--mass", "-1 kg"), "--mass must be zero or more; got"),
        (("--rod", "0 mm"), "--rod must be positive; got"),
    ],
)
def test_a_swing_that_cannot_be_made_is_refused_with_the_amount(
    given: tuple[str, ...], sentence: str, command: Command
) -> None:
    done = command("lever", *LOADED, *given)
    assert done.exit_code == 2
    assert sentence in done.stderr
    assert done.stderr.startswith("slidercrank: ")


def test_a_table_of_points_is_not_among_the_laws(command: Command) -> None:
    done = command("lever", *LOADED, "--law", "table", "--duration", "1 s")
    assert done.exit_code == 2
    assert "'polynomial'" in done.stderr
    assert "'table'" not in done.stderr.replace("got 'table'", "").replace("'table' is not one of", "")


def test_a_bore_without_a_piston_rod_pulls_with_the_full_area_as_noted(command: Command) -> None:
    pulling = (*LOADED, "--seal-friction", "2 kN", "--bore", "40 mm")
    record = answered(command, *pulling)
    assert record["push_pressure_MPa"] > record["pull_pressure_MPa"] > 0.0
    assert record["notes"] == [
        "pull pressure and retracting flow are based on the full bore, because no piston rod was given"
    ]
    assert not any("full bore" in note for note in answered(command, *pulling, "--piston-rod", "22 mm")["notes"])
    assert answered(command, *LOADED, "--bore", "40 mm")["notes"] == []


def test_fitting_sizes_are_those_of_crank_and_frame_in_this_order(command: Command) -> None:
    fitted = (*LOADED, "--closed-length", "640 mm", "--cylinder-stroke", "440 mm")
    done = command("lever", *fitted, "--crank", "900 mm", "--rod", "350 mm")
    assert "if crank and frame are 885.475 mm and 385.665 mm" in done.stdout
    assert "if crank and frame are 385.665 mm and 885.475 mm" in command("lever", *fitted).stdout


def test_ends_and_the_place_of_a_mass_are_asked_for(command: Command) -> None:
    done = command("lever", *TIPPER[:-2])
    assert (done.exit_code, done.stderr) == (
        2,
        "slidercrank: a lever swings from one angle to another; got no --to; give both, or use a job with [motion]\n",
    )
    done = command("lever", *TIPPER, "--mass", "80 kg")
    assert "a carried mass needs a position on the lever; got 80 kg and no --centre" in done.stderr
    assert "the cylinder never has to push or pull" in command("lever", *TIPPER).stderr


def test_the_guide_prints_what_the_command_prints(
    command: Command, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    guide = (pytestconfig.rootpath / "docs/levers.md").read_text(encoding="utf-8")
    typed, other = re.findall(r"^```sh\n(.*?)^```$", guide, re.M | re.S)
    (printed,) = re.findall(r"^```text\n(.*?)^```$", guide, re.M | re.S)
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs/support.toml").write_bytes((pytestconfig.rootpath / "runs/support.toml").read_bytes())
    with contextlib.chdir(tmp_path):
        done, support = (command(*shlex.split(text.replace("\\\n", " "))[1:]) for text in (typed, other))
    answer = [" ".join(line.split()) for line in done.stdout.splitlines()]
    for line in printed.splitlines():
        assert line.strip() == "..." or " ".join(line.split()) in answer
    assert re.search(r"peak push +11998  N .* 2002.01 mm long", support.stdout)
    assert "lever angle error          0.450436  deg" in support.stdout
    assert {"tipper.csv", "tipper.png"} <= {file.name for file in tmp_path.iterdir()}
    with (tmp_path / "tipper.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["push_N"]) == pytest.approx(1710.09, abs=5e-3)
    assert float(rows[-1]["length_mm"]) == pytest.approx(1071.435, abs=5e-4)
