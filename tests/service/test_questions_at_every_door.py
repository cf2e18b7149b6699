"""Questions to one design: the same answers and errors in Python, commands, the API and its client."""

from __future__ import annotations

import json
from collections.abc import Iterator
from importlib import metadata
from inspect import cleandoc
from pathlib import Path
from typing import Any, get_args

import httpx
import numpy as np
import pytest
from typer.testing import CliRunner

import slidercrank as sc
from slidercrank.model.errors import InputError, InputWarning, NotFound
from slidercrank.optimise.problem import question_registry as announced
from slidercrank.service.agents.call import Call
from slidercrank.service.agents.questions import ask
from slidercrank.service.agents.tool import Tool
from slidercrank.service.cli import app as command_line
from slidercrank.service.client import Client
from slidercrank.service.jobs.submission import submit
from slidercrank.service.questions.discovery import DESIGN_QUESTIONS, QUESTION_COMMANDS, TOPICS
from slidercrank.service.questions.inputs import Input
from slidercrank.service.runs.result import json_ready
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.case_count import ALL_CASES, case_count
from tests.doors.scripts import JOBS
from tests.service import fronts, sized
from tests.service.alike import assert_same
from tests.service.api.fixed_front import API, Solved, served
from tests.service.machines import some_design, some_tables

MACHINES = ("loose", "cylinders", "engine")
"""Between them they have every topic but the press, whose distance is given."""
TOUCH, RATED = 0.0125, 55.5
SIZING = tuple(name for name, command in QUESTION_COMMANDS.items() if command.sizes)
SIZES = {"limit": (0.25, 0.5), "radius": (40, 120), "mass": (1, 6), "rod_radius": (30, 80), "rod_mass": (1, 3)}
SIZES |= {"greatest_speed": (390, 480), "crank_acceleration": (1e4, 1e5)}
"""From and to, metric, of what sizing is asked with; moments count on arms of 100 to 500 mm."""
LAW = ("greatest_speed", "crank_acceleration")
"""What a motion law is asked with: other limits exclude each other when drawn at random."""


@pytest.fixture(scope="module")
def address(solved: Solved) -> Iterator[str]:
    with served(solved.store) as address:
        yield address


@pytest.fixture(scope="module")
def client(address: str) -> Iterator[Client]:
    with Client(address) as client:
        yield client


def by_agent(place: Path, **inputs: Any) -> dict[str, Any]:
    """Return the answer of the tool `ask` as agents receive it."""
    call = Call(place, frozenset(), lambda: False, lambda _: None)
    found: dict[str, Any] = json_ready(Tool("ask", ask).execute(call, inputs).record)
    return found


def result_or_refusal(
    problem: sc.Problem, question: str, design: list[float], given: dict[str, Any]
) -> dict[str, Any] | str:
    """Return an answer, or the sentence of its refusal."""
    try:
        return problem.ask(question, design, **given)
    except InputError as error:
        return str(error)


