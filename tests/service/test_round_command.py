"""`slidercrank round`: rounded neighbours of a design of a run."""

from __future__ import annotations

import contextlib
import json
import re
import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from slidercrank.model.errors import InputError
from slidercrank.optimise.job import parse_job
from slidercrank.service.cli import app
from slidercrank.service.designs.stored_designs import front_of_result
from slidercrank.service.questions.round.analysis import steps_of
from slidercrank.service.runs.runs_on_disk import problem_of, read_run
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.weak_pins import TABLES

BAND = 'stroke = { min = "280 mm", max = "282 mm" }'
RATIO = "friction.guide = [0.05, 0.15]"
VARYING = "[variables]", '[variables]\n"mechanism.slider.mass" = ["1 kg", "2.05 kg"]'


@pytest.fixture(scope="module")
def banded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a place with a run of the small job, its stroke in a band, the slider's mass varying."""
    place, folder = tmp_path_factory.mktemp("banded"), tmp_path_factory.mktemp("job")
    job = fronts.job_file(folder)
    text = job.read_text().replace('stroke = { equals = "280 mm" }', BAND).replace(*VARYING)
    job.write_text(text.replace("[objectives]", '[objectives]\npeak_torque = "minimise"'))
    done = CliRunner().invoke(app, ["optimise", str(job), "--runs", str(place), "--no-figures"])
    assert done.exit_code == 0, done.output
    return place


def answer(command: Command, place: Path, number: int, *options: str, code: int = 0) -> dict[str, Any]:
    done = command("round", "latest", number, "--runs", place, *options, "--json")
    assert done.exit_code == code, done.output
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_help_names_the_command(command: Command) -> None:
    assert "  round " in command("--help").stdout
    assert command("round", "--help").exit_code == 0


def test_json_has_the_numbers_of_python(banded: Path, command: Command) -> None:
    (folder,) = (file.parent for file in banded.glob("*/front.json"))
    result = read_run(folder)
    front = front_of_result(problem_of(folder, result), result)
    expected = front.rounded(
        2, {"crank": 0.0005, "rod": 0.001, "offset": 0.0005, "mechanism.slider.mass": 0.1}, count=3
    )
    options = ("--to", "0.5 mm", "--to", "rod=1 mm", "--to", "mechanism.slider.mass=0.1 kg", "--count", "3")
    found = answer(command, banded, 3, *options)
    assert (found["met"], found["kept"], found["judged"]) == (True, expected.feasible_count, expected.judged)
    assert found["steps"] == {"crank_mm": 0.5, "rod_mm": 1.0, "offset_mm": 0.5, "slider_mass_kg": 0.1}
    assert found["given"] == {key: pytest.approx(result.designs[2][key], rel=1e-12) for key in found["given"]}
    rows = expected.designs.to_dict("records")
    assert len(rows) == len(found["designs"]) == 3
    for row, one in zip(rows, found["designs"], strict=True):
        assert (one.pop("missed"), one.pop("misses")) == ([], [])
        assert one == {key: value if isinstance(value, str) else pytest.approx(value) for key, value in row.items()}
        assert (one["crank_mm"] % 0.5, one["rod_mm"] % 1.0, round(one["slider_mass_kg"] * 10.0, 9) % 1.0) == (0, 0, 0)
        assert 280.0 <= one["slack_stroke_mm"] + 280.0 <= 281.0


def test_the_table_tells_changes_and_the_tightest_requirement(banded: Path, command: Command) -> None:
    best = answer(command, banded, 3, "--to", "0.5 mm", "--count", "1")["designs"][0]
    done = command("round", "latest", 3, "--runs", banded, "--to", "0.5 mm", "--count", "1")
    assert done.exit_code == 0
    for key in ("crank_mm", "rod_mm", "offset_mm", "time_ratio", "peak_torque_Nm"):
        assert f"{best[key]:.6g}" in done.stdout
    assert f"{best['change_peak_torque_percent']:+.2g}" in done.stdout
    assert f"{best['change_peak_torque_Nm']:+.3g}" in done.stdout
    assert "1: tightest is " in done.stdout
    assert "keep every requirement" in done.stdout
    assert done.stderr == "note: mechanism.slider.mass has no step and stays unchanged\n"


