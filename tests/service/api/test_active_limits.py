"""Limits on which designs rest, over the API: counted by hand, widened in a copy with its origin."""

from __future__ import annotations

import random
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import httpx
import pytest

from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of, store_result

ENDS = {
    ("variables.crank", "lower"): ("crank_mm", 20.0),
    ("variables.crank", "upper"): ("crank_mm", 200.0),
    ("variables.rod", "lower"): ("rod_mm", 60.0),
    ("variables.rod", "upper"): ("rod_mm", 600.0),
    ("variables.offset", "lower"): ("offset_mm", 0.0),
    ("variables.offset", "upper"): ("offset_mm", 200.0),
    ("constraints.transmission_angle", "lower"): ("least_transmission_angle_deg", 40.0),
}
"""Every limit of the small job that may bind: the stroke is exact, so that all designs rest on it."""


@pytest.fixture(scope="module")
def store(solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Store]:
    path = tmp_path_factory.mktemp("binding") / "store.db"
    back_up(solved.store, path)
    with Store(path) as opened:
        yield opened


@pytest.fixture(scope="module")
def client(store: Store) -> Iterator[httpx.Client]:
    with client_of(store) as opened:
        yield opened


def counted(rows: list[dict[str, Any]]) -> dict[tuple[str, str], list[int]]:
    """Return the numbers of the designs that rest on each limit, by its place and side."""
    near = {
        place: [n for n, row in enumerate(rows, 1) if abs(row[key] - end) <= 1e-6 * (abs(end) or 200.0)]
        for place, (key, end) in ENDS.items()
    }
    return {place: numbers for place, numbers in near.items() if numbers}


def found_in(client: httpx.Client, number: int) -> dict[tuple[str, str], list[int]]:
    answer = client.get(f"{API}/jobs/{number}/binding")
    assert answer.status_code == 200, answer.text
    limits = answer.json()["limits"]
    assert [len(one["designs"]) for one in limits] == sorted((len(one["designs"]) for one in limits), reverse=True)
    return {(one["of"], one["side"]): one["designs"] for one in limits}


def test_designs_that_rest_on_a_limit_are_those_counted_by_hand(client: httpx.Client, solved: Solved) -> None:
    rows = client.get(f"{solved.path}/designs").json()["designs"]
    assert found_in(client, solved.number) == counted(rows)
    assert ("constraints.transmission_angle", "lower") in counted(rows)


def test_designs_put_on_limits_at_random_are_found_there(client: httpx.Client, store: Store, solved: Solved) -> None:
    chance = random.Random(17)
    rows: list[dict[str, Any]] = [dict(row) for row in solved.result.designs]
    for row in rows:
        for key, end in chance.sample(list(ENDS.values()), 3):
            row[key] = end + chance.choice((0.0, 0.0, 1e-3))
    number = store_result(store, replace(solved.result, exact=None), tomllib.loads(fronts.JOB), designs=rows)
    assert found_in(client, number) == counted(rows)


def test_a_wider_limit_is_a_job_of_its_own_that_knows_where_it_came_from(client: httpx.Client, solved: Solved) -> None:
    wanted = [
        {"of": "variables.rod", "side": "upper", "value": 725.0},
        {"of": "constraints.transmission_angle", "side": "lower", "value": 36.0},
    ]
    answer = client.post(f"{solved.path}/widened", json={"limits": wanted})
    assert answer.status_code == 201, answer.text
    made = answer.json()
    assert made["origin"] == solved.number
    before = tomllib.loads(fronts.JOB)
    after = client.get(f"{API}/jobs/{made['id']}/job").json()
    expected = {**before, "name": f"{before['name']}, rod at most 725 mm, least transmission angle at least 36 deg"}
    expected["variables"] = {**before["variables"], "rod": ["60 mm", "725 mm"]}
    expected["constraints"] = {**before["constraints"], "transmission_angle": {"min": "36 deg"}}
    assert after == expected
    assert client.get(solved.path).json()["origin"] is None
    clone = client.post(f"{API}/jobs/{made['id']}/clone", json={}).json()
    assert clone["origin"] == made["id"]


@pytest.mark.parametrize(
    ("of", "side", "value", "sentence"),
    [
        ("variables.rod", "upper", 500.0, "a wider limit must be above 600 mm; got 500"),
        ("variables.rod", "upper", 600.0, "a wider limit must be above 600 mm; got 600"),
        ("variables.offset", "lower", 5.0, "a wider limit must be below 0 mm; got 5"),
        ("constraints.stroke", "upper", 300.0, "choose from variables.crank (lower)"),
        ("mechanism.speed", "upper", 300.0, "a limit of the job must be named by its place"),
    ],
)
def test_what_is_no_wider_limit_is_refused(
    client: httpx.Client, solved: Solved, of: str, side: str, value: float, sentence: str
) -> None:
    answer = client.post(f"{solved.path}/widened", json={"limits": [{"of": of, "side": side, "value": value}]})
    assert answer.status_code == 422
    assert sentence in answer.json()["detail"]


def test_numbers_that_vary_deep_in_a_job_are_widened_where_they_stand() -> None:
    from slidercrank.optimise.job import parse_job
    from slidercrank.service.designs.derived_jobs import widen_limits

    tables = tomllib.loads(fronts.JOB)
    for place in ({"mechanism": {"slider": {"mass": ["1 kg", "2 kg"]}}}, {"mechanism.slider.mass": ["1 kg", "2 kg"]}):
        tables["variables"] = {**tomllib.loads(fronts.JOB)["variables"], **place}
        made = widen_limits(parse_job(tables), tables, [("variables.mechanism.slider.mass", "upper", 2.5)])
        expected = str(tables["variables"]).replace("2 kg", "2.5 kg")
        assert str(made["variables"]) == expected
        assert parse_job(made).mechanism.varying[0].upper == 2.5
        assert "'2 kg'" in str(tables)  # the job itself stays
