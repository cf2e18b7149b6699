"""Designs of a front with other numbers than lengths: rounded, changed, drawn and kept with them."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest

from slidercrank.optimise.job import parse_job
from slidercrank.service.designs.stored_designs import design_of_row
from tests.service import fronts
from tests.service.api.fixed_front import API, client_of, varied_in

DESIGN = 2


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[httpx.Client, str]]:
    """Return a client of a service with a job whose rod varies in width, and the path of the job."""
    with varied_in(tmp_path_factory.mktemp("varied")) as (store, number), client_of(store) as client:
        yield client, f"{API}/jobs/{number}"


@pytest.fixture(scope="module")
def rounded(asked: tuple[httpx.Client, str]) -> dict[str, Any]:
    """Return the best design with a round width."""
    client, path = asked
    body = {"to": ["0.5 mm", "rod_width_mm=1 mm"], "allow": ["stroke=0.1 mm"], "count": 1}
    found: dict[str, Any] = client.post(f"{path}/designs/{DESIGN}/rounded", json=body).json()["rounded"]
    assert found["met"]
    return dict(found["designs"][0])


def lengths(row: dict[str, Any]) -> dict[str, Any]:
    return {key: row[key] for key in ("crank_mm", "rod_mm", "offset_mm")}


def test_a_width_is_rounded_and_its_range_is_given(asked: tuple[httpx.Client, str], rounded: dict[str, Any]) -> None:
    client, path = asked
    ranges = client.get(f"{path}/designs/{DESIGN}/requirements").json()["ranges"]
    assert list(ranges) == ["crank_mm", "rod_mm", "offset_mm", "rod_width_mm"]
    assert ranges["rod_width_mm"] == pytest.approx([20.0, 40.0])
    assert rounded["rod_width_mm"] % 1.0 == 0.0


def test_what_if_takes_a_rounded_width(asked: tuple[httpx.Client, str], rounded: dict[str, Any]) -> None:
    client, path = asked
    body = {**lengths(rounded), "values": {"rod_width_mm": rounded["rod_width_mm"] + 3.0}, "angles": 0}
    found = client.post(f"{path}/designs/{DESIGN}/what-if", json=body).json()["design"]
    row = {**client.get(f"{path}/designs/{DESIGN}").json()["design"], **lengths(rounded), **body["values"]}
    own = design_of_row(parse_job(tomllib.loads(fronts.VARIED)), row)
    (torque,) = own.part.evaluate(np.array([own.values]), ["peak_torque"])[0]
    assert found["rod_width_mm"] == body["values"]["rod_width_mm"]
    assert found["peak_torque_Nm"] == pytest.approx(torque, rel=1e-9)
    assert found["peak_torque_Nm"] != pytest.approx(rounded["peak_torque_Nm"], rel=1e-4)


def test_files_and_topics_take_a_width(asked: tuple[httpx.Client, str], rounded: dict[str, Any]) -> None:
    client, path = asked
    design, answers = f"{path}/designs/{DESIGN}", []
    for width in (rounded["rod_width_mm"], rounded["rod_width_mm"] + 3.0):
        query = {**lengths(rounded), "value": [f"rod_width_mm={width}"]}
        file = client.get(f"{design}/cycle.csv", params=query)
        assert "changed" in file.headers["content-disposition"]
        topic = client.get(f"{design}/topics/balance", params=query)
        assert (file.status_code, topic.status_code) == (200, 200), topic.text
        answers.append((file.text, topic.json()))
    assert answers[0][0] != answers[1][0]
    assert answers[0][1] != answers[1][1]
    own = client.get(design).json()["design"]
    same = client.get(f"{design}/cycle.csv", params={"value": [f"rod_width_mm={own['rod_width_mm']}"]})
    assert "changed" not in same.headers["content-disposition"]


def test_a_rounded_width_is_kept(asked: tuple[httpx.Client, str], rounded: dict[str, Any]) -> None:
    client, path = asked
    numbers = {**lengths(rounded), "rod_width_mm": rounded["rod_width_mm"]}
    kept = client.post(f"{path}/kept", json={"design": DESIGN, "dimensions": numbers})
    assert kept.status_code == 201, kept.text
    assert {key: kept.json()["cells"][key] for key in numbers} == pytest.approx(numbers)
    wrong = client.post(f"{path}/kept", json={"design": DESIGN, "dimensions": {"rod_width_mm": 300.0}})
    assert wrong.status_code == 422
    assert "rod width must be within its range, 20 to 40 mm; got 300" in wrong.json()["detail"]


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("rod_width_mm=300", "rod width must be within its range, 20 to 40 mm; got 300"),
        ("rod_width_mm", "a value must be COLUMN=NUMBER; got 'rod_width_mm'"),
        ("rod_width_mm=wide", "a value must be COLUMN=NUMBER; got"),
        ("rod_width_mm=nan", "a value must be COLUMN=NUMBER; got"),
        ("status=1", "only variables of this job may have other values: rod_width_mm; got 'status'"),
        ("slider_mass_kg=1", "only variables of this job may have other values"),
    ],
)
def test_a_wrong_value_is_refused(value: str, words: str, asked: tuple[httpx.Client, str]) -> None:
    client, path = asked
    answer = client.get(f"{path}/designs/{DESIGN}/linkage.svg", params={"value": [value]})
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
