"""Valid input that no design can meet is infeasible at every entry point, before and after a search."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest

import slidercrank as sc
from slidercrank.model.errors import InfeasibleError, InputError, JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import parse_job
from slidercrank.service.client import Client
from slidercrank.service.designs.judged_requirements import judged_rules_of_design
from slidercrank.service.questions.design_analysis import quantities_of_design
from slidercrank.service.runs.result import result_of
from slidercrank.service.runs.run_folder import RunFolder
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service import fronts
from tests.service.api.fixed_front import served
from tests.service.api.serving import client_of, refusal_sentence
from tests.service.conftest import Command
from tests.service.sized import NEEDED

SMALL = tomllib.loads(fronts.JOB)
SIZE = ("--crank", "140 mm", "--rod", "310 mm", "--offset", "60 mm")
WISH = {"constraints": {"time_ratio": {"min": 1.5}, "transmission_angle": {"min": "40 deg"}}}
"""The two requirements of the README that exclude each other."""
SAID = "with a least transmission angle of 40 deg"
OF_JOBS = ("optimise", "check", "submit")
OF_DESIGNS = (
    ("analyse", *SIZE),
    ("sweep", "--over", "offset=0 mm..20 mm:3", "--of", "stroke", *SIZE[:4]),
    pytest.param(("balance", *SIZE), marks=pytest.mark.slow),
    ("allocate", "--limit", "0.1 mm", *SIZE),
    pytest.param(("sections", *SIZE), marks=pytest.mark.slow),
    ("inverse", "--slider-position", "240 mm", *SIZE),
)
OF_RUNS = (
    ("front",),
    ("analyse", "--design", "1"),
    ("inverse", "--design", "1", "--slider-position", "240 mm"),
    ("wish", "--at", "peak_torque=keep"),
    ("round", "1", "--to", "1 mm"),
    ("like", "1", "--where", "peak_torque <= 1 N m"),
    ("compare", "nothing"),
)


def changed_job(**tables: Any) -> dict[str, Any]:
    """Return the small job with some of its tables changed, key by key."""
    found = {**SMALL}
    for name, table in tables.items():
        found[name] = {**SMALL.get(name, {}), **table} if isinstance(table, Mapping) else table
    return found


CONTRADICTIONS: dict[str, tuple[dict[str, Any], str]] = {
    "two requirements": (changed_job(**WISH), "constraints.time_ratio"),
    "a requirement beyond the ranges": (changed_job(constraints={"stroke": {"equals": "2 m"}}), "constraints.stroke"),
    "ranges in which nothing turns": (changed_job(variables={"crank": ["700 mm", "800 mm"]}), "variables"),
    "an offset that is needed": (
        {
            **changed_job(variables={"offset": "0 mm"}, constraints={"rod_to_offset": {"equals": 3.2}}),
            "objectives": {"transmission_angle": "maximise"},
        },
        "constraints.rod_to_offset",
    ),
    "linear formulas": (
        changed_job(constraints={"rod": {"equals": "3 * crank"}, "rod - 2 * crank": {"min": "250 mm"}}),
        "which exclude each other",
    ),
    "one formula written twice": (
        changed_job(constraints={"crank + rod": {"min": "300 mm"}, "crank +  rod": {"max": "200 mm"}}),
        "the requirements on one formula must not contradict each other; got",
    ),
    "a slow stroke on the other side": (
        changed_job(constraints={"slow_stroke": "outward"}, variables={"offset": ["0 mm", "200 mm"]}),
        "constraints.slow_stroke",
    ),
    "a slow stroke without a time ratio": (
        changed_job(
            constraints={"slow_stroke": "inward", "time_ratio": {"max": 1.0}},
            variables={"offset": ["-200 mm", "200 mm"]},
        ),
        "constraints.slow_stroke",
    ),
    "a quantity that is zero": (changed_job(constraints={"mean_torque": {"min": "1 N m"}}), "excludes zero"),
    "options without a design": (
        changed_job(
            choice=[
                {
                    "name": "motor",
                    "option": [
                        {"name": "small", "constraints": {"stroke": {"max": "100 mm"}}},
                        {"name": "large", "constraints": {"stroke": {"max": "200 mm"}}},
                    ],
                }
            ]
        ),
        "choice",
    ),
    "a swing that no design makes": (
        {
            "name": "swing",
            "mechanism": {"slider": {"mass": "2 kg"}},
            "motion": {"kind": "swing", "from": "10 deg", "to": "170 deg", "driver": "crank"},
            "variables": {"crank": "100 mm", "rod": ["20 mm", "40 mm"], "offset": "0 mm"},
            "objectives": {"actuator_travel": "minimise"},
        },
        "motion: no design within the ranges can be assembled",
    ),
    "values of which none fits": (
        changed_job(
            variables={
                "crank": {"values": ["50 mm", "60 mm"]},
                "rod": {"values": ["300 mm", "400 mm"]},
                "offset": {"values": ["0 mm", "20 mm"]},
            },
        ),
        "stroke",
    ),
}


@pytest.mark.parametrize("kind", CONTRADICTIONS)
def test_a_contradiction_is_infeasible_and_no_wrong_input(kind: str) -> None:
    tables, said = CONTRADICTIONS[kind]
    with pytest.raises(JobError) as told:
        parse_job(tables)
    assert said in str(told.value)
    assert type(told.value) is InfeasibleError


@pytest.mark.parametrize(
    "tables",
    [
        changed_job(constraints={"stroke": {"min": "90 mm", "max": "80 mm"}}),
        changed_job(constraints={"time_ratio": {"max": 0.9}}),
        changed_job(constraints={"peak_torque": {"max": "-5 N m"}}),
        changed_job(variables={"crank": ["200 mm", "20 mm"]}),
        changed_job(constraints={"strok": {"min": "90 mm"}}),
        changed_job(objectives={"stroke": "maximise"}),
    ],
)
def test_what_no_design_could_mean_is_wrong_input(tables: dict[str, Any]) -> None:
    with pytest.raises(JobError) as told:
        parse_job(tables)
    assert not isinstance(told.value, InfeasibleError)
    assert "no design" not in str(told.value)


@pytest.fixture
def impossible_job(tmp_path: Path) -> Path:
    """Return a valid job file that no design can meet."""
    file = tmp_path / "impossible.json"
    file.write_text(json.dumps(changed_job(**WISH)), encoding="utf-8")
    return file


@pytest.fixture
def run_without_designs(runs: Path) -> str:
    """Return a run that found no design."""
    with RunFolder(runs, "nothing") as run:
        run.keep_result(result_of(fronts.empty_front("infeasible", "nothing meets it"), str(run.path)), {})
    return run.path.name


@pytest.mark.parametrize("name", OF_JOBS)
def test_commands_that_search_end_with_3_and_its_json_for_an_impossible_job(
    name: str, impossible_job: Path, run_without_designs: str, command: Command
) -> None:
    """The JSON has the keys of a run that found nothing."""
    done = command(name, impossible_job)
    assert (done.exit_code, done.stdout) == (3, "")
    assert SAID in done.stderr
    done = command(name, impossible_job, "--json")
    assert done.exit_code == 3
    record = json.loads(done.stdout)
    assert record.keys() == json.loads(command("front", run_without_designs, "--json").stdout).keys()
    assert (record["status"], record["designs"], record["name"], record["run"]) == ("infeasible", [], SMALL["name"], "")
    assert SAID in record["message"]
    assert [item["quantity"] for item in record["objectives"]] == ["time_ratio", "transmission_angle"]
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("arguments", OF_DESIGNS, ids=lambda arguments: arguments[0])
def test_commands_on_a_given_design_give_the_same_for_a_job_that_no_design_can_meet(
    arguments: tuple[str, ...], tmp_path: Path, command: Command
) -> None:
    """Only the rules that the design misses differ, and they are no part of the comparison."""
    name, *rest = arguments
    found = []
    for title, tables in (("possible", changed_job(**NEEDED)), ("impossible", changed_job(**NEEDED, **WISH))):
        file = tmp_path / f"{title}.json"
        file.write_text(json.dumps(tables), encoding="utf-8")
        done = command(*(name, file, *rest) if name != "inverse" else (name, *rest, file), "--json")
        record = json.loads(done.stdout) if done.stdout else None
        found.append((done.exit_code, {**record, "rules": 0} if isinstance(record, dict) else record, done.stderr))
    assert [(code, record) for code, record, _ in found[1:]] == [found[0][:2]]
    assert (found[1][0], SAID in found[1][2]) == (0, False)


@pytest.mark.parametrize("kind", sorted({*CONTRADICTIONS} - {"one formula written twice"}))
def test_a_design_of_an_impossible_job_is_analysed(kind: str) -> None:
    """The job must only say what machine it is. One formula with a least above its greatest value says nothing."""
    tables, _ = CONTRADICTIONS[kind]
    if kind == "a swing that no design makes":
        swing = parse_job(tables, require_feasible=False).swing([0.1, 0.3, 0.0])
        assert swing.swing_angle == pytest.approx(math.radians(160.0))
        return
    problem = parse_job(tables, require_feasible=False)
    assert problem.parts()[0].analyse([0.14, 0.31, 0.06])["time_ratio"] > 1.0
    row, _ = quantities_of_design(problem.mechanism.nominal, Linkage(0.14, 0.31, 0.06), problem.own)
    assert judged_rules_of_design(problem, row)


@pytest.mark.parametrize("kind", ["a slow stroke without a time ratio", "options without a design"])
def test_a_search_for_an_impossible_job_finds_nothing_however_it_was_read(kind: str) -> None:
    tables, said = CONTRADICTIONS[kind]
    with pytest.raises(InfeasibleError, match=said):
        sc.solve(parse_job(tables, require_feasible=False))


def test_analyse_says_which_requirements_of_an_impossible_job_a_design_misses(
    impossible_job: Path, command: Command
) -> None:
    done = command("analyse", impossible_job, *SIZE)
    assert done.exit_code == 0
    assert "Not met:" in done.stdout
    rules = json.loads(command("analyse", impossible_job, *SIZE, "--json").stdout)["rules"]
    assert {rule["quantity"] for rule in rules if not rule["met"]} >= {"time_ratio"}


def test_python_reads_an_impossible_job_to_look_at_its_designs(impossible_job: Path) -> None:
    with pytest.raises(InfeasibleError):
        sc.load_job(impossible_job)
    from_file = sc.load_job(impossible_job, require_feasible=False)
    from_tables = sc.problem(changed_job(**WISH), require_feasible=False)
    size = [0.14, 0.31, 0.06]
    assert from_file.analyse(size)["time_ratio"] == from_tables.analyse(size)["time_ratio"] > 1.0


@pytest.mark.parametrize("arguments", OF_RUNS, ids=lambda arguments: arguments[0])
def test_commands_that_take_a_run_without_designs_end_with_3_and_its_json(
    arguments: tuple[str, ...], run_without_designs: str, runs: Path, command: Command
) -> None:
    name, *rest = arguments
    if name == "compare":
        with RunFolder(runs, "some") as run:
            run.keep_result(result_of(fronts.front(), str(run.path)), {})
        given: tuple[str, ...] = (name, run.path.name, run_without_designs)
    else:
        given = (name, *rest, run_without_designs) if name == "inverse" else (name, run_without_designs, *rest)
    done = command(*given)
    assert (done.exit_code, done.stdout) == (3, "")
    assert "nothing meets it" in done.stderr
    done = command(*given, "--json")
    assert done.exit_code == 3
    record = json.loads(done.stdout)
    assert (record["status"], record["designs"]) == ("infeasible", [])
    assert "nothing meets it" in record["message"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("front", "latest", "--where", "stroke <= 100 mm"), {"status": "done", "designs": []}),
        (("round", "latest", "3", "--to", "50 mm"), {"met": False}),
        (("like", "latest", "3", "--where", "crank >= 201 mm"), {"status": "infeasible"}),
    ],
    ids=lambda part: part[0] if isinstance(part, tuple) else "",
)
def test_commands_on_a_finished_run_answer_with_their_own_json_and_3(
    arguments: tuple[str, ...], said: dict[str, Any], kept: Path, command: Command
) -> None:
    done = command(*arguments, "--runs", kept, "--json")
    assert done.exit_code == 3
    record = json.loads(done.stdout)
    assert {key: record[key] for key in said} == said
    assert done.stderr.startswith("slidercrank: no")


def test_an_impossible_job_leaves_no_run_and_no_job(impossible_job: Path, runs: Path, command: Command) -> None:
    command("optimise", impossible_job, "--json")
    command("submit", impossible_job)
    assert not runs.exists()


def test_the_api_analyses_a_design_of_an_impossible_job(store: Store) -> None:
    size = {"crank": "140 mm", "rod": "310 mm", "offset": "60 mm"}
    with client_of(store) as client:
        found = [client.post("/analyse", json={"job": job, **size}) for job in (SMALL, changed_job(**WISH))]
    assert [response.status_code for response in found] == [200, 200]
    assert found[0].json() == found[1].json()


@pytest.mark.parametrize("place", ["jobs", "check"])
def test_the_api_answers_with_a_problem_of_the_type_infeasible(place: str, store: Store) -> None:
    with client_of(store) as client:
        response = client.post(f"/{place}", json={"job": changed_job(**WISH)})
        assert SAID in refusal_sentence(response, 422)
        assert response.json()["type"] == "infeasible"
        wrong = client.post(f"/{place}", json={"job": changed_job(constraints={"strok": {"min": "90 mm"}})})
        assert refusal_sentence(wrong, 422)
        assert wrong.json()["type"] == "about:blank"
    assert store.jobs() == []


def test_the_preview_says_which_mistakes_are_impossible_wishes(shared_preview: httpx.Client) -> None:
    found = shared_preview.post("/preview", json={"job": changed_job(**WISH)}).json()["wrong"]
    assert [(one["path"], one["infeasible"]) for one in found] == [("constraints.time_ratio", True)]
    found = shared_preview.post("/preview", json={"job": CONTRADICTIONS["a quantity that is zero"][0]}).json()["wrong"]
    assert [(one["path"], one["infeasible"]) for one in found] == [("constraints.mean_torque", True)]
    found = shared_preview.post("/preview", json={"job": changed_job(mechanism={"speed": "fast"})}).json()["wrong"]
    assert [(one["path"], one["infeasible"]) for one in found] == [("mechanism.speed", False)]


@pytest.fixture
def shared_preview(store: Store) -> Any:
    """Return a client of a service."""
    with client_of(store) as client:
        yield client


def test_the_client_tells_impossible_from_wrong(store: Store) -> None:
    with served(store) as address, Client(address) as client:
        with pytest.raises(InfeasibleError, match=SAID):
            client.submit(changed_job(**WISH))
        with pytest.raises(InputError) as told:
            client.submit(changed_job(mechanism={"speed": "fast"}))
        assert not isinstance(told.value, InfeasibleError)


def test_a_worker_ends_a_job_that_is_found_impossible_as_infeasible(store: Store) -> None:
    """Jobs are checked when they are submitted; what an earlier release let through is found by its worker."""
    job = store.submit(changed_job(**WISH), name="impossible")
    assert work(store, drain=True) == 1
    ended = store.job(job.id)
    assert ended.state == "infeasible"
    assert SAID in ended.reason
