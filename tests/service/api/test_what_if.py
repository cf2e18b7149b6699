"""Context of a design, and the effect of other lengths."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest

from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.optimise.job import load_job
from slidercrank.service.designs.changed_design import judged_variation
from slidercrank.service.designs.design_selection_options import minimised_values
from slidercrank.service.designs.stored_designs import design_of_row
from tests.service.api.fixed_front import Solved, client_of


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


def lengths(solved: Solved, design: int, **factors: float) -> dict[str, float]:
    """The lengths of a design, some of them by a factor longer."""
    row = solved.result.designs[design - 1]
    return {name: float(row[name] or 0.0) * factors.get(name, 1.0) for name in ("crank_mm", "rod_mm", "offset_mm")}


def change(client: httpx.Client, solved: Solved, body: dict[str, Any], design: int = 3) -> httpx.Response:
    return client.post(f"{solved.path}/designs/{design}/what-if", json=body)


def test_requirements_are_those_of_the_job(client: httpx.Client, solved: Solved) -> None:
    given = client.get(f"{solved.path}/designs/3/requirements").json()
    assert given["ranges"] == {"crank_mm": [20.0, 200.0], "rod_mm": [60.0, 600.0], "offset_mm": [0.0, 200.0]}
    assert given["speed_rpm"] == pytest.approx(300.0)
    assert given["tolerances"] is False
    assert given["names"]["least_transmission_angle_deg"] == "transmission_angle"
    asked = {item["quantity"]: item for item in given["requirements"]}
    assert (asked["stroke"]["lower"], asked["stroke"]["upper"]) == pytest.approx((280.0, 280.0))
    assert asked["transmission_angle"]["lower"] == pytest.approx(40.0)
    assert asked["transmission_angle"]["upper"] is None
    design = client.get(f"{solved.path}/designs/3").json()["design"]
    assert {item["slack"] for item in asked.values()} == {key for key in design if key.startswith("slack_")}


def test_a_change_of_nothing_gives_the_design_as_it_is_stored(client: httpx.Client, solved: Solved) -> None:
    answer = change(client, solved, lengths(solved, 3)).json()
    stored = client.get(f"{solved.path}/designs/3").json()["design"]
    assert answer["design"] == {key: value for key, value in stored.items() if key not in ("residual", "status")}
    assert (answer["broken"], answer["outside"], answer["dominated_by"], answer["dominates"]) == ([], [], [], [])
    curves = client.get(f"{solved.path}/designs/3/curves", params={"angles": 180}).json()
    assert answer["cycle"]["curves"] == curves["curves"]


def test_a_change_is_analysed_as_python_does(client: httpx.Client, solved: Solved) -> None:
    body = lengths(solved, 3, crank_mm=0.97, rod_mm=1.05)
    answer = change(client, solved, body).json()
    given = np.array([[body["crank_mm"] / 1e3, body["rod_mm"] / 1e3, body["offset_mm"] / 1e3]])
    own = analyse(load_job(solved.job).mechanism, given).iloc[0]
    for key in own.index:
        value = answer["design"][key]
        assert value == own[key] or value is None, key
    assert answer["broken"] == ["stroke_mm"]
    assert answer["design"]["slack_stroke_mm"] == pytest.approx(-abs(own["stroke_mm"] - 280.0))


def test_designs_that_beat_a_change_are_named(client: httpx.Client, solved: Solved) -> None:
    body = lengths(solved, 3, rod_mm=0.9)
    answer = change(client, solved, {**body, "angles": 0}).json()
    own = answer["design"]
    better = [
        number
        for number, row in enumerate(solved.result.designs, 1)
        if float(row["time_ratio"] or 0) >= own["time_ratio"]
        and float(row["least_transmission_angle_deg"] or 0) >= own["least_transmission_angle_deg"]
    ]
    assert sorted(answer["dominated_by"]) == better
    assert answer["dominated_by_count"] == len(better)
    assert answer["cycle"] is None


def test_designs_that_a_change_beats_are_named(solved: Solved) -> None:
    result = solved.result
    design = design_of_row(load_job(solved.job), result.designs[2])
    worse = minimised_values(result) + 1e3 * np.arange(1.0, 1.0 + len(result.designs))[:, None]
    found = judged_variation(design, result, worse)
    assert sorted(found.dominates) == list(range(len(result.designs)))
    assert found.dominates[0] == len(result.designs) - 1  # the one that is worst by far
    assert found.dominated_by == []


def test_lengths_beyond_their_ranges_are_named(client: httpx.Client, solved: Solved) -> None:
    answer = change(client, solved, lengths(solved, 3, rod_mm=10.0)).json()
    assert answer["outside"] == ["rod_mm"]


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ({"crank_mm": 60, "rod_mm": 64, "offset_mm": 20}, "rod must exceed crank + |offset| for full rotation"),
        ({"crank_mm": 60, "rod_mm": 64, "offset_mm": 900}, "or the linkage cannot close"),
        ({"crank_mm": 0, "rod_mm": 64, "offset_mm": 20}, "crank_mm: must be at least 0.0001"),
        ({"crank_mm": 40, "rod_mm": 64}, "offset_mm: is missing, but required"),
        ({"crank_mm": 40, "rod_mm": 64, "offset_mm": 0, "angles": 2}, "curves must have 4 to 3600 crank angles"),
        ({"crank_mm": 40, "rod_mm": 64, "offset_mm": 0, "speed": 3}, "speed: unknown"),
    ],
)
def test_a_wrong_change_is_refused_with_a_sentence(
    client: httpx.Client, solved: Solved, body: dict[str, Any], sentence: str
) -> None:
    refused = change(client, solved, body)
    assert refused.status_code == 422
    assert sentence in refused.json()["detail"]


@pytest.mark.parametrize("place", ["requirements", "trade-offs"])
def test_what_surrounds_no_design_is_not_there(client: httpx.Client, solved: Solved, place: str) -> None:
    missing = client.get(f"{solved.path}/designs/99/{place}")
    assert missing.status_code == 404
    assert "has designs 1 to" in missing.json()["detail"]


def test_trade_offs_at_the_knee_are_those_that_the_search_found(client: httpx.Client, solved: Solved) -> None:
    assert solved.result.knee is not None
    given = client.get(f"{solved.path}/designs/{solved.result.knee + 1}/trade-offs").json()
    assert given["trade_offs"] == solved.result.trade_offs
    assert given["note"] == ""


def test_trade_offs_are_known_at_every_design(client: httpx.Client, solved: Solved) -> None:
    for number in range(1, len(solved.result.designs) + 1):
        given = client.get(f"{solved.path}/designs/{number}/trade-offs").json()
        assert given["note"] == "", number
        assert all("costs" in said or said.startswith("no design on the front") for said in given["trade_offs"])


@pytest.mark.parametrize("moved", ["crank", "rod", "offset"])
def test_other_lengths_follow_to_keep_a_stroke(client: httpx.Client, solved: Solved, moved: str) -> None:
    body = lengths(solved, 3, **{f"{moved}_mm": 0.98})
    answer = change(client, solved, {**body, "hold": moved}).json()
    assert answer["design"][f"{moved}_mm"] == pytest.approx(body[f"{moved}_mm"], rel=1e-15)
    assert answer["design"]["stroke_mm"] == pytest.approx(280.0, rel=1e-11)
    assert "stroke_mm" not in answer["broken"]


def test_a_length_that_no_others_can_follow_is_refused(client: httpx.Client, solved: Solved) -> None:
    refused = change(client, solved, {"crank_mm": 200.0, "rod_mm": 600.0, "offset_mm": 0.0, "hold": "crank"})
    assert refused.status_code == 422
    assert (
        "rod and offset must change so that stroke exactly 280 mm still holds; no design was found with crank 200 mm"
        in refused.json()["detail"]
    )


def test_a_length_stops_where_no_others_can_follow_if_the_nearest_is_asked_for(
    client: httpx.Client, solved: Solved
) -> None:
    """A stroke is at least twice the crank, and just that without an offset: 140 mm for 280 mm."""
    beyond = {"crank_mm": 200.0, "rod_mm": 600.0, "offset_mm": 0.0, "hold": "crank", "nearest": True}
    design = change(client, solved, beyond).json()["design"]
    assert design["crank_mm"] == pytest.approx(140.0, rel=2e-3)
    assert design["crank_mm"] <= 140.0 * (1.0 + 1e-9)
    assert design["stroke_mm"] == pytest.approx(280.0, rel=1e-11)
    held = {**lengths(solved, 3, crank_mm=0.98), "hold": "crank"}
    assert change(client, solved, {**held, "nearest": True}).json() == change(client, solved, held).json()
