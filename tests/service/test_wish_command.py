"""`slidercrank wish`: the answer of Python, in words and as JSON; refusals."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import httpx
import numpy as np
import pytest

from slidercrank.optimise.decisions.wish import wish
from slidercrank.service.api.app import create_app
from slidercrank.service.designs.stored_designs import front_of_result
from slidercrank.service.jobs.stores import open_store
from slidercrank.service.runs.runs_on_disk import problem_of, read_run
from tests.service.api.serving import serving
from tests.service.conftest import Command

QUESTIONS = {"time_ratio": "1.3", "transmission_angle": "50 deg"}


def wish_options(wishes: dict[str, str]) -> list[str]:
    return [part for name, value in wishes.items() for part in ("--at", f"{name}={value}")]


def test_json_has_the_numbers_of_python(kept: Path, command: Command) -> None:
    (folder,) = (file.parent for file in kept.glob("*/front.json"))
    result = read_run(folder)
    expected = wish(front_of_result(problem_of(folder, result), result), QUESTIONS)
    done = command("wish", "latest", "--runs", kept, *wish_options(QUESTIONS), "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert (found["wishes"], found["number"], found["possible"]) == (QUESTIONS, None, expected.possible)
    assert found["sentences"] == expected.sentences()
    assert found["achievement"] == expected.value
    assert found["design"]["crank_mm"] == expected.found.columns["crank_mm"][0]
    assert found["design"]["residual"] <= 1e-6
    reached = {item["quantity"]: (item["wished"], item["reached"]) for item in found["objectives"]}
    angle = found["design"]["least_transmission_angle_deg"]
    assert reached["transmission_angle"] == (pytest.approx(50.0), pytest.approx(angle))


def test_words_of_a_wish_and_of_classes(kept: Path, command: Command) -> None:
    front = json.loads(command("front", "latest", "--runs", kept, "--json").stdout)["designs"]
    shown = command(
        "wish", "latest", "--runs", kept, *wish_options({"time_ratio": "1.0", "transmission_angle": "1 deg"})
    )
    assert shown.exit_code == 0, shown.output
    assert "The wish can be met and exceeded in every objective:" in shown.stdout
    assert "better than the desired 1 deg" in shown.stdout
    assert "stationary: residual" in shown.stdout
    least = front[2]["least_transmission_angle_deg"] - 1.0
    classes = {"time_ratio": "improve", "transmission_angle": f"may worsen to {least!r} deg"}
    found = json.loads(command("wish", "latest", 3, "--runs", kept, *wish_options(classes), "--json").stdout)
    assert found["number"] == 3
    assert found["design"]["least_transmission_angle_deg"] == pytest.approx(least, rel=1e-9)
    assert found["design"]["time_ratio"] > front[2]["time_ratio"]


@pytest.mark.parametrize(
    ("number", "wishes", "code", "words"),
    [
        ([], ["time_ratio"], 2, '--at must be OBJECTIVE=VALUE or OBJECTIVE=CLASS; got "time_ratio"'),
        ([], ["time_ratio=1.2", "time_ratio=1.3"], 2, "--at may give each name only once; got time_ratio twice"),
        ([], ["transmission_angle=45"], 2, 'must be an angle with its unit; got "45"'),
        ([], ["time_ratio=nan"], 2, "must be a finite number"),
        ([], ["crank=40 mm"], 2, "one of the objectives time_ratio, transmission_angle; got 'crank'"),
        ([99], ["time_ratio=1.2"], 2, "the run has designs 1 to"),
        ([], ["time_ratio=improve"], 2, "got none; name one"),
        ([2], ["time_ratio=improve", "transmission_angle=keep"], 2, "design 2 is Pareto-optimal"),
        (
            [],
            ["time_ratio=1.2", "transmission_angle=may worsen to 89 deg"],
            3,
            "89 deg or better, but the best on the front is",
        ),
    ],
)
def test_wishes_that_make_no_sense_are_told_in_a_sentence(
    kept: Path, command: Command, number: list[int], wishes: list[str], code: int, words: str
) -> None:
    options = [part for text in wishes for part in ("--at", text)]
    done = command("wish", "latest", *number, "--runs", kept, *options)
    assert (done.exit_code, len(done.stderr.strip().splitlines())) == (code, 1)
    assert words in done.stderr


def test_wishes_are_listed_wherever_they_were_made_the_latest_first_and_each_once(
    kept: Path, tmp_path: Path, command: Command
) -> None:
    place = tmp_path / "runs"
    shutil.copytree(kept, place)
    before = len(json.loads(command("wish", "latest", "--runs", place, "--list", "--json").stdout)["made"])
    random, made = np.random.default_rng(41), []
    front = json.loads(command("front", "latest", "--runs", place, "--json").stdout)["designs"]
    for row in random.integers(1, len(front) - 1, 2).tolist():
        ratio, angle = front[row]["time_ratio"], front[row]["least_transmission_angle_deg"]
        made += [
            ([], {"time_ratio": f"{ratio!r}", "transmission_angle": f"{angle + random.uniform(-2.0, 2.0)!r} deg"}),
            ([row + 1], {"time_ratio": "improve", "transmission_angle": f"may worsen to {angle - 0.5!r} deg"}),
        ]
    made.append(made[0])
    answers = []
    for number, wishes in made:
        done = command("wish", "latest", *number, "--runs", place, *wish_options(wishes), "--json")
        assert done.exit_code == 0, done.output
        answers.append(json.loads(done.stdout))
    listed = json.loads(command("wish", "latest", "--runs", place, "--list", "--json").stdout)["made"]
    expected = answers[:0:-1]
    assert len(listed) - before == len(expected) == len(made) - 1
    for found, answer in zip(listed, expected, strict=False):
        for key in ("number", "possible", "sentences"):
            assert found[key] == answer[key]
        assert found["achievement"] == pytest.approx(answer["achievement"], rel=1e-9, abs=1e-12)
        for key in ("crank_mm", "rod_mm", "offset_mm"):
            assert found["design"][key] == pytest.approx(answer["design"][key], rel=1e-7, abs=1e-6)
    told = command("wish", "latest", "--runs", place, "--list")
    assert told.exit_code == 0
    assert told.stdout.count("time_ratio") >= len(listed)
    with open_store(None, place) as store, serving(create_app(store)) as address:
        of_the_page = httpx.get(f"{address}/api/v1/jobs/1/wishes").json()["made"]
    assert [one["at"] for one in of_the_page] == [one["at"] for one in listed]


def test_a_wish_and_the_list_at_once_or_neither_is_told(kept: Path, command: Command) -> None:
    for options, got in (([], "neither"), ([*wish_options(QUESTIONS), "--list"], "both")):
        done = command("wish", "latest", "--runs", kept, *options)
        assert done.exit_code == 2
        assert f"either a wish or --list; got {got}" in done.output


def test_a_run_without_a_store_answers_and_has_no_list(kept: Path, tmp_path: Path, command: Command) -> None:
    place = tmp_path / "runs"
    shutil.copytree(kept, place)
    for file in place.glob("slidercrank.db*"):
        file.unlink()
    (folder,) = (file.parent for file in place.glob("*/front.json"))
    assert command("wish", folder, *wish_options(QUESTIONS), "--json").exit_code == 0
    assert "no wishes yet; make one" in command("wish", folder, "--list").stdout