@pytest.mark.slow
def test_every_topic_of_random_machines_has_the_same_answer_at_every_door(address: str, tmp_path: Path) -> None:
    random, answered = np.random.default_rng(5), set[str]()
    for sort in MACHINES:
        tables = some_tables(sort, random)
        file = tmp_path / "job.json"
        file.write_text(json.dumps(tables), encoding="utf-8")
        problem = sc.load_job(file, require_feasible=False)
        design = some_design(problem, random)
        sizes = {name: f"{1e3 * length!r} mm" for name, length in zip(("crank", "rod", "offset"), design, strict=True)}
        options = [word for name, text in sizes.items() for word in (f"--{name}", text)]
        options += ["--touch-distance", f"{TOUCH!r} m", "--rated-torque", f"{RATED!r} N m", "--show", "all", "--json"]
        done = CliRunner().invoke(command_line, ["analyse", str(file), *options])
        assert done.exit_code == 0, done.stderr
        printed = json.loads(done.stdout)
        press = {"touch_distance": f"{TOUCH!r} m", "rated_torque": f"{RATED!r} N m"}
        agent = by_agent(tmp_path, job=tables, **sizes, topics=["all"], inputs=press)
        assert list(agent) == list(printed)
        assert agent == printed
        sent = httpx.post(f"{address}{API}/analyse", json={"job": tables, **sizes, "show": ["all"]}, timeout=60.0)
        for name in TOPICS:
            given = {"touch_distance": TOUCH, "rated_torque": f"{RATED!r} N m"} if name == "press" else {}
            answer = result_or_refusal(problem, name, design, given)
            if isinstance(answer, str):
                assert f"{name}: {answer}" in done.stderr.splitlines()
            else:
                answered.add(name)
                assert list(answer) == list(printed[name])
                assert answer == printed[name]
            if not given:
                assert f"{name}: {answer}" in sent.json()["notes"] or answer == sent.json()["analysis"][name]
        if sort == MACHINES[0] or ALL_CASES:
            inches = CliRunner().invoke(command_line, ["analyse", str(file), *options, "--units", "inch"])
            assert by_agent(tmp_path, job=tables, **sizes, topics=["all"], inputs=press, units="inch") == json.loads(
                inches.stdout
            )
    assert answered == TOPICS.keys() - {"clearance"}


def test_designs_of_a_front_have_the_same_answers_in_python_and_by_the_client(solved: Solved, client: Client) -> None:
    front = sc.solve(sc.load_job(solved.job))
    random = np.random.default_rng(2)
    for row in random.choice(len(front), 3, replace=False).tolist():
        angle = float(random.integers(-3200, 3200) / 8.0)
        torque = float(random.integers(8, 800) / 8.0)
        assert_same(
            front.ask("polygons", row, crank_angle=f"{angle} deg"),
            client.ask(solved.number, row + 1, "polygons", crank_angle_deg=angle),
        )
        given = {"touch_distance_mm": 12.0, "rated_torque_Nm": torque}
        expected = client.ask(solved.number, row + 1, "press", **given)
        assert_same(front.ask("press", row, touch_distance="12 mm", rated_torque=torque), expected)
        assert_same(front.ask("press", row, touch_distance=0.012, rated_torque=torque, dwell_distance=None), expected)
        part = front.part(row)
        assert_same(part.ask("press", front.dimensions[row], touch_distance=0.012, rated_torque=torque), expected)


def test_random_motions_have_the_same_crank_angles_at_every_door(solved: Solved, client: Client) -> None:
    front, random = sc.solve(sc.load_job(solved.job)), np.random.default_rng(8)
    for row in random.choice(len(front), 4, replace=False).tolist():
        inner, outer = sc.Linkage(*front.dimensions[row][:3]).dead_centres
        position = round(8e3 * float(inner + random.uniform(0.1, 0.9) * (outer - inner))) / 8.0
        velocity, acceleration = random.uniform(-3.0, 3.0), random.uniform(-50.0, 50.0)
        motion = {"slider_position_mm": position, "slider_velocity_m_s": velocity}
        given = {**motion, "slider_acceleration_m_s2": acceleration}
        expected = client.ask(solved.number, row + 1, "inverse", **given)
        rates = {"slider_velocity": velocity, "slider_acceleration": f"{acceleration!r} m/s^2"}
        assert_same(front.ask("inverse", row, slider_position=f"{position!r} mm", **rates), expected)
        options = [f"--slider-position={position!r} mm", f"--slider-velocity={velocity!r} m/s"]
        printed = printed_by("inverse", solved, row, *options, f"--slider-acceleration={acceleration!r} m/s^2")
        assert_same(printed, expected)
        texts = {"slider_velocity": f"{velocity!r} m/s", "slider_acceleration": f"{acceleration!r} m/s^2"}
        inputs = {"slider_position": f"{position!r} mm", **texts}
        place = {"run": solved.folder.name, "design": row + 1}
        assert by_agent(solved.folder.parent, **place, topics=["inverse"], inputs=inputs) == printed
        rates_in_api = {"velocity_m_s": velocity, "acceleration_m_s2": acceleration}
        assert client.inverse(solved.number, row + 1, position_mm=position, **rates_in_api) == expected


