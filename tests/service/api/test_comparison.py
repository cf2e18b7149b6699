"""Runs against each other over the API: differences of their jobs, and who is better where, against brute force."""

from __future__ import annotations

import random
import re
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import replace
from typing import Any

import httpx
import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.decisions.price_of_robustness import compare_fronts
from slidercrank.service.client import Client
from slidercrank.service.designs.front_comparison import NEAR
from slidercrank.service.questions.compare.analysis import differences_between_jobs
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of, store_result

TABLES = tomllib.loads(fronts.JOB)
KEYS = ("time_ratio", "least_transmission_angle_deg")
"""Both are maximised."""


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Store]:
    with Store(tmp_path_factory.mktemp("comparison") / "store.db") as opened:
        yield opened


@pytest.fixture(scope="module")
def client(store: Store) -> Iterator[httpx.Client]:
    with client_of(store) as opened:
        yield opened


def with_random_objectives(solved: Solved, chance: random.Random) -> list[dict[str, Any]]:
    """Return the designs with other values of the objectives, drawn at random."""
    return [{**row, KEYS[0]: chance.uniform(1, 2), KEYS[1]: chance.uniform(30, 60)} for row in solved.result.designs]


def test_jobs_differ_where_they_say_other_things() -> None:
    other = tomllib.loads(fronts.JOB)
    other["name"] = "Another"
    other["variables"]["rod"][1] = "700 mm"
    other["load"] = [{"force": "200 N", "opposes": "motion"}]
    del other["constraints"]["transmission_angle"]
    assert differences_between_jobs([TABLES, other]) == [
        ("variables.rod", ("60 mm to 600 mm", "60 mm to 700 mm")),
        ("constraints.transmission_angle.min", ("40 deg", None)),
        ("load.1.force", (None, "200 N")),
        ("load.1.opposes", (None, "motion")),
    ]
    assert differences_between_jobs([TABLES, TABLES]) == []


def test_sentences_count_the_designs_that_the_other_run_does_not_match(
    client: httpx.Client, store: Store, solved: Solved
) -> None:
    chance = random.Random(5)
    for _ in range(4):
        rows = [with_random_objectives(solved, chance) for _ in range(2)]
        numbers = [store_result(store, replace(solved.result, exact=None), TABLES, designs=own) for own in rows]
        sentences = client.get(f"{API}/comparison", params={"job": numbers}).json()["sentences"]
        for index in (0, 1):
            own, other, first, second = rows[index], rows[1 - index], numbers[index], numbers[1 - index]
            near = {
                key: NEAR * (max(row[key] for row in own + other) - min(row[key] for row in own + other))
                for key in KEYS
            }
            free = [row for row in own if not any(all(one[k] >= row[k] - near[k] for k in KEYS) for one in other)]
            about = [one for one in sentences if re.search(rf"run {first}\b.* that run {second} does not match", one)]
            if 0 < len(free) < len(own):
                assert about[0].startswith(f"run {first} has {len(free)} of {len(own)} designs")
                for title, low, high in re.findall(r"(time ratio) is ([\d.]+) to ([\d.]+)", about[0]):
                    ends = [row[KEYS[0]] for row in free]
                    assert (float(low), float(high)) == pytest.approx((min(ends), max(ends)), rel=1e-3), title
            elif free:
                assert (
                    f"run {second} matches none of the {len(own)} designs of run {first}, to 2 % of each range"
                    in sentences
                )
            else:
                assert f"run {second} matches or beats every design of run {first}, to 2 % of each range" in sentences


def test_a_comparison_of_different_jobs_says_what_the_change_costs_and_that_they_differ(
    client: httpx.Client, store: Store, solved: Solved
) -> None:
    other = deepcopy(TABLES)
    other["mechanism"]["speed"] = "77 rpm"
    other["constraints"]["stroke"] = {"equals": "123 mm"}
    other["constraints"]["rod / (2.5 * crank)"] = {"min": 1}
    other["load"] = [{"force": "200 N", "opposes": "motion"}]
    other["optimiser"] = {"seed": 9}
    numbers = [store_result(store, solved.result, TABLES), store_result(store, solved.result, other)]
    found = client.get(f"{API}/comparison", params={"job": numbers}).json()
    cost, first, *rest = found["sentences"]
    assert cost.startswith(f"at best, run {numbers[1]} instead of run {numbers[0]} does not change time ratio and ")
    subject, _, names = first.partition(": ")
    assert subject == "the two jobs state different problems"
    different = {"speed", "stroke", "load", "rod / (2.5 * crank)"}
    assert set(names.removesuffix("; only the numbers are compared").split(", ")) == different
    assert any("matches or beats every design" in one for one in rest)
    assert "The two jobs state different problems" in str(found["blocks"][2])


