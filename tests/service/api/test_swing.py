"""A swing of a design over the API and the client: the record of the command line."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from tests.service.api.fixed_front import Solved, client_of

DESIGN = 2


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


def ask(client: httpx.Client, solved: Solved, **query: Any) -> httpx.Response:
    return client.get(f"{solved.path}/designs/{DESIGN}/swing", params=query)


@pytest.mark.parametrize("units", ["metric", "inch"])
def test_the_record_is_that_of_the_command_line(units: str, client: httpx.Client, solved: Solved) -> None:
    given = {"driver": "slider", "law": "cycloidal", "duration_s": 2.0, "actuator_tolerance_mm": 0.5}
    found = ask(client, solved, start_deg=40.0, end_deg=110.0, **given, units=units).json()
    assert (found["job"], found["number"]) == (solved.number, DESIGN)
    arguments = ["swing", "latest", "--runs", str(solved.folder.parent), "--design", str(DESIGN), "--driver", "slider"]
    arguments += ["--from", "40 deg", "--to", "110 deg", "--law", "cycloidal", "--duration", "2 s"]
    done = CliRunner().invoke(command_line, [*arguments, "--actuator-tolerance", "0.5 mm", "--units", units, "--json"])
    expected = json.loads(done.stdout)
    for own, told in ((found["swing"], expected), *paired(found["swing"].pop("extremes"), expected.pop("extremes"))):
        assert list(own) == list(told)
        for key, value in told.items():
            # Where a curve is flat, its extreme is found to a rounding of the lengths that JSON keeps.
            same = (
                pytest.approx(value, rel=1e-6, abs=1e-4 if "_at_" in key else 1e-6)
                if isinstance(value, float)
                else value
            )
            assert own[key] == same, key


def paired(one: dict[str, Any], other: dict[str, Any]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    assert list(one) == list(other)
    return list(zip(one.values(), other.values(), strict=True))


def test_two_places_of_the_slider_are_the_swing_between_their_angles(client: httpx.Client, solved: Solved) -> None:
    by_angles = ask(client, solved, start_deg=40.0, end_deg=110.0, driver="slider").json()["swing"]
    ends = [by_angles[f"{end}_slider_position_mm"] for end in ("start", "end")]
    places = {"slider_start_mm": ends[0], "slider_end_mm": ends[1], "driver": "slider"}
    found = ask(client, solved, **places).json()["swing"]
    for key in ("swing_angle_deg", "start_crank_angle_deg", "peak_drive_N", "energy_forth_J"):
        assert found[key] == pytest.approx(by_angles[key], rel=1e-6), key
    other = ask(client, solved, **places, crank_side="right").json()["swing"]
    assert other["start_slider_position_mm"] == pytest.approx(ends[0])
    assert other["start_crank_angle_deg"] < 0.0


@pytest.mark.parametrize(
    ("query", "status", "words"),
    [
        ({"start_deg": 40.0, "end_deg": 40.0}, 422, "less than a turn apart"),
        ({"start_deg": -40.0, "end_deg": 100.0, "driver": "slider"}, 422, "dead point"),
        ({"start_deg": 40.0, "end_deg": 100.0, "law": "harmonic"}, 422, "any other swing must have one"),
        ({"start_deg": "nan", "end_deg": 100.0}, 422, "start_deg"),
        ({"start_deg": 40.0, "end_deg": 100.0, "driver": "rod"}, 422, "driver"),
        ({"start_deg": 40.0}, 422, "got no end_deg"),
        ({}, 422, "got no start_deg"),
        (
            {"start_deg": 40.0, "slider_end_mm": 100.0},
            422,
            "got start_deg, slider_end_mm; give only one of these pairs",
        ),
        ({"slider_start_mm": 100.0, "slider_end_mm": 1e5}, 422, "must reach both ends"),
        ({"start_deg": 40.0, "end_deg": 100.0, "law": "table", "duration_s": 1.0}, 422, "got law table"),
    ],
)
def test_wrong_input_is_a_problem(
    query: dict[str, Any], status: int, words: str, client: httpx.Client, solved: Solved
) -> None:
    answer = ask(client, solved, **query)
    assert answer.status_code == status
    assert words in answer.text