def test_random_swings_have_the_same_numbers_at_every_door(solved: Solved, client: Client) -> None:
    front, random = sc.solve(sc.load_job(solved.job)), np.random.default_rng(9)
    for row in random.choice(len(front), 4, replace=False).tolist():
        start, end = (float(angle) for angle in random.integers(8, 600, 2) / 8.0)
        law, duration = str(random.choice(["harmonic", "cycloidal", "trapezoid"])), float(random.integers(1, 9))
        given: dict[str, Any] = {"start_deg": start, "end_deg": end, "law": law, "duration_s": duration}
        expected = client.ask(solved.number, row + 1, "swing", **given)
        inputs = {"start": f"{start!r} deg", "end": float(np.radians(end)), "law": law, "duration": duration}
        assert_same(front.ask("swing", row, **inputs), expected)
        options = [f"--from={start!r} deg", f"--to={end!r} deg", "--law", law, f"--duration={duration!r} s"]
        printed = printed_by("swing", solved, row, *options)
        assert_same(printed, expected)
        texts = {"start": f"{start!r} deg", "end": f"{end!r} deg", "law": law, "duration": f"{duration!r} s"}
        place = {"run": solved.folder.name, "design": row + 1}
        assert by_agent(solved.folder.parent, **place, topics=["swing"], inputs=texts) == printed
        assert client.swing(solved.number, row + 1, **given) == expected


@pytest.fixture(scope="module")
def sizes(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Client, int, Path]]:
    """Yield a client of a front that can be sized, the number of its job, and its file."""
    place = tmp_path_factory.mktemp("sized")
    file = place / "job.json"
    file.write_text(json.dumps(sized.TABLES), encoding="utf-8")
    with Store(place / "store.db") as store:
        number = submit(store, sized.TABLES).id
        work(store, drain=True)
        with served(store) as address, Client(address) as client:
            yield client, number, file


def some_input(one: Input, random: np.random.Generator) -> float | str:
    if one.words is not None:
        return str(random.choice(get_args(one.words)))
    return round(float(random.uniform(*SIZES.get(one.name, (100, 500)))), 3)


@pytest.mark.slow
@pytest.mark.parametrize("name", SIZING)
def test_random_designs_are_sized_alike_at_every_door(sizes: tuple[Client, int, Path], name: str) -> None:
    (client, number, job), random = sizes, np.random.default_rng(10)
    front, question = sc.solve(sc.load_job(job)), DESIGN_QUESTIONS[name]
    for row in random.choice(len(front), case_count(1, 3), replace=False).tolist():
        given = {one: some_input(one, random) for one in question.inputs if name != "law" or one.name in LAW}
        expected = client.ask(number, row + 1, name, **{one.key: value for one, value in given.items()})
        texts = {one: one.with_unit(value) for one, value in given.items()}
        assert front.ask(name, row, **{one.name: text for one, text in texts.items()}) == expected
        lengths = zip(("crank", "rod", "offset"), front.dimensions[row].tolist(), strict=True)
        options = [f"--{of}={length!r} m" for of, length in lengths]
        options += [f"{one.flag}={text}" for one, text in texts.items()]
        done = CliRunner().invoke(command_line, [QUESTION_COMMANDS[name].called or name, str(job), *options, "--json"])
        assert done.exit_code == 0, done.stderr
        assert json.loads(done.stdout) == expected
        words = {one.name: text for one, text in texts.items()}
        size = {
            of: f"{length!r} m"
            for of, length in zip(("crank", "rod", "offset"), front.dimensions[row].tolist(), strict=True)
        }
        assert by_agent(job.parent, job=sized.TABLES, **size, topics=[name], inputs=words) == expected


