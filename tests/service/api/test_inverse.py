"""Crank angles of a design for a slider position over the API: the record of the command line."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import load_job
from slidercrank.service.cli import app as command_line
from slidercrank.service.designs.stored_designs import design_of_row
from tests.service.api.fixed_front import Solved, client_of

DESIGN = 3


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


@pytest.fixture(scope="module")
def linkage(solved: Solved) -> Linkage:
    """Return the linkage of the design that is asked for."""
    return design_of_row(load_job(solved.job), solved.result.designs[DESIGN - 1]).linkage


def ask(client: httpx.Client, solved: Solved, **query: Any) -> httpx.Response:
    return client.get(f"{solved.path}/designs/{DESIGN}/inverse", params=query)


@pytest.mark.parametrize("units", ["metric", "inch"])
def test_the_record_is_that_of_the_command_line(
    units: str, client: httpx.Client, solved: Solved, linkage: Linkage
) -> None:
    position = 1e3 * float(linkage.dead_centres[0] + 0.3 * linkage.stroke)
    query = {"slider_position_mm": position, "slider_velocity_m_s": -1.5, "slider_acceleration_m_s2": 4.0}
    found = ask(client, solved, **query, units=units).json()
    assert (found["job"], found["number"]) == (solved.number, DESIGN)
    arguments = ["inverse", "latest", "--runs", str(solved.folder.parent), "--design", str(DESIGN)]
    arguments += [f"--slider-position={position!r} mm", "--slider-velocity=-1.5 m/s", "--slider-acceleration=4 m/s^2"]
    done = CliRunner().invoke(command_line, [*arguments, "--units", units, "--json"])
    expected = json.loads(done.stdout)
    assert list(found["inverse"]) == list(expected)
    solutions = zip(found["inverse"].pop("solutions"), expected.pop("solutions"), strict=True)
    assert found["inverse"].pop("branch") == expected.pop("branch") == "open"
    assert found["inverse"].pop("note") == expected.pop("note") == ""
    assert found["inverse"] == pytest.approx(expected, rel=1e-9)
    for one, other in solutions:
        assert one.pop("stroke") == other.pop("stroke")
        assert one == pytest.approx(other, rel=1e-9)


def test_every_solution_gives_the_slider_motion_back(client: httpx.Client, solved: Solved, linkage: Linkage) -> None:
    position = float(linkage.dead_centres[0] + 0.6 * linkage.stroke)
    record = ask(client, solved, slider_position_mm=1e3 * position, slider_velocity_m_s=0.7).json()["inverse"]
    assert [solution["stroke"] for solution in record["solutions"]] == ["outward", "inward"]
    for solution in record["solutions"]:
        speed = solution["crank_speed_rpm"] * math.pi / 30.0
        at = linkage.at(math.radians(solution["crank_angle_deg"]), speed=speed)
        assert at.slider_position == pytest.approx(position, rel=1e-9)
        assert at.slider_velocity == pytest.approx(0.7, rel=1e-9)
        assert solution["crank_acceleration_rad_s2"] is None


@pytest.mark.parametrize(
    ("query", "words"),
    [
        ({"slider_position_mm": 5000.0}, "the slider position must be within reach of the open branch"),
        ({"slider_position_mm": 100.0, "slider_acceleration_m_s2": 1.0}, "got acceleration 1 m/s^2 alone"),
        ({}, "slider_position_mm"),
        ({"slider_position_mm": "nan"}, "slider_position_mm"),
        ({"slider_position_mm": "240 mm"}, "slider_position_mm"),
        ({"slider_position_mm": 100.0, "slider_velocity_m_s": "inf"}, "slider_velocity_m_s"),
    ],
)
def test_a_wrong_motion_is_refused(query: dict[str, Any], words: str, client: httpx.Client, solved: Solved) -> None:
    answer = ask(client, solved, **query)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]


def test_a_design_that_is_not_there_is_not_found(client: httpx.Client, solved: Solved) -> None:
    answer = client.get(f"{solved.path}/designs/999/inverse", params={"slider_position_mm": 200.0})
    assert answer.status_code == 404


def test_the_description_says_what_must_be_given(client: httpx.Client) -> None:
    described = client.get("/api/v1/openapi.json").json()
    operation = described["paths"]["/api/v1/jobs/{number}/designs/{design}/inverse"]["get"]
    assert operation["operationId"] == "find_crank_angles"
    named = {parameter["name"]: parameter["required"] for parameter in operation["parameters"]}
    assert named["slider_position_mm"] is True
    assert named["slider_velocity_m_s"] is False