def test_inches_are_given_and_shown(banded: Path, command: Command) -> None:
    found = answer(command, banded, 3, "--to", "1/32 in", "--units", "inch")
    assert found["steps"] == {f"{name}_in": 0.03125 for name in ("crank", "rod", "offset")}
    for row in found["designs"]:
        for name in ("crank", "rod", "offset"):
            assert row[f"{name}_in"] * 32.0 == round(row[f"{name}_in"] * 32.0)
        assert not any(key.endswith("_mm") or key.endswith("_Nm") for key in row)
    metric = answer(command, banded, 3, "--to", "0.79375 mm")
    assert [row["loss_percent"] for row in metric["designs"]] == [row["loss_percent"] for row in found["designs"]]
    shown = command("round", "latest", 3, "--runs", banded, "--to", "0.01 in", "--units", "inch").stdout
    assert "crank 0.01 in" in shown
    assert "lbf in" in shown


def test_an_equality_that_cannot_be_met_is_exit_code_3_with_the_nearest_and_their_misses(
    kept: Path, command: Command
) -> None:
    found = answer(command, kept, 3, "--to", "0.5 mm", code=3)
    assert (found["met"], found["allowed"]) == (False, {})
    for row in found["designs"]:
        assert row["missed"] == ["stroke"]
        (miss,) = row["misses"]
        assert miss["amount"] == -row["slack_stroke_mm"] > 0.0
        assert (miss["quantity"], miss["kind"], miss["unit"], miss["allowed"]) == ("stroke", "length", "mm", 0.0)
        assert miss["side"] in ("below", "above")
    done = command("round", "latest", 3, "--runs", kept, "--to", "0.5 mm")
    assert done.exit_code == 3
    for number, row in enumerate(found["designs"], 1):
        assert (
            f"{number}: misses stroke by {-row['slack_stroke_mm']:.4g} mm ({row['misses'][0]['side']})" in done.stdout
        )
    assert "meets every requirement; these are the nearest; allow a miss of stroke, such as --allow" in done.stderr


def test_the_option_that_is_suggested_makes_the_nearest_designs_do(kept: Path, command: Command) -> None:
    for units in ("metric", "inch"):
        nearest = command("round", "latest", 3, "--runs", kept, "--to", "0.5 mm", "--units", units)
        option = nearest.stderr.partition('--allow "')[2].rstrip('"\n')
        assert option.startswith("stroke=")
        found = answer(command, kept, 3, "--to", "0.5 mm", "--units", units, "--allow", option)
        assert found["met"]
        for row in found["designs"]:
            (miss,) = row["misses"]
            assert 0.0 < miss["amount"] <= miss["allowed"] == float(option.split("=")[1].split()[0])
            assert miss["unit"] == option.split()[1]
        assert list(found["allowed"]) == ["stroke_mm" if units == "metric" else "stroke_in"]
        done = command("round", "latest", 3, "--runs", kept, "--to", "0.5 mm", "--units", units, "--allow", option)
        assert done.exit_code == 0
        amount = f"{found['designs'][0]['misses'][0]['amount']:.4g} {option.split()[1]}"
        assert f"1: misses stroke by {amount} (" in done.stdout
        assert f"{option.removeprefix('stroke=')} is allowed)" in done.stdout
        assert f"keep every requirement within {option.removeprefix('stroke=')} of stroke" in done.stdout


