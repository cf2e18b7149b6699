"""Rounded neighbours of a design over the API: the record of the command line."""

from __future__ import annotations

import json
from collections.abc import Iterator

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from slidercrank.service.client import Client
from tests.service.api.fixed_front import Solved, client_of, served

DESIGN = 2
STEPS = ["0.5 mm", "rod=1 mm"]


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


@pytest.mark.parametrize("units", ["metric", "inch"])
def test_the_record_is_that_of_the_command_line(units: str, client: httpx.Client, solved: Solved) -> None:
    body = {"to": STEPS, "count": 3}
    answer = client.post(f"{solved.path}/designs/{DESIGN}/rounded", json=body, params={"units": units})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert (found["job"], found["number"]) == (solved.number, DESIGN)
    options = ["--runs", str(solved.folder.parent), "--count", "3", *(f"--to={step}" for step in STEPS)]
    done = CliRunner().invoke(command_line, ["round", "latest", str(DESIGN), *options, "--units", units, "--json"])
    expected = json.loads(done.stdout)
    assert list(found["rounded"]) == [key for key in expected if key not in ("run", "number")]
    for key in ("met", "message", "steps", "within_steps", "judged", "kept", "notes"):
        assert found["rounded"][key] == expected[key]
    # The search of the service's worker ends at the same designs but for rounding.
    for one, other in zip(found["rounded"]["designs"], expected["designs"], strict=True):
        for key, value in one.items():
            alike = pytest.approx(other[key], rel=1e-5, abs=1e-5) if isinstance(value, float) else other[key]
            assert value == alike, key


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"to": ["0.5"]}, "to must be a length with its unit"),
        ({"to": ["rood=1 mm"]}, "to is for crank, rod, offset"),
        ({"to": ["1 mm", "2 mm"]}, "got that of all lengths twice"),
        ({"to": []}, "to"),
        ({"to": ["1 mm"], "count": 0}, "count"),
        ({"to": "1 mm"}, "to"),
        ({}, "to"),
    ],
)
def test_wrong_steps_are_refused(body: dict[str, object], words: str, client: httpx.Client, solved: Solved) -> None:
    answer = client.post(f"{solved.path}/designs/{DESIGN}/rounded", json=body)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]


def test_a_design_that_is_not_there_is_refused(client: httpx.Client, solved: Solved) -> None:
    assert client.post(f"{solved.path}/designs/999/rounded", json={"to": STEPS}).status_code == 404


def test_the_client_gives_one_step_or_several(solved: Solved) -> None:
    with served(solved.store) as address, Client(address) as client:
        one = client.rounded(solved.number, DESIGN, "1 mm", count=1)
        assert one == client.rounded(solved.number, DESIGN, ["1 mm"], count=1)
        assert "crank_in" in client.rounded(solved.number, DESIGN, STEPS, units="inch")["given"]