def test_fronts_of_nested_ranges_are_said_to_be_samples(client: httpx.Client, store: Store, solved: Solved) -> None:
    wider, faster = deepcopy(TABLES), deepcopy(TABLES)
    wider["variables"]["rod"][1] = "700 mm"
    faster["mechanism"]["speed"] = "77 rpm"
    chance = random.Random(8)
    result = replace(solved.result, exact=None)
    own, *others = [
        store_result(store, result, tables, designs=with_random_objectives(solved, chance))
        for tables in (TABLES, wider, TABLES, faster)
    ]
    wide = f"The ranges of run {others[0]} contain those of run {own}, so its true front is nowhere worse: "
    same = "have the same ranges, so their true fronts are the same: "
    for other, cause in zip(others, (wide, same, None), strict=True):
        for first, second in ((own, other), (other, own)):
            found = client.get(f"{API}/comparison", params={"job": [first, second]}).json()
            assert (f"{cause}the two fronts are samples" in str(found["blocks"])) == (cause is not None)
            assert ("are samples of" in str(found["blocks"])) == (cause is not None)
            assert "Neither of the two dominates" in str(found["blocks"])


def test_the_best_of_each_objective_is_said_with_who_has_it(client: httpx.Client, store: Store, solved: Solved) -> None:
    better = [{**row, KEYS[0]: float(str(row[KEYS[0]])) + 1.0} for row in solved.result.designs]
    first = store_result(store, solved.result, TABLES)
    second = store_result(store, replace(solved.result, exact=None), TABLES, designs=better)
    found = client.get(f"{API}/comparison", params={"job": [first, second]}).json()
    most = max(float(str(row[KEYS[0]])) for row in solved.result.designs)
    assert f"best time ratio: run {second} with {most + 1:.4g}, against {most:.4g} of run {first}" in found["sentences"]
    assert any(one.startswith("best least transmission angle: all reach") for one in found["sentences"])
    assert found["sentences"][0].startswith(f"at best, run {second} instead of run {first} gains 1 of time ratio, does")
    assert found["differences"] == []


def test_measures_are_those_of_the_fronts_and_left_out_for_other_objectives(
    store: Store, client: httpx.Client, solved: Solved
) -> None:
    chance = random.Random(6)
    rows = [with_random_objectives(solved, chance) for _ in range(2)]
    numbers = [store_result(store, replace(solved.result, exact=None), TABLES, designs=own) for own in rows]
    values = [np.array([[-float(str(row[key])) for key in KEYS] for row in own]) for own in rows]
    with Client(str(client.base_url).removesuffix("/api/v1")) as service:
        found = service.comparison(numbers, tolerance=0.01)
        expected = compare_fronts(values, tolerance=0.01)
        assert found["tolerance"] == 0.01
        assert [run["run"] for run in found["runs"]] == [f"run {number}" for number in numbers]
        assert np.array(found["coverage"]) == pytest.approx(expected.coverage)
        assert np.array(found["epsilon"]) == pytest.approx(expected.epsilon)
        assert found["dominates"] == expected.dominates.tolist()
        fewer = replace(solved.result, exact=None, objectives=solved.result.objectives[:1])
        measures = service.comparison([numbers[0], store_result(store, fewer, TABLES)])
        assert measures.keys() == {"sentences", "differences"}
        assert measures["sentences"][1].startswith("best time ratio: ")
        with pytest.raises(InputError, match="compare may only be given tolerance; got of"):
            service.comparison(numbers, of=1.0)
        with pytest.raises(InputError, match="compare needs several jobs; got one"):
            service.ask(numbers[0], None, "compare")


def test_runs_without_designs_have_no_sentences_and_one_run_twice_is_refused(
    client: httpx.Client, store: Store, solved: Solved
) -> None:
    first = store_result(store, solved.result, TABLES)
    empty = store_result(store, replace(solved.result, designs=[], exact=None, extremes={}, knee=None), TABLES)
    assert client.get(f"{API}/comparison", params={"job": [first, empty]}).json()["sentences"] == []
    for jobs, sentence in (
        ([first, first], "a run may be named only once"),
        ([first], "at least 2"),
        ([first, 999], ""),
    ):
        answer = client.get(f"{API}/comparison", params={"job": jobs})
        assert answer.status_code in (404, 422)
        assert sentence in answer.text