def test_a_terminal_shows_the_progress(kept: Path, command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    from slidercrank.service.commands import question_options

    shown: list[str] = []

    class Status:
        def update(self, text: str) -> None:
            shown.append(text)

    monkeypatch.setattr(question_options, "show_activity", lambda _: contextlib.nullcontext(Status()))
    done = command("round", "latest", 3, "--runs", kept, "--to", "0.5 mm")
    assert done.exit_code == 3, done.stderr
    assert shown[0].startswith("screening combinations 0/")
    assert shown[-1].startswith("searching for the nearest ")


def test_a_search_that_is_interrupted_ends_with_exit_code_130(
    kept: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    from slidercrank.optimise.front import rounding_search

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(rounding_search, "nondominated", interrupt)
    done = command("round", "latest", 3, "--runs", kept, "--to", "0.5 mm", "--allow", "stroke=1 mm")
    assert (done.exit_code, done.stdout) == (130, "")


@pytest.mark.parametrize(
    ("number", "steps", "words"),
    [
        (99, ["1 mm"], "the run has designs 1 to"),
        (1, ["0 mm"], "--to must be positive; got"),
        (1, ["-1 mm"], "--to must be positive; got"),
        (1, ["nan mm"], "--to must be a finite number"),
        (1, ["0.5"], "--to must be a length with its unit"),
        (1, ["1/0 in"], '--to must be a length; got "1/0 in"'),
        (1, ["1/32 kg"], '--to must be a length; got "1/32 kg"'),
        (1, ["crank="], '--to must be STEP or NAME=STEP; got "crank="; write it like "0.5 mm" or "rod=1 mm"'),
        (1, [""], '--to must be STEP or NAME=STEP; got ""; write it like'),
        (1, ["crank=1 kg"], "--to must be a length"),
        (1, ["mechanism.slider.mass=1 mm"], "--to must be a mass"),
        (1, ["rood=1 mm"], "--to must name crank, rod, offset, mechanism.slider.mass; got 'rood'"),
        (1, ["=1 mm"], "got ''"),
        (1, ["1 mm", "2 mm"], "got that of all lengths twice"),
        (1, ["rod=1 mm", "rod_in=2 mm"], "got rod twice"),
        (1, ["rod=700 mm"], "the step of rod must have a multiple within its range, 60 mm to 600 mm; got 700 mm"),
        (
            1,
            ["1e-9 mm"],
            "the step of crank must be at least 2e-07 mm, 1e-09 of 200 mm, the greatest in its range; got 1e-09 mm",
        ),
        (
            1,
            ["mechanism.slider.mass=1e-13 kg"],
            "slider.mass must be at least 2.05e-09 kg, 1e-09 of 2.05 kg, the greatest in its range; got 1e-13 kg",
        ),
        (1, ["1 kg"], 'got "1 kg", which is a mass; write it like "0.1 mm"'),
    ],
)
def test_a_wrong_request_is_one_sentence_and_exit_code_2(
    number: int, steps: list[str], words: str, banded: Path, command: Command
) -> None:
    done = command("round", "latest", number, "--runs", banded, *(f"--to={step}" for step in steps))
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert done.stderr.startswith("slidercrank: ")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("allow", "words"),
    [
        (
            ["strok=0.1 mm"],
            'only requirements of this job may be missed: transmission_angle, stroke; got "strok"; name one of them',
        ),
        (["stroke=0.1"], "the allowed deviation of stroke must be a length with its unit"),
        (["stroke=1 deg"], 'stroke must be a length; got "1 deg", which is an angle; write it like "0.1 mm"'),
        (
            ["stroke=1 %"],
            'the allowed deviation of stroke must be a length, not a percentage; got "1 %"; write "2.82 mm"',
        ),
        (["transmission_angle=.5%"], 'must be an angle, not a percentage; got ".5%"; write "0.2 deg"'),
        (["stroke=-1 mm"], "the allowed deviation of stroke must be positive"),
        (["0.1 mm"], '--allow must be REQUIREMENT=AMOUNT; got "0.1 mm"'),
        (["stroke=1 mm", "stroke=2 mm"], "--allow may give each name only once; got stroke twice"),
        (["stroke_in=1 mm", "stroke=2 mm"], "got two for stroke"),
    ],
)
def test_a_wrong_allowance_is_one_sentence_and_exit_code_2(
    allow: list[str], words: str, banded: Path, command: Command
) -> None:
    done = command("round", "latest", 1, "--runs", banded, "--to", "1 mm", *(f"--allow={text}" for text in allow))
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_count_of_none_is_refused_in_the_words_of_a_job(banded: Path, command: Command) -> None:
    done = command("round", "latest", 1, "--runs", banded, "--to", "1 mm", "--count", "0")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.endswith("Error: Invalid value for '--count': must be at least 1; got \"0\"\n")


def test_a_slow_stroke_is_no_requirement_that_may_be_missed_and_a_time_ratio_beside_it_is(
    tmp_path: Path, command: Command
) -> None:
    text = fronts.job_file(tmp_path).read_text().replace("[constraints]", '[constraints]\nslow_stroke = "inward"')
    for name, asked in (("slow", ""), ("ratio", "\ntime_ratio = { min = 1.1 }")):
        job = tmp_path / f"{name}.toml"
        job.write_text(text.replace("[constraints]", f"[constraints]{asked}"))
        assert command("optimise", job, "--runs", tmp_path / name, "--no-figures").exit_code == 0
    options = ("--to", "1 mm", "--count", "1", "--allow", "time_ratio=0.01", "--allow", "stroke=1 mm")
    done = command("round", "latest", 1, "--runs", tmp_path / "slow", *options)
    assert done.exit_code == 2
    assert 'may be missed: transmission_angle, stroke; got "time_ratio"' in done.stderr
    assert command("round", "latest", 1, "--runs", tmp_path / "ratio", *options).exit_code == 0


def test_a_pin_is_called_by_what_it_is(tmp_path: Path, command: Command) -> None:
    tables: dict[str, Any] = deepcopy(TABLES)
    tables["variables"]["sections"] = {"pins": {"crank_pin": ["5 mm", "15 mm"]}}
    (tmp_path / "job.json").write_text(json.dumps(tables))
    done = command("optimise", tmp_path / "job.json", "--runs", tmp_path / "runs", "--no-figures")
    assert done.exit_code == 0, done.output
    steps = ("--to", "1 mm", "--to", "sections.pins.crank_pin=0.5 mm")
    done = command("round", "latest", 1, "--runs", tmp_path / "runs", *steps, "--count", "1")
    assert done.exit_code == 0, done.output
    assert "rod 1 mm, offset 1 mm, crank pin diameter 0.5 mm" in done.stdout
    assert re.search("^ *crank pin diameter +mm", done.stdout, re.MULTILINE)
    assert "sections pins" not in done.stdout + command("front", "latest", "--runs", tmp_path / "runs").stdout


def test_a_formula_is_named_as_it_is_written(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    text = job.read_text().replace('stroke = { equals = "280 mm" }', BAND)
    job.write_text(text.replace("[objectives]", '[objectives]\n"max(rod, 2 * crank)" = "minimise"'))
    done = command("optimise", job, "--runs", tmp_path / "runs", "--no-figures")
    assert done.exit_code == 0, done.output
    done = command("round", "latest", 1, "--runs", tmp_path / "runs", "--to", "0.5 mm", "--count", "1")
    assert done.exit_code == 0, done.output
    assert "max(rod, 2 * crank)" in done.stdout
    assert "max rod 2" not in done.stdout


def test_a_number_without_a_unit_takes_a_plain_step() -> None:
    job = fronts.JOB.replace("[variables]", f"[friction]\nguide = 0.1\n[variables]\n{RATIO}")
    part = parse_job(tomllib.loads(job))
    assert steps_of(["friction.guide=0.01"], part, key="--to") == {"friction.guide": 0.01}
    with pytest.raises(InputError, match="--to must be positive"):
        steps_of(["friction.guide=-0.01"], part, key="--to")
