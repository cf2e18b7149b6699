"""Questions to a front: the same answers and errors in Python, commands, the API, its client and for agents."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.service.agents.call import Call, ToolResult
from slidercrank.service.agents.server import TOOLS
from slidercrank.service.cli import app as command_line
from slidercrank.service.client import Client
from slidercrank.service.designs.stored_designs import front_of_result
from slidercrank.service.jobs.submission import submit
from slidercrank.service.questions.discovery import FRONT_OR_JOB_QUESTIONS
from slidercrank.service.runs.result import json_ready
from slidercrank.service.runs.runs_on_disk import problem_of, read_run
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service import fronts
from tests.service.alike import assert_same
from tests.service.api.fixed_front import Solved, served

(ASK,) = (tool for tool in TOOLS if tool.name == "ask")
SECONDS = {"seconds": 20.0}
"""No proof of these tests takes as long: all doors get to its end."""


@dataclass(frozen=True)
class Doors:
    """A run at every door: its folder, the front in Python, a client and the number of its job."""

    folder: Path
    client: Client
    number: int
    front: sc.ParetoFront

    def command(self, name: str, row: int | None, given: Mapping[str, Any], *more: str) -> Any:
        """Return the last message of a command."""
        design = [] if row is None else [str(row + 1)]
        return CliRunner().invoke(command_line, [name, str(self.folder), *design, *options(name, given), *more])

    def printed(self, name: str, row: int | None, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the JSON output of a command without the names of the run and of the request."""
        done = self.command(name, row, given, "--json")
        assert done.exit_code == 0, done.stderr
        left = ("run", "wishes") if FRONT_OR_JOB_QUESTIONS[name].row != "must" else ("run", "number")
        return {key: value for key, value in json.loads(done.stdout).items() if key not in left}

    def agent(self, name: str, row: int | None, given: Mapping[str, Any]) -> ToolResult:
        """Return the answer to an agent."""
        design = {} if row is None else {"design": row + 1}
        return ASK.execute(
            call_in(self.folder.parent), {"run": self.folder.name, "topics": [name], **design, "inputs": given}
        )

    def refusals(self, name: str, row: int | None, given: Mapping[str, Any]) -> list[str]:
        """Return the sentences of Python, the client and agents."""
        asked: list[Callable[[], object]] = [
            lambda: self.front.ask(name, row, **given),
            lambda: self.client.ask(self.number, None if row is None else row + 1, name, **given),
            lambda: self.agent(name, row, given),
        ]
        return [refusal(ask) for ask in asked]


def call_in(runs: Path) -> Call:
    return Call(runs, frozenset(), lambda: False, lambda _: None)


def options(name: str, given: Mapping[str, Any]) -> list[str]:
    """Return inputs as a command line has them."""
    flags, words = FRONT_OR_JOB_QUESTIONS[name].flags, list[str]()
    for key, value in given.items():
        texts = [f"{of}={text}" for of, text in value.items()] if isinstance(value, dict) else value
        for text in texts if isinstance(texts, list) else [texts]:
            words += [flags[key], str(text)]
    return words


def refusal(ask: Callable[[], object]) -> str:
    with pytest.raises(InputError) as refused:
        ask()
    return str(refused.value)


def doors_of(solved: Solved, client: Client) -> Doors:
    result = read_run(solved.folder)
    return Doors(solved.folder, client, solved.number, front_of_result(problem_of(solved.folder, result), result))


@pytest.fixture(scope="module")
def doors(solved: Solved) -> Iterator[Doors]:
    with served(solved.store) as address, Client(address) as client:
        yield doors_of(solved, client)


NARROW = {
    "designs = ": "designs = 4\nsamples = 128 #",
    '["1.2 m", "1.5 m"]': '["1.38 m", "1.4 m"]',
    '["1.2 m", "3.0 m"]': '["2.0 m", "2.1 m"]',
    '["-600 mm", "600 mm"]': '["-60 mm", "60 mm"]',
}
"""What makes the support's job short."""


