"""Topics of a design over the API: those of the command line, each by its name, also with other lengths."""

from __future__ import annotations

import json
from collections.abc import Iterator

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from slidercrank.service.questions.discovery import TOPICS
from tests.service.api.fixed_front import API, Solved, client_of

QUICK = ("motor", "balance", "friction", "extremes", "flywheel", "static_forces")


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


def printed_numbers(solved: Solved, name: str, *options: str) -> str:
    place = ["--runs", str(solved.folder.parent), "--design", "2"]
    done = CliRunner().invoke(command_line, ["analyse", "latest", *place, "--show", name, *options])
    assert done.exit_code == 0, done.stderr
    return done.stdout


def test_the_list_has_every_topic_in_the_order_of_the_command_line(client: httpx.Client) -> None:
    listed = client.get(f"{API}/topics").json()["topics"]
    assert [(one["name"], one["shows"]) for one in listed] == [(of.name, of.shows) for of in TOPICS.values()]


@pytest.mark.parametrize("name", QUICK)
def test_numbers_and_text_are_those_of_the_command_line(client: httpx.Client, solved: Solved, name: str) -> None:
    answer = client.get(f"{solved.path}/designs/2/topics/{name}")
    assert answer.status_code == 200, answer.text
    found = answer.json()
    expected = json.loads(printed_numbers(solved, name, "--json"))[name]
    assert found["numbers"].keys() == expected.keys()
    for key, value in expected.items():
        alike = pytest.approx(value, rel=1e-5, abs=1e-5) if isinstance(value, float) else value
        if not isinstance(value, dict | list):
            assert found["numbers"][key] == alike, key
    text = " ".join(printed_numbers(solved, name).split())
    assert found["told"]
    for block in found["told"]:
        assert block["sentence"] in text
        for row in block["rows"]:
            assert len(row) == len(block["heads"]) == len(block["right"])
            assert all(word in text for word in " ".join(row[:1]).split())


def test_text_in_inches_names_the_unit_of_every_column_and_remark(client: httpx.Client, solved: Solved) -> None:
    topics = f"{solved.path}/designs/2/topics"
    forces = client.get(f"{topics}/static_forces", params={"units": "inch"}).json()["told"][1]
    assert forces["heads"][:5] == [
        "crank angle, deg",
        "load, lbf",
        "rod force, lbf",
        "guide, lbf",
        "crank torque, lbf in",
    ]
    friction = client.get(f"{topics}/friction", params={"units": "inch"}).json()["told"][1]
    mean = next(row for row in friction["rows"] if row[0] == "mean torque")
    assert mean[3] == f"over the crank angle, {mean[1]} lbf in without friction"  # this machine has none


def test_other_lengths_have_topics_of_their_own(client: httpx.Client, solved: Solved) -> None:
    row = solved.result.designs[1]
    lengths = {key: float(str(row[key])) for key in ("crank_mm", "rod_mm", "offset_mm")} | {"rod_mm": 590.0}
    changed = client.get(f"{solved.path}/designs/2/topics/motor", params=lengths).json()["numbers"]
    own = client.get(f"{solved.path}/designs/2/topics/motor").json()["numbers"]
    body = {**lengths, "angles": 0}
    expected = client.post(f"{solved.path}/designs/2/what-if", json=body).json()["design"]["peak_torque_Nm"]
    assert changed["peak_torque_Nm"] == pytest.approx(expected, rel=1e-9)
    assert abs(own["peak_torque_Nm"] - expected) > 1e-3 * expected


def test_figures_are_drawn_by_name(client: httpx.Client, solved: Solved) -> None:
    path = f"{solved.path}/designs/2/topics/motor"
    assert client.get(f"{path}.svg").content.lstrip().startswith(b"<?xml")
    assert client.get(f"{path}.png").content.startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("name", "status", "sentence"),
    [
        ("engine", 404, "there is no topic 'engine'; choose from"),
        ("start_up", 422, "[drive]"),
        ("clearance", 422, ""),
        ("strength", 422, "material and pins"),
    ],
)
def test_what_a_design_does_not_have_is_refused_in_a_sentence(
    client: httpx.Client, solved: Solved, name: str, status: int, sentence: str
) -> None:
    for ending in ("", ".svg"):
        answer = client.get(f"{solved.path}/designs/2/topics/{name}{ending}")
        assert answer.status_code == status
        assert sentence in answer.json()["detail"]
