"""`slidercrank wish`: the answer of Python, in words and as JSON; refusals."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from slidercrank.optimise.questions.wish import wish
from slidercrank.service.designs.stored_designs import front_of
from slidercrank.service.runs.stored_runs import problem_of, read_run
from tests.service.conftest import Command

ASKED = {"time_ratio": "1.3", "transmission_angle": "50 deg"}


def at(wishes: dict[str, str]) -> list[str]:
    return [part for name, value in wishes.items() for part in ("--at", f"{name}={value}")]


def test_json_has_the_numbers_of_python(kept: Path, command: Command) -> None:
    (folder,) = (file.parent for file in kept.glob("*/front.json"))
    result = read_run(folder)
    expected = wish(front_of(problem_of(folder, result), result), ASKED)
    done = command("wish", "latest", "--runs", kept, *at(ASKED), "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert (found["wishes"], found["number"], found["possible"]) == (ASKED, None, expected.possible)
    assert found["sentences"] == expected.sentences()
    assert found["achievement"] == expected.value
    assert found["design"]["crank_mm"] == expected.found.columns["crank_mm"][0]
    assert found["design"]["residual"] <= 1e-6
    reached = {item["quantity"]: (item["wished"], item["reached"]) for item in found["objectives"]}
    angle = found["design"]["least_transmission_angle_deg"]
    assert reached["transmission_angle"] == (pytest.approx(50.0), pytest.approx(angle))


def test_words_of_a_wish_and_of_classes(kept: Path, command: Command) -> None:
    front = json.loads(command("front", "latest", "--runs", kept, "--json").stdout)["designs"]
    shown = command("wish", "latest", "--runs", kept, *at({"time_ratio": "1.0", "transmission_angle": "1 deg"}))
    assert shown.exit_code == 0, shown.output
    assert "The wish can be had, and better in all of it:" in shown.stdout
    assert "better than the 1 deg wished" in shown.stdout
    assert "stationary: residual" in shown.stdout
    least = front[2]["least_transmission_angle_deg"] - 1.0
    classes = {"time_ratio": "improve", "transmission_angle": f"may worsen to {least!r} deg"}
    found = json.loads(command("wish", "latest", 3, "--runs", kept, *at(classes), "--json").stdout)
    assert found["number"] == 3
    assert found["design"]["least_transmission_angle_deg"] == pytest.approx(least, rel=1e-9)
    assert found["design"]["time_ratio"] > front[2]["time_ratio"]


@pytest.mark.parametrize(
    ("number", "wishes", "code", "words"),
    [
        ([], ["time_ratio"], 2, "a wish is an objective, =, and a value or a class; got 'time_ratio'"),
        ([], ["time_ratio=1.2", "time_ratio=1.3"], 2, "two for time_ratio"),
        ([], ["transmission_angle=45"], 2, 'must be an angle with its unit; got "45"'),
        ([], ["time_ratio=nan"], 2, "must be a finite number"),
        ([], ["crank=40 mm"], 2, "one of the objectives time_ratio, transmission_angle; got 'crank'"),
        ([99], ["time_ratio=1.2"], 2, "the run has designs 1 to"),
        ([], ["time_ratio=improve"], 2, "got no design"),
        ([2], ["time_ratio=improve", "transmission_angle=keep"], 2, "design 2 is Pareto-optimal"),
        ([], ["time_ratio=1.2", "transmission_angle=may worsen to 89 deg"], 3, "89 deg or better, where the front has"),
    ],
)
def test_wishes_that_make_no_sense_are_told_in_a_sentence(
    kept: Path, command: Command, number: list[int], wishes: list[str], code: int, words: str
) -> None:
    options = [part for text in wishes for part in ("--at", text)]
    done = command("wish", "latest", *number, "--runs", kept, *options)
    assert (done.exit_code, len(done.stderr.strip().splitlines())) == (code, 1)
    assert words in done.stderr