@pytest.fixture(scope="module", params=["nothing feasible", "a swing"])
def other(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Doors]:
    """Yield a run without designs, and one of a crank that swings."""
    place = tmp_path_factory.mktemp("other")
    if request.param == "a swing":
        text = Path("runs/support.toml").read_text(encoding="utf-8")
        for before, after in NARROW.items():
            text = text.replace(before, after)
    else:
        text = fronts.JOB.replace('"40 deg"', '"80 deg"')
    (place / "job.toml").write_text(text, encoding="utf-8")
    done = CliRunner().invoke(
        command_line, ["optimise", str(place / "job.toml"), "--runs", str(place / "runs"), "--no-figures"]
    )
    assert done.exit_code in (0, 3), done.stderr
    (folder,) = (path.parent for path in place.glob("runs/*/front.json"))
    with Store(place / "store.db") as store:
        number = submit(store, tomllib.loads(text)).id
        work(store, drain=True)
        result = read_run(folder)
        with served(store) as address, Client(address) as client:
            yield Doors(folder, client, number, front_of_result(problem_of(folder, result), result))


def assert_alike(doors: Doors, name: str, row: int | None, given: dict[str, Any]) -> dict[str, Any]:
    """Compare the answers of all doors; return that of Python."""
    answer = doors.front.ask(name, row, **given)
    timed = {"seconds"}
    expected = {key: value for key, value in answer.items() if key not in timed}
    sent = doors.client.ask(doors.number, None if row is None else row + 1, name, **given)
    for found in (sent, doors.printed(name, row, given), json_ready(doors.agent(name, row, given).record)):
        assert_same({key: found[key] for key in expected}, expected)
        assert found.keys() - expected.keys() <= timed | {"run", "job", "columns"}
    return answer


@pytest.mark.slow
def test_random_wishes_have_the_same_design_at_every_door(doors: Doors) -> None:
    front, random = doors.front, np.random.default_rng(31)
    for _ in range(3):
        row = int(random.integers(len(front)))
        ratio = float(random.uniform(*np.sort(-front.values[[0, -1], 0])))
        angle = float(np.degrees(random.uniform(*np.sort(-front.values[[0, -1], 1]))))
        free = assert_alike(
            doors, "wish", None, {"at": {"time_ratio": f"{ratio!r}", "transmission_angle": f"{angle!r} deg"}}
        )
        assert free["number"] is None
        assert free["design"]["status"] == "stationary"
        better = assert_alike(
            doors, "wish", row, {"at": {"time_ratio": "free", "transmission_angle": f"{angle!r} deg"}}
        )
        assert better["number"] == row + 1
        reached = {one["quantity"]: one["reached"] for one in better["objectives"]}
        assert reached["transmission_angle"] == pytest.approx(better["design"]["least_transmission_angle_deg"])


def test_a_wish_in_texts_is_one_by_name(doors: Doors) -> None:
    by_name, texts = (
        {"time_ratio": "1.3", "transmission_angle": "50 deg"},
        ["time_ratio = 1.3", "transmission_angle=50 deg"],
    )
    assert doors.front.ask("wish", at=texts) == doors.front.ask("wish", at=by_name)


def test_random_steps_round_a_design_alike_at_every_door(doors: Doors) -> None:
    random = np.random.default_rng(33)
    for row in random.choice(len(doors.front), 2, replace=False).tolist():
        step, miss, count = (
            round(float(random.uniform(0.5, 2.0)), 3),
            float(random.uniform(0.2, 1.0)),
            int(random.integers(1, 5)),
        )
        given = {"to": [f"{step} mm", "rod=5 mm"], "allow": [f"stroke={miss!r} mm"], "count": count}
        rounded = assert_alike(doors, "round", row, given)
        assert 1 <= len(rounded["designs"]) <= count
        for design in rounded["designs"]:
            assert design["rod_mm"] % 5.0 == pytest.approx(0.0)
            assert (
                abs(design["stroke_mm"] - 280.0 if "stroke_mm" in design else design["slack_stroke_mm"]) <= miss + 1e-9
            )


@pytest.mark.slow
def test_a_random_limit_gives_a_like_design_at_every_door(doors: Doors) -> None:
    random = np.random.default_rng(34)
    for row in random.choice(len(doors.front), 2, replace=False).tolist():
        rod = float(1e3 * doors.front.dimensions[row, 1] * random.uniform(0.8, 0.97))
        like = assert_alike(doors, "like", row, {"where": [f"rod <= {rod!r} mm"]})
        assert like["design"]["rod_mm"] <= rod * (1.0 + 1e-9)
        moved = like["design"]["rod_mm"] - doors.front.designs["rod_mm"].iloc[row]
        assert like["moved"]["rod_mm"] == pytest.approx(moved)