@pytest.mark.parametrize(
    ("name", "given", "sentence"),
    [
        (
            "allocate",
            ("limit", 0.3),
            "allocation needs the costs of the tolerances; this job has no [costs]; for example, add",
        ),
        (
            "sections",
            None,
            "sizing sections needs the table [sections]; this job has none; add it with a material and pins",
        ),
        ("counterweight", ("arm", 200.0), "moment"),
    ],
)
def test_what_cannot_be_sized_is_refused_in_one_sentence(
    solved: Solved, client: Client, name: str, given: tuple[str, float] | None, sentence: str
) -> None:
    key, value = given or ("", 0.0)
    row = client.analysis(solved.number, 1)
    words = [f"--{of}={row[f'{of}_mm']!r} mm" for of in ("crank", "rod", "offset")]
    with pytest.raises(InputError) as refused:
        client.ask(solved.number, 1, name, **({f"{key}_mm": value} if given else {}))
    with pytest.raises(InputError) as alone:
        sc.solve(sc.load_job(solved.job)).ask(name, 0, **({key: f"{value} mm"} if given else {}))
    done = CliRunner().invoke(
        command_line,
        [QUESTION_COMMANDS[name].called or name, str(solved.job), *words, *([f"--{key}={value} mm"] if given else [])],
    )
    assert sentence in str(alone.value)
    assert str(alone.value) in str(refused.value)
    assert (done.exit_code, done.stderr.strip()) == (2, f"slidercrank: {alone.value}")


@pytest.mark.parametrize("name", SIZING)
def test_a_job_that_swings_is_sized_at_no_door(name: str) -> None:
    command = QUESTION_COMMANDS[name].called or name
    given = {"limit": "1 mm"} if name == "allocate" else {}
    with pytest.raises(InputError) as refused:
        sc.load_job("runs/support.toml").ask(name, [1.4, 1.8, -0.05], **given)
    words = ["--crank", "1.4 m", "--rod", "1.8 m", "--offset", "-50 mm", *(["--limit", "1 mm"] if given else [])]
    done = CliRunner().invoke(command_line, [command, "runs/support.toml", *words])
    assert str(refused.value).startswith(f"{command} needs a rotating crank; the crank of this job swings")
    assert (done.exit_code, done.stderr.splitlines()[-1]) == (2, f"slidercrank: {refused.value}")


def printed_by(name: str, solved: Solved, row: int, *options: str) -> Any:
    place = ["latest", "--runs", str(solved.folder.parent), "--design", str(row + 1), "--json"]
    done = CliRunner().invoke(command_line, [name, *place, *options])
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


def test_a_swing_of_a_job_is_asked_in_python_as_on_the_command_line() -> None:
    design, words = [1.4, 1.8, -0.05], ["--crank", "1.4 m", "--rod", "1.8 m", "--offset", "-50 mm", "--json"]
    support = sc.load_job("runs/support.toml")
    for name, options, inputs in (
        ("swing", ["--to", "60 deg", "--actuator-tolerance", "0 mm"], {"end": "60 deg", "actuator_tolerance": 0.0}),
        ("inverse", ["--slider-position", "2.9 m"], {"slider_position": 2.9}),
    ):
        done = CliRunner().invoke(command_line, [name, "runs/support.toml", *words, *options])
        assert support.ask(name, design, **inputs) == json.loads(done.stdout)


@pytest.mark.parametrize("name", QUESTION_COMMANDS)
def test_an_endpoint_says_what_its_command_says_and_takes_its_inputs(address: str, name: str) -> None:
    described = httpx.get(f"{address}{API}/openapi.json", timeout=60.0).json()
    asked = described["paths"][f"/api/v1/jobs/{{number}}/designs/{{design}}/{name}"]["get"]
    assert (asked["operationId"], asked["description"]) == (
        QUESTION_COMMANDS[name].endpoint,
        cleandoc(QUESTION_COMMANDS[name].help),
    )
    keys = [parameter["name"] for parameter in asked["parameters"]]
    other = ("crank_mm", "rod_mm", "offset_mm", "value", "allow")  # than those of the design
    assert [key for key in keys if key not in ("number", "design", "units", *other)] == [
        one.key for one in DESIGN_QUESTIONS[name].inputs
    ]
    assert set(other) <= set(keys)


