"""Fronts and designs over the API: what the command line gives, with the same sentences where it refuses."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from slidercrank.service.runs.result import json_ready
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of, rows_with, store_result

TABLES = tomllib.loads(fronts.JOB)


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    """Return a client of its service."""
    with client_of(solved.store) as found:
        yield found


def command(solved: Solved, *arguments: str) -> Any:
    """Return the JSON that `slidercrank front --json` prints."""
    done = CliRunner().invoke(command_line, ["front", str(solved.folder), "--json", *arguments])
    return json.loads(done.stdout)


def command_refusal(solved: Solved, *arguments: str) -> str:
    """Return the sentence with which `slidercrank front` refuses."""
    done = CliRunner().invoke(command_line, ["front", str(solved.folder), "--json", *arguments])
    assert done.exit_code in (2, 3)
    return done.stderr.removeprefix("slidercrank: ").rstrip("\n")


def test_a_front_is_that_of_the_command_line_without_its_designs(solved: Solved, client: httpx.Client) -> None:
    found = client.get(f"{solved.path}/front").json()
    record = command(solved)
    designs = record.pop("designs")
    assert found["count"] == len(designs)
    assert [column["key"] for column in found["columns"]] == list(designs[0])
    assert {column["key"]: column["unit"] for column in found["columns"]}["crank_mm"] == "mm"
    for key, value in record.items():
        if key not in ("run", "objectives", "seconds"):
            assert found[key] == value, key
    assert [wanted["quantity"] for wanted in found["objectives"]] == ["time_ratio", "transmission_angle"]


def test_designs_are_those_of_the_command_line(solved: Solved, client: httpx.Client) -> None:
    page = client.get(f"{solved.path}/designs").json()
    record = command(solved)
    assert page["designs"] == record["designs"]
    assert page["numbers"] == list(range(1, len(record["designs"]) + 1))


@pytest.mark.parametrize(
    ("query", "arguments"),
    [
        ({"where": "transmission_angle >= 45 deg"}, ("--where", "transmission_angle >= 45 deg")),
        (
            {"where": ["time_ratio > 1.1", "slow_stroke = inward"]},
            ("--where", "time_ratio > 1.1", "--where", "slow_stroke = inward"),
        ),
        ({"sort": "rod"}, ("--sort", "rod")),
        ({"sort": "transmission_angle", "reverse": "true"}, ("--sort", "transmission_angle", "--reverse")),
        (
            {"where": "rod / crank >= 1.5", "sort": "crank+rod"},
            ("--where", "rod / crank >= 1.5", "--sort", "crank+rod"),
        ),
        ({"columns": "rod, peak_torque_Nm,rod"}, ("--columns", "rod, peak_torque_Nm,rod")),
    ],
)
def test_designs_are_filtered_sorted_and_cut_as_on_the_command_line(
    query: dict[str, Any], arguments: tuple[str, ...], solved: Solved, client: httpx.Client
) -> None:
    page = client.get(f"{solved.path}/designs", params=query).json()
    expected = command(solved, *arguments)["designs"]
    assert expected
    assert page["designs"] == expected
    assert page["chosen"] == len(expected)
    assert page["count"] == len(solved.result.designs)


def test_pages_make_up_the_whole(solved: Solved, client: httpx.Client) -> None:
    whole = client.get(f"{solved.path}/designs", params={"sort": "rod"}).json()
    pages = [
        client.get(f"{solved.path}/designs", params={"sort": "rod", "offset": offset, "limit": 3}).json()
        for offset in range(0, whole["count"] + 3, 3)
    ]
    assert [row for page in pages for row in page["designs"]] == whole["designs"]
    assert [number for page in pages for number in page["numbers"]] == whole["numbers"]
    assert pages[-1]["designs"] == []


def test_a_design_has_the_number_of_the_command_line(solved: Solved, client: httpx.Client) -> None:
    found = client.get(f"{solved.path}/designs/3").json()
    assert (found["number"], found["design"]) == (3, json_ready(solved.result.designs[2]))
    picked = command(solved, "--knee")
    assert client.get(f"{solved.path}/designs/{picked['number']}").json()["design"] == picked["designs"][0]


@pytest.mark.parametrize(
    ("query", "arguments"),
    [
        ("knee=true", ("--knee",)),
        ("knee", ("--knee",)),
        ("topsis=time_ratio%3D3,transmission_angle%3D1", ("--topsis", "time_ratio=3,transmission_angle=1")),
        (
            "lexicographic=time_ratio:20 %25,transmission_angle",
            ("--lexicographic", "time_ratio:20 %,transmission_angle"),
        ),
        ("knee&where=transmission_angle > 45 deg", ("--knee", "--where", "transmission_angle > 45 deg")),
    ],
)
def test_a_pick_is_that_of_the_command_line(
    query: str, arguments: tuple[str, ...], solved: Solved, client: httpx.Client
) -> None:
    found = client.get(f"{solved.path}/pick?{query}").json()
    expected = command(solved, *arguments)
    assert (found["number"], found["design"]) == (expected["number"], expected["designs"][0])


@pytest.mark.parametrize(
    ("path", "arguments", "status"),
    [
        ("designs?where=nothing > 1", ("--where", "nothing > 1"), 422),
        ("designs?where=transmission_angle > 45", ("--where", "transmission_angle > 45"), 422),
        ("designs?where=", ("--where", ""), 422),
        ("designs?sort=torque_peak", ("--sort", "torque_peak"), 422),
        ("designs?columns=rod,none", ("--columns", "rod,none"), 422),
        ("designs?where=crank > 9**9**9**9 mm", ("--where", "crank > 9**9**9**9 mm"), 422),
        ("designs?where=crank > nan", ("--where", "crank > nan"), 422),
        ("pick?topsis=rod%3D1", ("--topsis", "rod=1"), 422),
        ("pick?knee&topsis=time_ratio%3D1", ("--knee", "--topsis", "time_ratio=1"), 422),
        ("pick?lexicographic=time_ratio:", ("--lexicographic", "time_ratio:"), 422),
        ("pick?knee&where=time_ratio > 99", ("--knee", "--where", "time_ratio > 99"), 422),
    ],
)
def test_what_is_refused_is_told_in_the_words_of_the_command_line(
    path: str, arguments: tuple[str, ...], status: int, solved: Solved, client: httpx.Client
) -> None:
    answer = client.get(f"{solved.path}/{path}")
    assert (answer.status_code, answer.headers["content-type"]) == (status, "application/problem+json")
    assert answer.json()["detail"] == command_refusal(solved, *arguments)


def test_conditions_that_no_design_meets_are_infeasible_and_wrong_ones_are_not(
    solved: Solved, client: httpx.Client
) -> None:
    """The command line ends with 3 for the first and with 2 for the second."""
    for where, kind in (("time_ratio > 99", "infeasible"), ("transmission_angle > 45", "about:blank")):
        answer = client.get(f"{solved.path}/pick?knee&where={where}")
        assert (answer.status_code, answer.json()["type"]) == (422, kind)


@pytest.mark.parametrize(
    ("path", "status", "words"),
    [
        ("designs?limit=0", 422, "limit"),
        ("designs?limit=1001", 422, "limit"),
        ("designs?limit=99999999999999999999999", 422, "limit"),
        ("designs?offset=-1", 422, "offset"),
        ("designs?where=crank%00 > 1 mm", 400, "NUL"),
        ("designs?sort=%01", 422, "there is no quantity or column '\\x01'"),
        (f"designs?where={'x' * 501}", 422, "at most 500"),
        ("designs?" + "&where=crank > 1 mm" * 51, 422, "at most 50"),
        ("designs/0", 422, "design"),
        ("designs/99999999999999999999999999", 422, "design"),
        ("designs/9", 404, "has designs 1 to 8; got 9"),
        ("designs/one", 422, "design"),
        ("pick", 422, "knee, topsis or lexicographic"),
        ("pick?knee=perhaps", 422, "knee"),
    ],
)
def test_values_out_of_bounds_are_problems(
    path: str, status: int, words: str, solved: Solved, client: httpx.Client
) -> None:
    answer = client.get(f"{solved.path}/{path}")
    assert (answer.status_code, answer.headers["content-type"]) == (status, "application/problem+json")
    assert words in answer.json()["detail"]


@pytest.mark.parametrize("place", ["front", "designs", "designs/1", "pick?knee", "figures", "export.csv"])
def test_a_job_that_is_not_there_is_not_found(place: str, client: httpx.Client) -> None:
    answer = client.get(f"{API}/jobs/99/{place}")
    assert (answer.status_code, answer.json()["detail"]) == (404, "there is no job 99; list the jobs")


@pytest.fixture
def empty(store: Store) -> Iterator[httpx.Client]:
    """Return a client of the service of the empty store."""
    with client_of(store) as found:
        yield found


@pytest.mark.parametrize("place", ["front", "designs", "designs/1", "pick?knee", "figures", "export.csv"])
def test_a_job_that_waits_has_no_front_yet(place: str, store: Store, empty: httpx.Client) -> None:
    job = store.submit(TABLES, name="Waits")
    answer = empty.get(f"{API}/jobs/{job.id}/{place}")
    assert answer.status_code == 409
    assert answer.json()["detail"] == f"job {job.id} has no result: it is queued; wait for it, or see its events"


def test_a_front_without_designs_says_why(solved: Solved, store: Store, empty: httpx.Client) -> None:
    nothing: dict[str, Any] = {"designs": [], "extremes": {}, "knee": None, "trade_offs": [], "hypervolume": 0.0}
    job = store_result(store, solved.result, TABLES, **nothing, status="infeasible", message="no design meets all")
    client = empty
    path = f"{API}/jobs/{job}"
    found = client.get(f"{path}/front").json()
    assert (found["count"], found["columns"], found["status"]) == (0, [], "infeasible")
    assert client.get(f"{path}/designs?where=crank > 1 mm&sort=rod").json()["designs"] == []
    assert client.get(f"{path}/figures").json()["figures"] == []
    picked = client.get(f"{path}/pick?knee")
    assert (picked.status_code, picked.json()["detail"]) == (422, "no design meets all")
    assert picked.json()["type"] == "infeasible"
    assert client.get(f"{path}/designs/1").status_code == 404
    assert client.get(f"{path}/export.csv").text == ""


def test_infinite_numbers_are_words_and_undefined_ones_null(solved: Solved, store: Store, empty: httpx.Client) -> None:
    rows = rows_with(solved.result.designs, slack_x_mm=math.inf, low_mm=-math.inf, none_mm=math.nan)
    job = store_result(store, solved.result, TABLES, designs=rows)
    client = empty
    (design,) = client.get(f"{API}/jobs/{job}/designs?limit=1").json()["designs"]
    assert (design["slack_x_mm"], design["low_mm"], design["none_mm"]) == ("inf", "-inf", None)
    values = client.get(f"{API}/jobs/{job}/columns?columns=slack_x_mm,low_mm,none_mm,crank_mm").json()["values"]
    assert [set(values[key]) for key in ("slack_x_mm", "low_mm", "none_mm")] == [{"inf"}, {"-inf"}, {None}]
    assert values["crank_mm"] == [row["crank_mm"] for row in rows]
    for place in ("designs/1", "pick?knee", "export.json"):
        assert "Infinity" not in client.get(f"{API}/jobs/{job}/{place}").text


def test_a_resumed_job_shows_what_it_found_last(solved: Solved, store: Store, empty: httpx.Client) -> None:
    job = store_result(store, solved.result, TABLES, status="cancelled", message="cancelled")
    client = empty
    path = f"{API}/jobs/{job}/designs"
    before = client.get(path).json()
    store.resume(job)
    claim = store.claim("another")
    assert claim is not None
    assert client.get(path).json() == before
    rows = rows_with(solved.result.designs, crank_mm=1.5)
    claim.finish(solved.result.__class__(**{**solved.result.__dict__, "designs": rows}))
    assert {row["crank_mm"] for row in client.get(path).json()["designs"]} == {1.5}


def test_fronts_at_hand_are_bounded_by_their_designs(solved: Solved, store: Store) -> None:
    from slidercrank.service.api.stored_fronts import StoredFronts

    jobs = [store_result(store, solved.result, TABLES) for _ in range(4)]
    kept = StoredFronts(store, most_designs=3 * len(solved.result.designs))
    found = [kept.front_of_job(job) for job in jobs]
    assert all(kept.front_of_job(job) is front for job, front in zip(jobs[1:], found[1:], strict=True))
    assert kept.front_of_job(jobs[0]) is not found[0]
    assert kept.front_of_job(jobs[1]) is not found[1]  # the least used one has made room
    assert kept.front_of_job(jobs[3]) is found[3]