@pytest.mark.slow
def test_what_no_design_meets_is_an_answer_at_every_door(doors: Doors) -> None:
    impossible = {"where": ["transmission_angle >= 89 deg"]}
    answer = doors.front.ask("like", 1, **impossible)
    assert (answer["status"], list(answer)) == ("infeasible", ["status", "message"])
    assert doors.client.ask(doors.number, 2, "like", **impossible) == answer
    done = doors.command("like", 1, impossible)
    assert (done.exit_code, done.stderr.strip()) == (3, f"slidercrank: {answer['message']}")
    assert doors.agent("like", 1, impossible).is_error
    coarse = {"to": "100 mm"}
    rounded, done = doors.front.ask("round", 1, **coarse), doors.command("round", 1, coarse)
    assert not rounded["met"]
    assert done.exit_code == 3
    assert done.stderr.strip().startswith(f"slidercrank: {rounded['message']}")


def test_a_random_proof_is_the_same_at_every_door(doors: Doors) -> None:
    epsilon = float(np.random.default_rng(32).uniform(0.1, 0.3))
    proof = assert_alike(doors, "certify", None, {"epsilon": epsilon, **SECONDS})
    assert proof["status"] == "proven"
    assert proof["epsilon"] <= epsilon
    assert all(row["stroke_mm"] == pytest.approx(280.0) for row in proof["added"])


@pytest.mark.slow
def test_what_is_told_to_people_is_in_the_units_of_each_door(doors: Doors) -> None:
    given = {"at": {"time_ratio": "1.3"}}
    for units, unit, key in (("metric", "mm", "crank_mm"), ("inch", "in", "crank_in")):
        done = doors.command("wish", None, given, "--units", units)
        asked = {"run": doors.folder.name, "topics": ["wish"], "inputs": given, "units": units}
        answer = ASK.execute(call_in(doors.folder.parent), asked)
        assert answer.text.splitlines() == done.stdout.strip().splitlines()
        (line,) = (line for line in answer.text.splitlines() if line.startswith("crank  "))
        assert line.split() == ["crank", unit, f"{answer.record['design'][key]:.6g}"]


@pytest.mark.slow
def test_a_front_without_designs_and_a_swing_answer_alike_at_every_door(other: Doors) -> None:
    if len(other.front):
        proof = assert_alike(other, "certify", None, {"epsilon": 0.5, **SECONDS})
        assert proof["status"] == "proven"
        force = float(np.median(other.front.values[:, 0]))
        given = {"at": {"peak_actuator_force": f"{force!r} N"}}
        wished = other.front.ask("wish", **given)
        assert_same(other.printed("wish", None, given), wished)
        reached = other.client.ask(other.number, None, "wish", **given)["objectives"][0]["reached"]
        assert reached == pytest.approx(wished["objectives"][0]["reached"], rel=1e-9)
    else:
        assert assert_alike(other, "certify", None, {})["infeasible"]
        (sentence,) = set(other.refusals("wish", None, {"at": {"time_ratio": "1.2"}}))
        assert sentence.startswith("a wish needs a front with designs; this one is empty: ")
        assert other.command("wish", None, {"at": {"time_ratio": "1.2"}}).exit_code == 3


@pytest.mark.slow
def test_a_random_sweep_has_the_same_rows_in_python_by_the_command_and_for_agents(tmp_path: Path) -> None:
    random = np.random.default_rng(35)
    job = tmp_path / "job.toml"
    job.write_text(fronts.JOB, encoding="utf-8")
    problem = sc.load_job(job)
    for units in ("metric", "inch"):
        crank, offset = float(random.uniform(30, 60)), float(random.uniform(0, 30))
        given = {
            "over": [f"rod={crank!r} mm..300 mm:7", "speed=100 rpm, -30 rpm"],
            "of": ["stroke,peak_torque", "crank + rod"],
        }
        lengths = {"crank": f"{crank!r} mm", "offset": f"{offset!r} mm"}
        done = CliRunner().invoke(
            command_line, ["sweep", str(job), *options("sweep", given | lengths), "--json", "--units", units]
        )
        assert done.exit_code == 0, done.stderr
        agent = ASK.execute(
            call_in(tmp_path), {"job": fronts.JOB, **lengths, "topics": ["sweep"], "inputs": given, "units": units}
        )
        assert json_ready(agent.record) == {"rows": json.loads(done.stdout)}
        assert len(agent.record["rows"]) == 14
        if units == "metric":
            in_si = {"crank": crank / 1e3, "offset": offset / 1e3}
            assert_same(problem.ask("sweep", **given, **in_si), json_ready(agent.record))
            stroke = problem.ask("sweep", over=given["over"][0], of="stroke", **lengths)["rows"][-1]["stroke_mm"]
            assert stroke == pytest.approx(1e3 * float(sc.Linkage(crank / 1e3, 0.3, offset / 1e3).stroke))


