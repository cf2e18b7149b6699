"""Rounded neighbours of a design over the API: the record of the command line."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from threading import Event

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.optimise.front.rounding_search import RoundingSearch, Stage
from slidercrank.service.cli import app as command_line
from slidercrank.service.client import Client
from tests.service.api.fixed_front import Solved, client_of, served

DESIGN = 2
STEPS = ["0.5 mm", "rod=1 mm"]
ALLOW = ["stroke=0.1 mm"]
STREAM = {"Accept": "text/event-stream"}


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


@pytest.mark.parametrize("units", ["metric", "inch"])
def test_the_record_is_that_of_the_command_line(units: str, client: httpx.Client, solved: Solved) -> None:
    body = {"to": STEPS, "allow": ALLOW, "count": 3}
    answer = client.post(f"{solved.path}/designs/{DESIGN}/rounded", json=body, params={"units": units})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert (found["job"], found["number"]) == (solved.number, DESIGN)
    options = ["--runs", str(solved.folder.parent), "--count", "3", *(f"--to={step}" for step in STEPS)]
    options += [f"--allow={text}" for text in ALLOW]
    done = CliRunner().invoke(command_line, ["round", "latest", str(DESIGN), *options, "--units", units, "--json"])
    expected = json.loads(done.stdout)
    assert list(found["rounded"]) == [key for key in expected if key not in ("run", "number")]
    for key in ("met", "message", "steps", "within_steps", "judged", "kept", "notes"):
        assert found["rounded"][key] == expected[key]
    # The search of the service's worker ends at the same designs but for rounding.
    for one, other in zip(found["rounded"]["designs"], expected["designs"], strict=True):
        for key, value in one.items():
            if key == "misses":
                value, other[key] = value[0], other[key][0]
                assert value.pop("amount") == pytest.approx(other[key].pop("amount"), abs=1e-5)
                assert value["allowed"] > 0.0
            alike = pytest.approx(other[key], rel=1e-5, abs=1e-5) if isinstance(value, float) else other[key]
            assert value == alike, key


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"to": ["0.5"]}, "to must be a length with its unit"),
        ({"to": ["rood=1 mm"]}, "to must name crank, rod, offset"),
        ({"to": ["1 mm", "2 mm"]}, "got that of all lengths twice"),
        ({"to": []}, "body to: must have at least 1 entries; got []"),
        ({"to": [""]}, 'to must be STEP or NAME=STEP; got ""; write it like'),
        ({"to": ["1 mm"], "count": 0}, "body count: must be at least 1; got 0"),
        ({"to": ["1 mm"], "allow": ["stroke=1 %"]}, 'must be a length, not a percentage; got "1 %"; write "'),
        ({"to": ["1 mm"], "allow": ["strok=0.1 mm"]}, "name one of them"),
        ({"to": ["1 mm"], "allow": ["stroke=0.1"]}, "the allowed deviation of stroke must be a length with its unit"),
        ({"to": ["1 mm"], "allow": ["0.1 mm"]}, "allow must be REQUIREMENT=AMOUNT"),
        ({"to": "1 mm"}, "to"),
        ({}, "to"),
    ],
)
def test_wrong_steps_are_refused(body: dict[str, object], words: str, client: httpx.Client, solved: Solved) -> None:
    for headers in ({}, STREAM):
        answer = client.post(f"{solved.path}/designs/{DESIGN}/rounded", json=body, headers=headers)
        assert answer.status_code == 422
        assert words in answer.json()["detail"]


def test_progress_is_streamed_before_the_answer(client: httpx.Client, solved: Solved) -> None:
    path, body = f"{solved.path}/designs/{DESIGN}/rounded", {"to": STEPS}
    events = []
    with client.stream("POST", path, json=body, headers=STREAM) as answer:
        assert answer.headers["content-type"].startswith("text/event-stream")
        for text in "".join(answer.iter_text()).split("\n\n"):
            if text:
                kind, _, data = text.partition("\n")
                events.append((kind.removeprefix("event: "), json.loads(data.removeprefix("data: "))))
    *progress, (last, found) = events
    assert last == "rounded"
    assert found == client.post(path, json=body).json()
    assert len(progress) >= 2
    for kind, at in progress:
        assert kind == "progress"
        assert list(at) == ["stage", "step", "steps"]
        assert 0 <= at["step"] < at["steps"]


def test_a_closed_connection_ends_the_search(
    client: httpx.Client, solved: Solved, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended, path = Event(), f"{solved.path}/designs/{DESIGN}/rounded"

    def endless(self: RoundingSearch, count: int) -> Iterator[Stage]:
        try:
            while True:
                time.sleep(0.01)
                yield Stage("screening combinations", count, 10)
        finally:
            ended.set()

    with monkeypatch.context() as patch:
        patch.setattr(RoundingSearch, "best_designs", endless)
        with client.stream("POST", path, json={"to": STEPS}, headers=STREAM) as answer:
            next(answer.iter_bytes())
            assert not ended.is_set()
        assert ended.wait(10.0)
    assert client.post(path, json={"to": STEPS}).status_code == 200  # the turn is free again


def test_a_design_that_is_not_there_is_refused(client: httpx.Client, solved: Solved) -> None:
    assert client.post(f"{solved.path}/designs/999/rounded", json={"to": STEPS}).status_code == 404


def test_the_client_gives_one_step_or_several(solved: Solved) -> None:
    with served(solved.store) as address, Client(address) as client:
        one = client.rounded(solved.number, DESIGN, "1 mm", count=1)
        assert one == client.rounded(solved.number, DESIGN, ["1 mm"], count=1)
        (miss,) = client.rounded(solved.number, DESIGN, "1 mm", allow="stroke=1 mm", count=1)["designs"][0]["misses"]
        assert 0.0 < miss["amount"] <= miss["allowed"] == 1.0
        assert "crank_in" in client.rounded(solved.number, DESIGN, STEPS, units="inch")["given"]
