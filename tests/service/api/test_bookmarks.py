"""Kept designs over the API: their numbers, changes, one decision, the table, and refusals in a sentence."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from slidercrank.service.client import Client
from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service.api.fixed_front import Solved, client_of, served

LENGTHS = ("crank_mm", "rod_mm", "offset_mm")


@pytest.fixture(scope="module")
def store(solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Store]:
    """Return a copy of the store of the small job, to keep designs in."""
    path = tmp_path_factory.mktemp("kept") / "store.db"
    back_up(solved.store, path)
    with Store(path) as opened:
        yield opened


@pytest.fixture
def client(store: Store, solved: Solved) -> Iterator[httpx.Client]:
    with client_of(store) as opened:
        for one in opened.get(f"{solved.path}/kept").json()["designs"]:
            assert opened.delete(f"{solved.path}/kept/{one['number']}").status_code == 204
        yield opened


def bookmarked(client: httpx.Client, solved: Solved, **body: Any) -> dict[str, Any]:
    answer = client.post(f"{solved.path}/kept", json=body)
    assert answer.status_code == 201, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_a_kept_what_if_has_the_numbers_of_the_what_if(client: httpx.Client, solved: Solved) -> None:
    row = solved.result.designs[2]
    lengths: dict[str, Any] = {key: row[key] for key in LENGTHS} | {"rod_mm": 650.0}
    one = bookmarked(client, solved, design=3, dimensions={"rod_mm": 650.0}, name="Long", note="=1+1", star=True)
    expected = client.post(f"{solved.path}/designs/3/what-if", json={**lengths, "angles": 0}).json()
    assert (one["cells"], one["outside"], one["broken"]) == (expected["design"], ["rod_mm"], expected["broken"])
    assert (one["name"], one["note"], one["star"], one["design"], one["changed"]) == ("Long", "=1+1", True, 3, True)
    assert client.get(f"{solved.path}/kept").json()["designs"] == [one]


def test_a_design_of_the_front_and_one_of_dimensions_alone_are_kept(client: httpx.Client, solved: Solved) -> None:
    first = bookmarked(client, solved, design=2)
    assert (first["name"], first["changed"], first["broken"], first["outside"]) == ("Kept 1", False, [], [])
    dimensions = {key: first["cells"][key] for key in LENGTHS} | {"rod_mm": 650.0}
    second = bookmarked(client, solved, dimensions=dimensions)
    assert (second["design"], second["changed"], second["numbers"]) == (None, True, None)
    third = bookmarked(client, solved, design=2, dimensions={"rod_mm": 640.0})
    assert {key: second["cells"][key] for key in LENGTHS} == pytest.approx(dimensions, rel=1e-12)
    assert third["numbers"] == pytest.approx(dimensions | {"rod_mm": 640.0}, rel=1e-12)


def test_a_design_that_is_kept_twice_has_one_bookmark(client: httpx.Client, solved: Solved) -> None:
    first = bookmarked(client, solved, design=2, name="Stock", note="rod from stock", star=True)
    dimensions = {key: first["cells"][key] for key in LENGTHS}  # the design again, as a table gives it
    again = bookmarked(client, solved, dimensions=dimensions, decided=True, reason="least torque")
    expected = first | {"decided": True, "reason": "least torque", "decision": "Decided: Stock (least torque)"}
    assert again == expected
    other = bookmarked(client, solved, design=3, name="Longer", decided=True)
    assert client.get(f"{solved.path}/kept").json()["designs"] == [first | {"reason": "least torque"}, other]


def test_a_decision_names_the_requirements_that_the_design_misses(client: httpx.Client, solved: Solved) -> None:
    met = bookmarked(client, solved, design=2, name="Met", decided=True)
    assert met["decision"] == "Decided: Met"
    missed = bookmarked(
        client, solved, design=3, dimensions={"rod_mm": 650.0}, name="Long", decided=True, reason="stock"
    )
    assert missed["broken"] == ["stroke_mm"]
    assert missed["decision"] == "Decided: Long (stock); misses stroke; outside the job: rod"
    undecided = bookmarked(client, solved, design=4, dimensions={"rod_mm": 650.0})
    assert undecided["decision"] == ""


def test_an_allowed_deviation_stays_with_the_kept_design(client: httpx.Client, solved: Solved) -> None:
    path, dimensions = f"{solved.path}/designs/3", {"rod_mm": 640.0}
    lengths = {key: solved.result.designs[2][key] for key in LENGTHS} | dimensions
    missed = client.post(f"{path}/what-if", json={**lengths, "angles": 0}).json()
    amount = abs(missed["design"]["slack_stroke_mm"])
    assert (missed["broken"], missed["deviations"]) == (["stroke_mm"], [])
    allow = {"stroke_mm": round(amount * 1.01, 6)}
    allowed = client.post(f"{path}/what-if", json={**lengths, "angles": 0, "allow": allow}).json()
    assert (allowed["broken"], allowed["faults"], allowed["allowed"]) == ([], ["outside the job: rod"], allow)
    assert f"within the allowed ±{allow['stroke_mm']:.6g} mm" in allowed["deviations"][0]
    too_little = client.post(f"{path}/what-if", json={**lengths, "angles": 0, "allow": {"stroke_mm": 0.99 * amount}})
    assert too_little.json()["broken"] == ["stroke_mm"]
    one = bookmarked(client, solved, design=3, dimensions=dimensions, name="A", decided=True, allow=allow)
    assert (one["broken"], one["decision"]) == ([], "Decided: A; outside the job: rod")
    assert (one["deviations"], one["numbers"]["allow"]) == (
        allowed["deviations"],
        [f"stroke_mm={allow['stroke_mm']}"],
    )
    known = client.post(f"{path}/what-if", json={**lengths, "angles": 0}).json()
    assert known["deviations"] == allowed["deviations"]  # those of its bookmark
    report = client.get(f"{path}/report.html", params=one["numbers"]).text
    assert "All requirements are met; " in report
    assert "misses requirements" not in report
    wrong = client.post(f"{path}/what-if", json={**lengths, "allow": {"peak_torque_Nm": 1.0}})
    assert "only requirements of this job allow deviations" in wrong.json()["detail"]


def test_the_name_of_a_kept_design_is_in_its_files_its_answers_and_the_list(
    client: httpx.Client, solved: Solved
) -> None:
    path = f"{solved.path}/designs/3"
    assert client.get(f"{path}/requirements").json()["name"] == "design 3"
    before = client.get(f"{path}/linkage.svg")
    one = bookmarked(client, solved, design=3, dimensions={"rod_mm": 650.0}, name="Größe A", decided=True)
    query = {"angles": 0, **one["numbers"]}
    assert client.post(f"{path}/what-if", json=query).json()["name"] == "Größe A"
    assert client.post(f"{path}/what-if", json=query | {"rod_mm": 640.0}).json()["name"] == "design 3, changed"
    for file in ("linkage.svg", "motion.html", "report.html"):
        answer = client.get(f"{path}/{file}", params=one["numbers"])
        assert "Größe A" in answer.text
        assert "changed" not in answer.headers["content-disposition"]
        assert "grosse-a" in answer.headers["content-disposition"]
    assert client.get(f"{path}/linkage.svg").content == before.content
    sheet = client.get(f"{solved.path}/figures/design_3.svg", params=one["numbers"])
    assert "grosse-a-sheet" in sheet.headers["content-disposition"]
    assert client.get(solved.path).json()["decision"] == "Größe A"
    listed = {job["id"]: job["decision"] for job in client.get("/api/v1/jobs").json()["jobs"]}
    assert listed[solved.number] == "Größe A"
    client.patch(f"{solved.path}/kept/{one['number']}", json={"decided": False})
    assert client.get(solved.path).json()["decision"] is None


def test_at_most_one_is_decided_for_and_the_table_says_why(store: Store, client: httpx.Client, solved: Solved) -> None:
    with served(store) as address, Client(address) as opened:
        for design in (1, 2):
            opened.keep(solved.number, design, name=f"Design {design}", note="=cmd")
        opened.change_bookmark(solved.number, 1, decided=True, reason="most robust")
        changed = opened.change_bookmark(solved.number, 2, decided=True, reason="in stock", star=True)
        assert (changed["decided"], changed["star"], changed["name"]) == (True, True, "Design 2")
        assert [one["decided"] for one in opened.bookmarks(solved.number)] == [False, True]
        table = client.get(f"{solved.path}/kept.csv").text
        opened.delete_bookmark(solved.number, 1)
        assert [one["number"] for one in opened.bookmarks(solved.number)] == [2]
    rows = list(csv.DictReader(io.StringIO(table)))
    assert [row["reason"] for row in rows] == ["most robust", "in stock"]
    assert rows[0]["note"] == "'=cmd"
    assert float(rows[1]["time_ratio"]) == pytest.approx(solved.result.designs[1]["time_ratio"], rel=1e-9)


def test_notes_and_decisions_of_several_people_stay_in_the_history(client: httpx.Client, solved: Solved) -> None:
    first = bookmarked(client, solved, design=1, name="Short", note="fits", author="Anna", decided=True, reason="stiff")
    second = bookmarked(client, solved, design=2, name="Long")
    path = f"{solved.path}/kept"
    client.patch(f"{path}/{first['number']}", json={"note": "too heavy", "author": "Ben"})
    client.patch(f"{path}/{first['number']}", json={"note": "too heavy", "decided": True})  # as it was: no entry
    client.patch(f"{path}/{second['number']}", json={"decided": True, "reason": "light", "author": "Ben"})
    client.patch(f"{path}/{second['number']}", json={"reason": "lightest"})
    client.patch(f"{path}/{second['number']}", json={"decided": False, "author": "Anna"})
    expected = [
        (1, "Short", "note", "fits", "Anna"),
        (1, "Short", "decided", "stiff", "Anna"),
        (1, "Short", "note", "too heavy", "Ben"),
        (2, "Long", "decided", "light", "Ben"),
        (2, "Long", "decided", "lightest", ""),
        (2, "Long", "withdrawn", "", "Anna"),
    ]

    def history() -> list[tuple[Any, ...]]:
        entries = client.get(path).json()["history"][-len(expected) :]
        return [tuple(entry[key] for key in ("bookmark", "name", "action", "text", "author")) for entry in entries]

    assert history() == expected
    table = csv.DictReader(io.StringIO(client.get(f"{path}.csv").text))
    assert [(row["design"], row["note"]) for row in table] == [("1", "Anna: fits; Ben: too heavy"), ("2", "")]
    assert client.delete(f"{path}/1", params={"author": "Ben"}).status_code == 204
    detached = [(None, *entry[1:]) if entry[0] == 1 else entry for entry in expected[1:]]
    assert history() == [*detached, (None, "Short", "deleted", "", "Ben")]


@pytest.mark.parametrize(
    ("body", "status", "words"),
    [
        ({}, 422, "got neither"),
        ({"design": 99}, 404, "got 99"),
        ({"design": 1, "dimensions": {"width": 3.0}}, 422, "got 'width'"),
        ({"design": 1, "dimensions": {"rod_mm": -3.0}}, 422, "rod_mm must be at least"),
        ({"design": 1, "dimensions": {"rod_mm": "long"}}, 422, "rod_mm must be a number"),
        ({"design": 1, "dimensions": {"rod_mm": 10.0}}, 422, "full rotation"),
        ({"dimensions": {"rod_mm": 300.0}}, 422, "got none for crank_mm, offset_mm"),
        ({"design": 1, "name": "x" * 201}, 422, "name"),
    ],
)
def test_what_cannot_be_kept_is_refused(
    client: httpx.Client, solved: Solved, body: dict[str, Any], status: int, words: str
) -> None:
    answer = client.post(f"{solved.path}/kept", json=body)
    assert (answer.status_code, words in answer.text) == (status, True), answer.text
    assert client.get(f"{solved.path}/kept").json()["designs"] == []


def test_a_kept_design_that_is_gone_is_not_found(client: httpx.Client, solved: Solved) -> None:
    for answer in (
        client.patch(f"{solved.path}/kept/5", json={"star": True}),
        client.delete(f"{solved.path}/kept/5"),
        client.get("/api/v1/jobs/99/kept"),
    ):
        assert answer.status_code == 404, answer.text
    bookmarked(client, solved, design=1)
    assert client.patch(f"{solved.path}/kept/1", json={"name": ""}).status_code == 422
    assert client.patch(f"{solved.path}/kept/1", json={"colour": "red"}).status_code == 422