SWEEPS: list[tuple[dict[str, Any], str]] = [
    ({"over": "rod=80 mm, 90 mm"}, 'sweep needs of; got none; give it like "crank + rod"'),
    (
        {"over": "rod=80 mm, 90 mm", "of": "stroke", "to": 1},
        "sweep may only be given over, of, crank, rod, offset; got to; ",
    ),
    (
        {"over": "mass=1 kg, 2 kg", "of": "stroke"},
        "a sweep must be over one of crank, rod, offset, speed; got 'mass'; ",
    ),
    ({"over": "rod=80", "of": "stroke"}, 'over rod must be a length with its unit; got "80"; write it like '),
    ({"over": "rod=80 mm, 90 mm", "of": "stroke"}, 'crank is needed; write it like crank "40 mm"'),
    (
        {"over": "rod=80 mm, 90 mm", "of": "stroke", "rod": "3 mm"},
        "rod may be set by over or by rod; got both; leave out one",
    ),
    (
        {"over": "rod=80 mm, 90 mm", "of": "stroke", "crank": "3 kg"},
        'crank must be a length; got "3 kg", which is a mass',
    ),
    (
        {"over": ["rod=80 mm", "crank=3 mm", "offset=3 mm"], "of": "stroke"},
        "a sweep must have one or two parameters; got 3",
    ),
]


@pytest.mark.parametrize(("given", "sentence"), SWEEPS)
def test_a_wrong_sweep_is_refused_in_the_same_sentence(tmp_path: Path, given: dict[str, Any], sentence: str) -> None:
    problem = sc.problem(tomllib.loads(fronts.JOB))
    said = refusal(lambda: problem.ask("sweep", **given))
    assert said.startswith(sentence)
    asked = {"job": fronts.JOB, "topics": ["sweep"], "inputs": given}
    assert refusal(lambda: ASK.execute(call_in(tmp_path), asked)) == said


def test_a_job_that_swings_is_swept_at_no_door(tmp_path: Path) -> None:
    given = {"over": "rod=80 mm, 90 mm", "of": "stroke"}
    done = CliRunner().invoke(command_line, ["sweep", "runs/support.toml", *options("sweep", given)])
    said = refusal(lambda: sc.load_job("runs/support.toml").ask("sweep", **given))
    assert said == refusal(
        lambda: ASK.execute(call_in(tmp_path), {"job": "support", "topics": ["sweep"], "inputs": given})
    )
    assert (done.exit_code, done.stderr.strip()) == (2, f"slidercrank: {said}")


WRONG: list[tuple[str, int | None, dict[str, Any], str]] = [
    ("wish", None, {}, "wish needs at; got none; give it like "),
    ("wish", None, {"at": {"time_ratio": "1.3"}, "of": 3}, "wish may only be given at; got of; leave of out"),
    ("wish", None, {"at": 3}, "at must be a table of keys; got 3; write it like "),
    ("wish", None, {"at": ["time_ratio"]}, 'at must be OBJECTIVE=VALUE or OBJECTIVE=CLASS; got "time_ratio"; write'),
    ("wish", None, {"at": {"nothing": "1"}}, "a wish must name one of the objectives "),
    ("wish", 1, {"at": {"time_ratio": "keep", "transmission_angle": "keep"}}, "no wish was given; give one of "),
    ("certify", None, {"epsilon": "a little"}, 'epsilon must be a number; got "a little"; write it like 0.01'),
    ("certify", None, {"epsilon": True}, "epsilon must be a number; got true; write it like 0.01"),
    ("certify", None, {"delta": 0.1}, "certify may only be given epsilon, seconds; got delta; leave delta out"),
    ("round", 1, {}, 'round needs to; got none; give it like "0.5 mm"'),
    ("round", None, {"to": "1 mm"}, "round needs one design on the front; got none; name it"),
    ("round", 1, {"to": "1 kg"}, 'to must be a length; got "1 kg", which is a mass; write it like '),
    ("round", 1, {"to": ["1 mm", 2]}, "to must be text in quotes; got "),
    ("round", 1, {"to": "1 mm", "count": 0}, "count must be at least 1; got 0; write it like 5"),
    (
        "round",
        1,
        {"to": "1 mm", "allow": "stroke"},
        'allow must be REQUIREMENT=AMOUNT; got "st',
    ),
    ("like", 1, {"where": ["nothing <= 2"]}, "there is no quantity or column 'nothing'; "),
    (
        "like",
        1,
        {"where": ["rod != 2 mm"]},
        "a condition must use >=, <= or =; got 'rod != 2 mm'; write it like ",
    ),
    ("like", None, {"where": "rod <= 2 mm"}, "like needs one design on the front; got none; name it"),
    ("certify", 0, {}, "certify applies to the whole front; got one design; leave it out"),
]