WRONG: list[tuple[str, dict[str, object], str]] = [
    ("pres", {}, "there is no question 'pres'; did you mean press?"),
    (
        "weather",
        {},
        "there is no question 'weather'; choose from inverse, swing, ",
    ),
    ("press", {"touch": 1.0}, "press may only be given touch_distance, dwell_distance, rated_torque; got touch; leave"),
    ("motor", {"limit": 1.0}, "the topic motor has no inputs; got limit; leave limit out"),
    ("press", {"touch_distance": "12 kg"}, 'touch_distance must be a length; got "12 kg", which is a mass; write it'),
    ("press", {"touch_distance": "12"}, 'touch_distance must be a length with its unit; got "12"; write it like'),
    ("press", {"touch_distance": 0.0}, "touch_distance must be positive; got 0"),
    ("press", {"touch_distance": [0.1]}, "touch_distance must be a length; got [0.1]"),
    ("press", {"touch_distance": float("nan")}, "touch_distance must be a finite number; got nan"),
    ("press", {"touch_distance": 3.0}, "distances before a dead centre must be less than the stroke, 280 mm; got 3000"),
    ("press", {}, "a touch distance is missing; give it as an input, or in the job"),
    ("inverse", {}, "inverse needs slider_position; got none; give it like 240 mm"),
    ("inverse", {"slider_position": None}, "inverse needs slider_position; got none"),
    ("inverse", {"slider_position": 9.0}, "the slider position must be within reach of the open branch"),
    ("inverse", {"slider_position": 0.3, "start": 0.1}, "inverse may only be given slider_position, slider_velocity, "),
    ("swing", {"start": 0.1}, "a swing must run from one crank angle to another; got no end; give both"),
    (
        "swing",
        {"start": 0.1, "slider_end": 0.2},
        "two slider positions; got start, slider_end; give only one",
    ),
    ("swing", {"start": 0.1, "end": 0.5, "driver": "motor"}, "driver must be 'crank' or 'slider'; got 'motor'"),
    ("swing", {"start": 0.1, "end": 0.5, "law": ["slow"]}, "law must be 'slow' or "),
    ("swing", {"start": 0.1, "end": 0.5, "actuator_tolerance": -1e-3}, "actuator_tolerance must be zero or more"),
    ("swing", {"start": "1 mm", "end": 0.5}, 'start must be an angle; got "1 mm"'),
    ("allocate", {}, "allocate needs limit; got none; give it like 0.1 mm"),
    ("allocate", {"limit": "0.3 mm", "kind": "mean"}, "kind must be 'worst case' or 'rss'; got 'mean'"),
    ("allocate", {"limit": "0.3 mm", "kind": 2}, "kind must be 'worst case' or 'rss'; got 2"),
    ("allocate", {"limit": 0.0}, "limit must be positive; got 0"),
    ("counterweight", {"rod_mass": 1.0}, "needs rod_radius and rod_mass; got only rod_mass; add rod_radius"),
    ("counterweight", {"rod_radius": 0.1}, "needs rod_radius and rod_mass; got only rod_radius; add rod_mass"),
    ("counterweight", {"mass": "2 mm"}, 'mass must be a mass; got "2 mm"'),
    ("sections", {"width": "2 mm"}, "sections has no inputs; got width; leave width out"),
    ("uneven_speed", {}, "an uneven speed needs a speed profile; the speed of this job is constant"),
]


@pytest.mark.parametrize(("question", "given", "sentence"), WRONG)
def test_what_no_design_is_asked_is_refused_in_a_sentence(
    solved: Solved, question: str, given: dict[str, object], sentence: str
) -> None:
    crank = float(sc.crank_from_stroke(0.28, rod=0.4, offset=0.06))
    with pytest.raises(InputError) as refused:
        sc.load_job(solved.job).ask(question, [crank, 0.4, 0.06], **given)
    assert sentence in str(refused.value)


