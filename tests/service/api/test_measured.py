"""Measured curves of a design over the API: the record of the command line."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from slidercrank.service.client import Client
from tests.service.api.fixed_front import Solved, client_of, served

DESIGN = 2
CSV = "crank_angle_deg;slider_position_mm;room\n0;400,5;20\n100;310,25;20\n200;150;20\n300;;20\n320;390;20\n"


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


@pytest.mark.parametrize("units", ["metric", "inch"])
def test_the_record_is_that_of_the_command_line(
    units: str, client: httpx.Client, solved: Solved, tmp_path: Path
) -> None:
    answer = client.post(f"{solved.path}/designs/{DESIGN}/measured", json={"csv": CSV}, params={"units": units})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert (found["job"], found["number"]) == (solved.number, DESIGN)
    file = tmp_path / "measured.csv"
    file.write_text(CSV)
    arguments = ["analyse", "latest", "--runs", str(solved.folder.parent), "--design", str(DESIGN), "--measured"]
    done = CliRunner().invoke(command_line, [*arguments, str(file), "--units", units, "--json"])
    expected = json.loads(done.stdout)["measured"]
    (curve,), (other,) = found["measured"].pop("curves").values(), expected.pop("curves").values()
    assert found["measured"] == expected
    assert (list(curve), curve["samples"]) == (list(other), 4)
    assert curve.pop("title") == other.pop("title")
    # The search of the service's worker ends at the same designs but for rounding.
    assert curve == pytest.approx(other, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"csv": ""}, "must begin with a line of column names; got an empty file"),
        ({"csv": "crank_angle_deg,torque_mm\n0,1\n"}, "torque must be a torque"),
        ({"csv": 5}, "csv"),
        ({}, "csv"),
        ({"csv": CSV, "file": "/etc/passwd"}, "file"),
    ],
)
def test_a_file_that_cannot_be_is_refused(
    body: dict[str, object], words: str, client: httpx.Client, solved: Solved
) -> None:
    answer = client.post(f"{solved.path}/designs/{DESIGN}/measured", json=body)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]


def test_a_large_file_and_a_design_that_is_not_there_are_refused(client: httpx.Client, solved: Solved) -> None:
    large = client.post(f"{solved.path}/designs/{DESIGN}/measured", json={"csv": CSV * 20_000})
    assert large.status_code == 413
    assert client.post(f"{solved.path}/designs/999/measured", json={"csv": CSV}).status_code == 404


def test_the_client_sends_a_file_or_its_text(solved: Solved, tmp_path: Path) -> None:
    file = tmp_path / "measured.csv"
    file.write_text(CSV, encoding="utf-8-sig")
    with served(solved.store) as address, Client(address) as client:
        assert client.measured(solved.number, DESIGN, file) == client.measured(solved.number, DESIGN, CSV)
