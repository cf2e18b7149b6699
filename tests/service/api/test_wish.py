"""Choosing by wishing over the API: the record of the command line, and refusals in a sentence."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from slidercrank.service.client import Client
from slidercrank.service.store import Store
from slidercrank.service.store.bookmarks_and_wishes import MOST_WISHES, note_wish
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service.api.fixed_front import Solved, client_of, served

AT = {"time_ratio": "1.3", "transmission_angle": "50 deg"}


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


def printed_record(solved: Solved, *options: str) -> dict[str, Any]:
    """Return the record of the command line."""
    done = CliRunner().invoke(command_line, ["wish", "latest", *options, "--runs", str(solved.folder.parent), "--json"])
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize("units", ["metric", "inch"])
def test_the_record_is_that_of_the_command_line(units: str, client: httpx.Client, solved: Solved) -> None:
    answer = client.post(f"{solved.path}/wish", json={"at": AT}, params={"units": units})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    expected = printed_record(
        solved, *(part for name in AT for part in ("--at", f"{name}={AT[name]}")), "--units", units
    )
    assert (found["job"], found["number"], found["sentences"]) == (solved.number, None, expected["sentences"])
    assert [column["key"] for column in found["columns"]] == list(expected["design"])
    for key, value in expected["design"].items():
        near = pytest.approx(value, rel=1e-6, abs=1e-6) if isinstance(value, float) else value
        assert found["design"][key] == near, key
    for own, other in zip(found["objectives"], expected["objectives"], strict=True):
        assert own == {
            key: pytest.approx(value, rel=1e-6, abs=1e-6) if isinstance(value, float) else value
            for key, value in other.items()
        }


def test_wishes_are_kept_for_all_the_latest_first_and_each_once(solved: Solved, tmp_path: Path) -> None:
    back_up(solved.store, tmp_path / "store.db")
    with Store(tmp_path / "store.db") as store, served(store) as address, Client(address) as opened:
        for at, design in (
            (AT, None),
            ({"time_ratio": "improve", "transmission_angle": "may worsen to 0.75 rad"}, 3),
            ({"transmission_angle": "50 deg", "time_ratio": "1.3"}, None),
            ({"time_ratio": "improve"}, 3),
        ):
            opened.wish(solved.number, at, design=design)
        found = opened.wishes(solved.number)
        for value in range(MOST_WISHES + 5):
            note_wish(store, solved.number, {"time_ratio": ("value", float(value))}, None)
        latest = [one["wishes"]["time_ratio"]["value"] for one in opened.wishes(solved.number)]
    improves = {"wish": "improve", "value": None}
    limit = {"wish": "limit", "value": pytest.approx(math.degrees(0.75))}
    of = {"time_ratio": {"wish": "value", "value": 1.3}, "transmission_angle": {"wish": "value", "value": 50.0}}
    assert [(one["wishes"], one["design"]) for one in found[:3]] == [
        ({"time_ratio": improves}, 3),
        (of, None),
        ({"time_ratio": improves, "transmission_angle": limit}, 3),
    ]
    assert [one["at"] for one in found] == sorted((one["at"] for one in found), reverse=True)
    assert latest == [float(value) for value in range(MOST_WISHES + 5)][::-1][:MOST_WISHES]


def test_the_client_improves_on_a_design(client: httpx.Client, solved: Solved) -> None:
    row = client.get(f"{solved.path}/designs/3").json()["design"]
    least = row["least_transmission_angle_deg"] - 1.0
    with served(solved.store) as address, Client(address) as opened:
        found = opened.wish(
            solved.number, {"time_ratio": "improve", "transmission_angle": f"may worsen to {least!r} deg"}, design=3
        )
    assert found["number"] == 3
    assert found["design"]["least_transmission_angle_deg"] == pytest.approx(least, rel=1e-9)
    assert found["design"]["time_ratio"] > row["time_ratio"]
    assert found["objectives"][0]["before"] == pytest.approx(row["time_ratio"])


@pytest.mark.parametrize(
    ("body", "status", "words"),
    [
        ({"at": {}}, 422, "no wish was given"),
        ({"at": {"time_ratio": "NaN"}}, 422, "must be a finite number"),
        ({"at": {"transmission_angle": "5 mm"}}, 422, "which is a length"),
        ({"at": {"crank": "5 mm"}}, 422, "one of the objectives time_ratio, transmission_angle; got 'crank'"),
        ({"at": {"time_ratio": "improve"}}, 422, "got none; name one"),
        ({"at": {"time_ratio": "1.2"}, "design": 999}, 404, "got 999"),
        ({"at": {"time_ratio": 1.2}}, 422, "must be text"),
        ({}, 422, "at"),
    ],
)
def test_wishes_that_make_no_sense_are_refused(
    client: httpx.Client, solved: Solved, body: dict[str, Any], status: int, words: str
) -> None:
    answer = client.post(f"{solved.path}/wish", json=body)
    assert answer.status_code == status, answer.text
    assert words in answer.text


def test_nothing_within_what_is_allowed_is_told(client: httpx.Client, solved: Solved) -> None:
    at = {"time_ratio": "1.2", "transmission_angle": "may worsen to 89 deg"}
    found = client.post(f"{solved.path}/wish", json={"at": at}).json()
    assert (found["design"], found["objectives"], found["possible"], found["achievement"]) == (None, [], False, None)
    assert "89 deg or better, but the best on the front is" in found["sentences"][0]