def test_designs_without_an_answer_are_refused_as_elsewhere(solved: Solved) -> None:
    problem = sc.load_job(solved.job)
    with pytest.raises(sc.AssemblyError, match="rod must exceed crank"):
        problem.ask("balance", [0.2, 0.1, 0.06])
    with pytest.raises(InputError, match="designs need 3 numbers each"):
        problem.ask("balance", [0.2, 0.1])
    with pytest.raises(InputError, match="the topic balance needs a rotating crank; the crank of this job"):
        sc.load_job("runs/support.toml").ask("balance", [1.4, 1.8, -0.05])
    with pytest.raises(InputError, match="a design of a problem with choices"):
        sc.load_job(JOBS / "catalogue.toml").ask("balance", [0.04, 0.1, 0.02])
    for row in (99, -1, 1.0):
        with pytest.raises(InputError, match=f"a row must be one of the front's rows 0 to 2; got {row}"):
            fronts.front(designs=3).ask("balance", row)  # type: ignore[arg-type]


def test_a_number_that_probably_means_another_unit_is_warned_of() -> None:
    front = fronts.front(designs=3)
    rule = "^inputs of questions must be in SI: touch_distance = 12 is 12 m = 12000 mm; write 0.012 for 12 mm$"
    with pytest.warns(InputWarning, match=rule) as caught, pytest.raises(InputError, match="got 12"):
        front.ask("press", 1, touch_distance=12.0)
    assert caught[0].filename == __file__
    assert front.ask("press", 1, touch_distance=0.012) == front.ask("press", 1, touch_distance="12 mm")


def test_an_unknown_question_of_a_client_is_refused_by_the_service(solved: Solved, client: Client) -> None:
    with pytest.raises(NotFound, match="there is no topic 'pres'; choose from static_forces"):
        client.ask(solved.number, 1, "pres")
    with pytest.raises(InputError, match="touch_distance_mm"):
        client.ask(solved.number, 1, "press", touch_distance_mm="wide")
    with pytest.raises(InputError, match="touch"):
        client.ask(solved.number, 1, "press", touch=1.0)


def test_installed_packages_add_questions_by_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    class Reach:
        def answer(self, mechanism: Any, linkage: sc.Linkage, swing: Any, inputs: Any) -> dict[str, Any]:
            return {"reach_mm": 1e3 * float(linkage.crank + linkage.rod), **inputs}

    entries = [metadata.EntryPoint(name, f"{name}:QUESTIONS", announced.GROUP) for name in ("mine", "theirs")]
    offered: dict[str, dict[str, Any]] = {"mine": {"reach": Reach()}, "theirs": {}}
    monkeypatch.setattr(metadata, "entry_points", lambda group: entries if group == announced.GROUP else [])
    monkeypatch.setattr(metadata.EntryPoint, "load", lambda entry: offered[entry.name])
    announced.questions.cache_clear()
    problem = fronts.problem()
    try:
        assert problem.ask("reach", [0.1, 0.4, 0.0], share=1.0) == {"reach_mm": 500.0, "share": 1.0}
        with pytest.raises(InputError, match="there is no question 'balance'; choose from reach"):
            problem.ask("balance", [0.1, 0.4, 0.0])
        announced.questions.cache_clear()
        offered["theirs"] = {"reach": Reach()}
        with pytest.raises(InputError, match="the question reach must come from one installed package; got two"):
            problem.ask("reach", [0.1, 0.4, 0.0])
        announced.questions.cache_clear()
        offered.update(mine={}, theirs={})
        with pytest.raises(InputError, match="no installed package has one; reinstall slidercrank"):
            problem.ask("reach", [0.1, 0.4, 0.0])
    finally:
        announced.questions.cache_clear()
