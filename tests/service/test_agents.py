"""`slidercrank mcp`, asked by the official client: from a feeder's description to a report, and all that is refused."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import psutil
import pytest
from anyio.from_thread import BlockingPortal, start_blocking_portal
from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client
from mcp_types import CallToolResult
from typer.testing import CliRunner

from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.service.agents.call import ToolResult
from slidercrank.service.agents.server import TOOLS
from slidercrank.service.agents.tool import Tool
from slidercrank.service.cli import app
from slidercrank.service.questions.discovery import DESIGN_QUESTIONS, INPUTS, QUESTIONS, TOPICS
from slidercrank.service.questions.record_types import schema_of
from slidercrank.service.render.numerals import format_cell
from slidercrank.service.text.tables import ROWS
from tests.faults.waits import Stopwatch
from tests.service import fronts, sized

pytestmark = pytest.mark.skipif(os.name != "posix", reason="what the server writes is copied by a shell")
OWN = """
import os, subprocess

def loud(designs):
    print("loud", flush=True)
    os.write(1, b"louder\\n")
    subprocess.run(["echo", "loudest"])
    return designs.crank
"""
OWN_TABLES = '[quantity.mine]\nfunction = "FUNCTION"\nunit = "mm"\ngradient = "finite differences"\n'
LONG = fronts.JOB.replace("samples = 512\n", 'method = "nsga2"\nsamples = 40\nevaluations = 6000\n')
IMPOSSIBLE = fronts.JOB.replace("transmission_angle = {", "time_ratio = { min = 1.5 }\ntransmission_angle = {")
SWUNG = {"crank": "1.4 m", "rod": "1.8 m", "offset": "-50 mm"}
PROGRAM = "from slidercrank.service.cli import main; main()"


@dataclass
class Agent:
    """A client of a server in a process of its own. folder: where it works. written: all that the server wrote."""

    portal: BlockingPortal
    client: Client
    folder: Path
    written: Path
    progress: list[tuple[float, str]] = field(default_factory=list)

    @property
    def runs(self) -> Path:
        return self.folder / "runs"

    async def _heard(self, progress: float, total: float | None, message: str | None) -> None:
        assert total is None
        self.progress.append((progress, message or ""))

    def begin(self, tool: str, **inputs: Any) -> Any:
        """Return the future of a call."""
        self.progress.clear()
        call = partial(self.client.call_tool, tool, inputs, progress_callback=self._heard)
        return self.portal.start_task_soon(call)

    def answer(self, tool: str, /, **inputs: Any) -> CallToolResult:
        found: CallToolResult = self.begin(tool, **inputs).result(timeout=120)
        return found

    def ask(self, tool: str, /, **inputs: Any) -> dict[str, Any]:
        """Return the structured answer of a call that succeeds."""
        found = self.answer(tool, **inputs)
        assert not found.is_error, text_of(found)
        assert isinstance(found.structured_content, dict)
        return found.structured_content

    def refused(self, tool: str, /, **inputs: Any) -> str:
        """Return the sentence of a call that is refused."""
        found = self.answer(tool, **inputs)
        assert found.is_error, text_of(found)
        assert "Traceback" not in text_of(found)
        return text_of(found)


def text_of(found: CallToolResult) -> str:
    (block,) = found.content
    assert block.type == "text"
    return str(block.text)


@pytest.fixture(scope="module")
def agent(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Agent]:
    folder = tmp_path_factory.mktemp("agent")
    (folder / "own_loud.py").write_text(OWN)
    server = [sys.executable, "-c", PROGRAM, "mcp", "--runs", "runs", "--allow-quantity", "own_loud:loud"]
    params = StdioServerParameters(
        command="sh",
        args=["-c", '"$@" | tee "$0"', str(folder / "written.txt"), *server],
        env={**os.environ, "SLIDERCRANK_STORE": str(folder / "elsewhere.db")},
        cwd=folder,
    )
    with (
        start_blocking_portal() as portal,
        portal.wrap_async_context_manager(Client(stdio_client(params))) as client,
    ):
        yield Agent(portal, client, folder, folder / "written.txt")


@pytest.fixture(scope="module")
def run(agent: Agent) -> str:
    """Return the name of a run that the agent has made."""
    return Path(agent.ask("optimise", job=fronts.JOB)["run"]).name


def command(*words: object) -> Any:
    """Return the JSON output of a command."""
    done = CliRunner().invoke(app, [*map(str, words), "--json"])
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


def without_changing_parts(record: dict[str, Any]) -> dict[str, Any]:
    """Return the record of a run without what differs each time."""
    return {key: value for key, value in record.items() if key not in ("run", "seconds", "numbers")}


def test_five_calls_lead_from_a_description_to_a_report(agent: Agent, tmp_path: Path) -> None:
    known = agent.ask("list")
    (near,) = (job["name"] for job in known["jobs"] if "feeder" in job["sentence"])
    text = agent.ask("describe", name=near)["job"]["toml"].replace("2400 rpm", "1800 rpm").replace('"2 kN"', '"1 kN"')
    assert agent.ask("check", job=text)["valid"]
    found = agent.ask("optimise", job=text, designs=6, seed=3, rows=0, columns=["all"])
    assert [time for time, _ in agent.progress] == sorted({time for time, _ in agent.progress})
    assert all(re.fullmatch(r"[a-z ]+ [\d,]+/[\d,]+: [\d,]+ evaluated, .*", words) for _, words in agent.progress)
    files = agent.ask("files", run=Path(found["run"]).name, write=["report"])["files"]
    page = Path(files["report"][0]).read_text(encoding="utf-8")
    knee = found["designs"][found["knee"]].values()
    assert all(format_cell(value) in page for value in knee if isinstance(value, float))

    (tmp_path / "job.toml").write_text(text, encoding="utf-8")
    options = ("--designs", 6, "--seed", 3, "--runs", tmp_path, "--no-figures")
    assert without_changing_parts(found) == without_changing_parts(command("optimise", tmp_path / "job.toml", *options))
    assert found["numbers"] == [1, 2, 3, 4, 5, 6]


def test_tables_and_text_of_a_job_give_the_same_front(agent: Agent, run: str) -> None:
    found = agent.ask("optimise", job=tomllib.loads(fronts.JOB))
    assert found["designs"] == agent.ask("front", run=run)["designs"]


def test_a_front_its_part_and_its_picks_are_those_of_the_command(agent: Agent, run: str) -> None:
    of_run = (agent.runs / run, "--runs", agent.runs)
    whole = agent.ask("front", run=run, rows=0, columns=["all"])
    assert without_changing_parts(whole) == without_changing_parts(command("front", *of_run))
    inches = agent.ask("front", run=run, rows=0, columns=["all"], units="inch")
    assert without_changing_parts(inches) == without_changing_parts(command("front", *of_run, "--units", "inch"))
    where = ["transmission_angle >= 41 deg"]
    part = agent.ask("front", run=run, where=where, sort="time_ratio", columns=["crank", "time_ratio"])
    options = ("--where", where[0], "--sort", "time_ratio", "--columns", "crank,time_ratio")
    assert without_changing_parts(part) == without_changing_parts(command("front", *of_run, *options))
    assert [whole["designs"][number - 1]["time_ratio"] for number in part["numbers"]] == [
        row["time_ratio"] for row in part["designs"]
    ]
    for inputs in ({"knee": True}, {"design": 2}, {"topsis": "time_ratio=2, transmission_angle=1"}):
        ((name, value),) = inputs.items()
        picked = agent.ask("front", run=run, **inputs)
        expected = command("front", *of_run, f"--{name}", *([] if value is True else [value]))
        assert picked["designs"] == expected["designs"]
        assert picked["numbers"] == [expected["number"]]
        assert picked["trade_offs"]


def test_a_design_of_a_job_whose_other_numbers_vary_is_analysed(agent: Agent, pytestconfig: pytest.Config) -> None:
    lengths = {"crank": "26.8 mm", "rod": "108.8 mm", "offset": "47 mm"}
    words = [word for name, length in lengths.items() for word in (f"--{name}", length)]
    expected = command("analyse", pytestconfig.rootpath / "runs/press.toml", *words, "--show", "friction")
    assert agent.ask("ask", job="press", **lengths, topics=["friction"]) == expected


def test_a_design_is_analysed_as_by_the_command(agent: Agent, run: str, tmp_path: Path) -> None:
    topics, inputs = ["static_forces", "press"], {"touch_distance": "12 mm", "rated_torque": "60 N m"}
    options = ("--show", ",".join(topics), "--touch-distance", "12 mm", "--rated-torque", "60 N m")
    for units in ("metric", "inch"):
        asked = agent.ask("ask", run=run, design=2, topics=topics, inputs=inputs, units=units)
        assert asked == command("analyse", agent.runs / run, "--design", 2, *options, "--units", units)
    knee = agent.ask("front", run=run, knee=True)["numbers"][0]
    assert agent.ask("ask", run=run) == command("analyse", agent.runs / run, "--design", knee)
    (tmp_path / "job.toml").write_text(fronts.JOB, encoding="utf-8")
    lengths = {"crank": "100 mm", "rod": "400 mm", "offset": "30 mm"}
    words = [word for name, length in lengths.items() for word in (f"--{name}", length)]
    assert agent.ask("ask", job=fronts.JOB, **lengths) == command("analyse", tmp_path / "job.toml", *words)
    everything = agent.answer("ask", run=run, topics=["all"])
    assert set(everything.structured_content) & set(TOPICS) == set(TOPICS) - left_out(text_of(everything))


def left_out(text: str) -> set[str]:
    """Return the topics that a text says a design does not have."""
    return {name for name in TOPICS if f"\n{name}: " in text}


def test_a_swing_is_analysed_as_by_its_command(agent: Agent, pytestconfig: pytest.Config) -> None:
    lengths = {"crank": "1360 mm", "rod": "2426.8 mm", "offset": "-600 mm"}
    words = [word for name, length in lengths.items() for word in (f"--{name}", length)]
    asked = agent.ask("ask", job="support", **lengths, units="inch")
    assert asked == command("swing", pytestconfig.rootpath / "runs/support.toml", *words, "--units", "inch")
    sentence = agent.refused("ask", job="support", **lengths, topics=["motor"])
    assert sentence.startswith("the topic motor needs a rotating crank")


def test_a_question_with_a_command_of_its_own_is_asked_as_by_that(agent: Agent, run: str) -> None:
    inputs = {"slider_position": "430 mm", "slider_velocity": "1 m/s"}
    words = [word for name, text in inputs.items() for word in (f"--{name.replace('_', '-')}", text)]
    asked = agent.ask("ask", run=run, design=2, topics=["inverse"], inputs=inputs)
    assert asked == command("inverse", agent.runs / run, "--design", 2, *words)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("topic", "name", "inputs"),
    [
        ("allocate", "allocate", {"limit": "0.3 mm", "kind": "RSS"}),
        ("counterweight", "balance", {"rod_radius": "60 mm", "rod_mass": "2 kg"}),
        ("sections", "sections", {}),
    ],
)
def test_a_design_is_sized_as_by_the_command(
    agent: Agent, tmp_path: Path, topic: str, name: str, inputs: dict[str, str]
) -> None:
    (tmp_path / "job.json").write_text(json.dumps(sized.TABLES), encoding="utf-8")
    lengths = {"crank": "60 mm", "rod": "230 mm", "offset": "70 mm"}
    words = [word for key, text in (lengths | inputs).items() for word in (f"--{key.replace('_', '-')}", text)]
    asked = agent.ask("ask", job=sized.TABLES, **lengths, topics=[topic], inputs=inputs)
    assert asked == command(name, tmp_path / "job.json", *words)


def test_a_job_is_checked_as_by_the_command(agent: Agent, pytestconfig: pytest.Config) -> None:
    found = agent.ask("check", job="feeder")
    expected = command("check", pytestconfig.rootpath / "runs/feeder.toml")
    assert found == expected | {"valid": True, "wrong": [], "said": [], "unchecked": found["unchecked"]}
    wrong = agent.ask("check", job=fronts.JOB.replace('"2 kg"', '"2 mm"'))
    assert (wrong["valid"], [one["path"] for one in wrong["wrong"]]) == (False, ["mechanism.slider.mass"])
    infeasible = agent.ask("check", job=IMPOSSIBLE)
    assert not infeasible["valid"]
    assert [(one["path"], one["infeasible"]) for one in infeasible["wrong"]] == [("constraints.time_ratio", True)]
    assert "lower constraints.transmission_angle to 27.4576 deg at most" in infeasible["wrong"][0]["sentence"]


def test_what_a_job_names_is_given_and_no_file_is_read(agent: Agent) -> None:
    job = tomllib.loads(fronts.JOB) | {"load": [{"file": "trace.csv"}]}
    table = "slider_position_mm,force_N\n0,100\n900,200\n"
    assert agent.ask("check", job=job, files={"trace.csv": table})["valid"]
    (agent.folder / "trace.csv").write_text(table)
    for name in ("trace.csv", str(agent.folder / "trace.csv"), "../trace.csv", "/etc/passwd"):
        job["load"] = [{"file": name}]
        for tool in ("check", "optimise"):
            sentence = agent.refused(tool, job=job)
            assert "root:" not in sentence
            assert name in sentence


@pytest.mark.slow
def test_a_cancelled_search_ends_soon_and_goes_on_to_the_same_front(agent: Agent, tmp_path: Path) -> None:
    call = agent.begin("optimise", job=LONG)
    deadline = time.monotonic() + 30.0
    while len(agent.progress) < 3 and time.monotonic() < deadline:
        time.sleep(0.01)
    here = psutil.Process()
    call.cancel()
    cancelled = Stopwatch(here.pid, *(child.pid for child in here.children(recursive=True)))
    while (latest := agent.ask("list")["runs"][0])["status"] != "cancelled":
        assert cancelled.seconds() < 2.0, latest
    found = agent.ask("optimise", resume=latest["run"], columns=["all"])
    (tmp_path / "job.toml").write_text(LONG, encoding="utf-8")
    expected = command("optimise", tmp_path / "job.toml", "--runs", tmp_path, "--no-figures")
    assert without_changing_parts(found) == without_changing_parts(expected)
    assert "only an interrupted or cancelled run can continue; " in agent.refused("optimise", resume=latest["run"])


@pytest.mark.slow
def test_a_search_that_its_limit_cuts_off_says_so_and_goes_on(agent: Agent) -> None:
    found = agent.answer("optimise", job=LONG, seconds=0.05)
    assert found.is_error
    sentence = text_of(found)
    assert "its search reached its time limit of 0.05 s" in sentence
    (run,) = re.findall(r"continue it with optimise, resume = (\S+)", sentence)
    assert agent.ask("optimise", resume=run)["status"] == "done"


def test_what_no_design_can_meet_is_an_error_with_the_nearest_relaxation(agent: Agent) -> None:
    found = agent.answer("optimise", job=IMPOSSIBLE)
    assert found.is_error
    assert found.structured_content["status"] == "infeasible"
    assert found.structured_content["message"] in text_of(found)
    assert "it is at most 1.2862; got min 1.5; lower it to that, or lower " in text_of(found)


def test_functions_that_are_allowed_may_print_and_others_are_not_called(agent: Agent) -> None:
    job = fronts.JOB.replace('time_ratio = "maximise"', 'mine = "minimise"') + OWN_TABLES
    loud = job.replace("FUNCTION", "own_loud:loud")
    assert agent.ask("optimise", job=loud, designs=2)["status"] == "done"
    for tool in ("check", "optimise", "ask"):
        inputs = {"crank": "100 mm", "rod": "400 mm", "offset": "30 mm"} if tool == "ask" else {}
        found = agent.answer(tool, job=job.replace("FUNCTION", "os:getcwd"), **inputs)
        assert "only functions that the operator allows may run here; got os:getcwd" in text_of(found).replace('"', "")
    (agent.folder / "job.toml").write_text(job.replace("FUNCTION", "own_loud:loud").replace("own_loud", "own_other"))
    shutil.copy(agent.folder / "own_loud.py", agent.folder / "own_other.py")
    command("optimise", agent.folder / "job.toml", "--runs", agent.runs, "--designs", 2, "--no-figures")
    latest = agent.ask("list")["runs"][0]["run"]
    assert "own_other:loud" in agent.refused("ask", run=latest)
    assert "own_other:loud" in agent.refused("files", run=latest, write=["svg"])


@pytest.mark.parametrize(
    ("tool", "inputs", "sentence"),
    [
        ("lists", {}, "there is no tool 'lists'; choose from list, describe"),
        ("list", {"what": "jobs"}, 'list has no inputs; got "what"; leave it out'),
        ("describe", {}, "describe needs name, which is missing; add it"),
        ("describe", {"name": "peak_torqe"}, "got 'peak_torqe'; did you mean peak_torque?"),
        ("describe", {"name": "mechanism.nothing"}, "call `list` for all names"),
        ("describe", {"name": 5}, "name must be text in quotes; got 5"),
        ("check", {"job": "feder"}, "got 'feder'; give one of them"),
        ("check", {"job": "name = "}, "line 1"),
        ("check", {"job": {"name": None}}, "name"),
        ("check", {"job": {"a": {"b": {"c": {"d": {"e": {"f": {"g": {"h": {"i": {"j": 1}}}}}}}}}}}, "at most 8 deep"),
        ("check", {"job": 5}, "job must be"),
        ("optimise", {}, "a search needs a job, or a run to continue; got neither"),
        ("optimise", {"job": "feeder", "resume": "latest"}, "got both"),
        ("optimise", {"resume": "latest", "seed": 2}, "leave them out"),
        ("optimise", {"resume": "nothing"}, "there is no run 'nothing'"),
        ("optimise", {"job": "feeder", "designs": 0}, "designs must be at least 1; got 0"),
        ("optimise", {"job": "feeder", "seconds": -1.0}, "seconds must be above 0"),
        ("optimise", {"job": {"name": "x"}}, "mechanism: is missing"),
        ("front", {"run": "latest", "design": 99}, "the run has designs 1 to "),
        ("front", {"run": "latest", "where": ["nothing > 1"]}, "nothing"),
        ("front", {"run": "latest", "where": ["time_ratio > 99"]}, "none of the "),
        ("front", {"run": "latest", "columns": ["nothing"]}, "there is no quantity or column 'nothing'"),
        ("front", {"run": "latest", "knee": True, "design": 1}, "a design must be chosen in one way"),
        ("front", {"run": "latest", "units": "feet"}, "units must be "),
        ("front", {"run": "\0"}, "a run is a folder in "),
        ("front", {"run": "x" * 5000}, "a run is a folder in "),
        ("ask", {}, "a design must come from a run or a job; got neither"),
        ("ask", {"run": "latest", "crank": "20 mm"}, "leave out one of the two"),
        ("ask", {"run": "latest", "topics": ["pres"]}, "did you mean press?"),
        ("ask", {"run": "latest", "inputs": {"rated_torque": "5 N m"}}, "rated_torque is an input of the topic press"),
        ("ask", {"run": "latest", "inputs": {"nothing": "5 N m"}}, "got 'nothing'; leave it out"),
        ("ask", {"run": "latest", "topics": ["inverse"]}, "inverse needs slider_position; got none"),
        ("ask", {"run": "latest", "topics": ["inverse", "press"]}, "inverse may not be combined with other topics"),
        ("ask", {"run": "latest", "topics": ["press"], "inputs": {"rated_torque": "5 mm"}}, "rated_torque must be"),
        ("ask", {"job": "feeder", "crank": "20 mm"}, 'rod is needed; write it like rod "40 mm"'),
        ("ask", {"job": "feeder", "crank": "9 kg", "rod": "1 m", "offset": "0 m"}, "crank must be a length"),
        ("ask", {"job": "support", "topics": ["motor"], **SWUNG}, "use swing to analyse its designs"),
        ("ask", {"job": "feeder", "topics": ["pres"]}, "topics must name a topic"),
        ("front", {"run": "latest", "knee": True, "topsis": "stroke=1"}, "got knee and topsis; keep one"),
        ("front", {"run": "latest", "topsis": "stroke, b"}, "a design must be chosen by the objectives of its run"),
        ("front", {"run": "latest", "where": ["time_ratio"]}, 'write it like "transmission_angle >= 40 deg"'),
        (
            "files",
            {"run": "latest", "write": ["csv", "figures"], "design": 2},
            "csv, figures cover all designs of a run",
        ),
        ("files", {"run": "latest", "write": ["exe"]}, "write.0 must be 'csv'"),
        ("files", {"run": "latest", "write": []}, "write must have at least 1 entries"),
        ("files", {"run": "latest", "write": ["svg"], "design": 99}, "the run has designs 1 to "),
    ],
)
def test_wrong_input_is_one_sentence_and_the_server_lives_on(
    agent: Agent, run: str, tool: str, inputs: dict[str, Any], sentence: str
) -> None:
    found = agent.answer(tool, **inputs)
    assert sentence in text_of(found)
    assert not re.search(r"--[a-z]|`slidercrank", text_of(found)), "an agent has inputs, no command line"
    assert found.is_error or tool == "check"
    assert agent.ask("describe", name="stroke")["quantity"]["unit"] == "mm"


@pytest.mark.parametrize("tool", ["front", "ask", "files", "optimise"])
def test_nothing_outside_the_place_of_runs_is_read_or_written(agent: Agent, run: str, tool: str) -> None:
    outside = shutil.copytree(agent.runs / run, agent.folder / f"outside-{tool}")
    (agent.runs / f"link-{tool}").symlink_to(outside)
    inner = shutil.copytree(agent.runs / run, agent.runs / f"inner-{tool}")
    (inner / "design-1.svg").symlink_to(outside / "stolen.svg")
    (agent.folder / "near").mkdir(exist_ok=True)
    names = [str(outside), f"../{outside.name}", f"link-{tool}", inner.name, "../near", "near", "/", "..", "/etc"]
    more: dict[str, Any] = {"write": ["svg"], "design": 1} if tool == "files" else {}
    try:
        for name in names:
            inputs = {"resume": name} if tool == "optimise" else {"run": name, **more}
            assert re.match("a run is a folder in |there is no run ", agent.refused(tool, **inputs)), name
    finally:
        (agent.runs / f"link-{tool}").unlink()
        shutil.rmtree(inner)
    assert not (outside / "stolen.svg").exists()
    assert not (agent.folder / "elsewhere.db").exists()


def test_files_are_those_of_the_commands_and_lie_in_the_run(agent: Agent, run: str, tmp_path: Path) -> None:
    kinds = ["csv", "json", "dxf", "svg", "motion", "cycle"]
    files = agent.ask("files", run=run, write=kinds, design=2)["files"]
    of_run = (str(agent.runs / run), "--runs", str(agent.runs))
    options = [word for kind in kinds for word in (f"--{kind}", str(tmp_path / f"{kind}{Path(files[kind][0]).suffix}"))]
    done = CliRunner().invoke(app, ["export", *of_run, "--design", "2", *options])
    assert done.exit_code == 0, done.stderr
    for kind in kinds:
        (file,) = map(Path, files[kind])
        assert file.parent == agent.runs / run
        assert file.read_bytes() == (tmp_path / f"{kind}{file.suffix}").read_bytes() or kind == "dxf"  # with the time
    inches = agent.ask("files", run=run, write=["csv"], units="inch")["files"]["csv"]
    assert "crank_in" in Path(inches[0]).read_text(encoding="utf-8")
    assert "crank_mm" in Path(files["csv"][0]).read_text(encoding="utf-8")


def test_every_name_of_the_lists_is_described(agent: Agent) -> None:
    known = agent.ask("list")
    assert {facts["name"] for facts in known["quantities"]} >= set(QUANTITIES)
    assert [topic["name"] for topic in known["topics"]] == list(QUESTIONS)
    for part in ("jobs", "topics", "quantities"):
        for one in known[part]:
            assert part.rstrip("s").replace("quantitie", "quantity") in agent.ask("describe", name=one["name"])
    keys = agent.ask("describe", name="mechanism.slider")["key"]["tables"][0]
    assert keys["required"] == ["mass"]
    assert keys["keys"]["mass"]["examples"]
    assert len(agent.ask("describe", name="load")["key"]["tables"]) > 10
    bounds = text_of(agent.answer("describe", name="constraints"))
    for of in QUANTITIES.values():
        assert f"  {of.name}: {of.title}; such as {of.name} = {{ {'max' if of.better == 'low' else 'min'} = " in bounds
    for name, question in DESIGN_QUESTIONS.items():
        assert agent.ask("describe", name=name)["topic"]["answer"] == schema_of(question.record_type)
    assert "one of minimise, maximise" in text_of(agent.answer("describe", name="objectives.peak_torque"))


def test_schemas_follow_from_what_is_declared(agent: Agent) -> None:
    found = {tool.name: tool for tool in agent.portal.call(agent.client.list_tools).tools}
    assert list(found) == [tool.name for tool in TOOLS]
    asked = found["ask"].input_schema["properties"]
    for topic in QUESTIONS.values():
        for one in topic.inputs:
            assert f"{topic.name}: {one.remark}" in asked["inputs"]["properties"][one.name]["description"]
    assert set(INPUTS) <= set(asked["inputs"]["properties"])
    assert asked["inputs"]["properties"]["driver"]["enum"] == ["crank", "slider"]
    assert all(f"{name} ({topic.shows})" in asked["topics"]["description"] for name, topic in TOPICS.items())
    assert all("description" in one for tool in found.values() for one in tool.input_schema["properties"].values())


def test_the_page_names_every_tool_and_how_many_designs_an_answer_has(pytestconfig: pytest.Config) -> None:
    page = (pytestconfig.rootpath / "docs/agents.md").read_text(encoding="utf-8")
    assert re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE) == [tool.name for tool in TOOLS]
    assert f"return {ROWS} designs" in page


def test_only_the_protocol_is_on_standard_output(agent: Agent) -> None:
    agent.ask("list")  # at least this, after whatever else the server has done
    whole, _, _ = agent.written.read_text(encoding="utf-8").rpartition("\n")  # the last line may be under way
    assert whole
    for line in whole.splitlines():
        assert json.loads(line)["jsonrpc"] == "2.0"


@pytest.mark.slow
@pytest.mark.parametrize("code", [0, 130], ids=["its client leaves", "Ctrl-C"])
def test_a_server_that_ends_leaves_a_run_that_can_go_on(tmp_path: Path, code: int) -> None:
    server = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, "mcp", "--runs", str(tmp_path / "runs")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert server.stdin is not None
    assert server.stdout is not None
    hello = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "t", "version": "1"}}
    call = {"name": "optimise", "arguments": {"job": LONG}, "_meta": {"progressToken": 1}}
    for message in (
        {"id": 1, "method": "initialize", "params": hello},
        {"method": "notifications/initialized"},
        {"id": 2, "method": "tools/call", "params": call},
    ):
        server.stdin.write(json.dumps({"jsonrpc": "2.0", **message}) + "\n")
        server.stdin.flush()
    heard = [json.loads(server.stdout.readline()) for _ in range(4)]
    assert [one.get("method") for one in heard[1:]] == ["notifications/progress"] * 3
    if code:
        server.send_signal(signal.SIGINT)
    else:
        server.stdin.close()
    assert server.wait(timeout=60.0) == code  # about a second on a machine at rest
    server.stdin.close()
    server.stdout.close()
    done = CliRunner().invoke(app, ["optimise", "--resume", "latest", "--runs", str(tmp_path / "runs"), "--json"])
    assert done.exit_code == 0, done.stderr


def test_a_fault_of_the_server_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    from slidercrank.service.agents import server

    def broken(error: Exception) -> Callable[..., ToolResult]:
        def run(_call: object) -> ToolResult:
            raise error

        return run

    for error, sentence in (
        (KeyError("x"), "unexpected KeyError: 'x'; this is a bug in slidercrank"),
        (MemoryError(), "not enough memory"),
        (OSError(28, "No space left on device"), "free some space"),
        (InputError("a rule; got it; mend it"), "a rule; got it; mend it"),
    ):
        monkeypatch.setitem(server._BY_NAME, "list", Tool("list", broken(error)))
        answer = server._run_tool("list", {}, None)  # type: ignore[arg-type]
        assert answer.is_error
        assert sentence in answer.text