@pytest.mark.parametrize(("name", "row", "given", "sentence"), WRONG)
def test_what_is_wrong_is_refused_in_the_same_sentence(
    doors: Doors, name: str, row: int | None, given: dict[str, Any], sentence: str
) -> None:
    (said,) = set(doors.refusals(name, row, given))
    assert said.startswith(sentence)
    assert "\n" not in said


def test_questions_are_asked_of_what_they_are_of(doors: Doors) -> None:
    front = doors.front
    assert refusal(lambda: front.ask("press")) == (
        "the question press needs one design; got none; name one, as a row of a front or lengths"
    )
    assert refusal(lambda: front.problem.ask("certify")) == (
        "the question certify needs a front; got a job; write it like front.ask(question)"
    )
    assert refusal(lambda: front.ask("sweep", of="stroke")) == (
        "the question sweep needs a job; got a front; write it like problem.ask(question)"
    )
    assert refusal(lambda: doors.client.ask(doors.number, None, "sweep")).startswith("a service cannot answer sweep; ")
    assert refusal(lambda: front.problem.ask("certify", front.dimensions[0])) == (
        "the question certify needs a front; got a design; write it like front.ask(question)"
    )
    assert refusal(lambda: front.ask("whish", at={})).endswith("did you mean wish?")
    assert refusal(lambda: doors.client.ask(doors.number, None, "press")).startswith("press needs a design; got none")
    for subject, sentence in (
        ({"job": fronts.JOB}, "this topic needs the front of a run; got a job; name a run, without a job"),
        (
            {"run": doors.folder.name, "crank": "40 mm"},
            "dimensions must not be given with a run, whose designs have their own; got run and crank",
        ),
        ({"run": doors.folder.name, "design": 99}, "the run has designs 1 to "),
    ):
        inputs = {"topics": ["certify"], **subject}
        assert refusal(partial(ASK.execute, call_in(doors.folder.parent), inputs)).startswith(sentence)


ADDED = """
import json, sys
import slidercrank.service.questions as package
package.__path__.append(sys.argv[1])
from pathlib import Path
from slidercrank.service.agents.server import TOOLS
from slidercrank.service.designs.stored_designs import front_of_result
from slidercrank.service.runs.runs_on_disk import problem_of, read_run
from tests.service.test_front_and_job_questions import ASK, call_in

folder = Path(sys.argv[2])
front = front_of_result(problem_of(folder, read_run(folder)), read_run(folder))
inputs = {"column": "rod_mm"}
asked = {"run": folder.name, "topics": ["reach"], "inputs": inputs, "units": "inch"}
agent = ASK.execute(call_in(folder.parent), asked)
print(json.dumps([front.ask("reach", **inputs), agent.record, agent.text]))
"""


@pytest.mark.slow
def test_the_recipe_adds_a_question_that_python_and_agents_have(
    doors: Doors, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    root = pytestconfig.rootpath
    page = (root / "docs" / "architecture.md").read_text(encoding="utf-8")
    section = page.split("## A new question about a front or a job")[1].split("\n## ")[0]
    (tmp_path / "reach").mkdir()
    codes = re.findall(r"^```python\n(.*?)^```$", section, flags=re.MULTILINE | re.DOTALL)
    for name, code in zip(("__init__.py", "analysis.py"), codes, strict=True):
        (tmp_path / "reach" / name).write_text(code, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", ADDED, str(tmp_path), str(doors.folder)],
        cwd=root,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    answer, record, text = json.loads(done.stdout)
    rods = doors.front.columns["rod_mm"]
    assert answer == {"least_rod_mm": rods.min(), "greatest_rod_mm": rods.max()}
    assert record["greatest_rod_in"] == pytest.approx(rods.max() / 25.4)
    assert text == f"{rods.min() / 25.4:.6g} in to {rods.max() / 25.4:.6g} in"
