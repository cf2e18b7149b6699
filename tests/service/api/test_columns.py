"""Columns of a front over the API: those of the designs, whole."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator

import httpx
import pytest

from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import Solved, client_of, store_result
from tests.service.api.serving import refusal_sentence
from tests.service.store.contents import add, result


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    """Return a client of its service."""
    with client_of(solved.store) as found:
        yield found


def test_columns_are_those_of_the_designs_bit_for_bit(solved: Solved, client: httpx.Client) -> None:
    designs = client.get(f"{solved.path}/designs").json()
    for accepted in ("identity", "gzip"):
        answer = client.get(f"{solved.path}/columns", headers={"Accept-Encoding": accepted})
        found = answer.json()
        assert found["columns"] == designs["columns"]
        assert found["count"] == 8
        values = found["values"]
        rows = [{key: values[key][row] for key in values} for row in range(8)]
        assert rows == designs["designs"]


def test_some_columns_are_asked_for_by_quantity_or_key(solved: Solved, client: httpx.Client) -> None:
    found = client.get(f"{solved.path}/columns", params={"columns": "rod, peak_torque_Nm,rod"}).json()
    assert list(found["values"]) == ["rod_mm", "peak_torque_Nm"]
    assert [column["unit"] for column in found["columns"]] == ["mm", "N m"]
    assert "there is no quantity or column 'x'" in refusal_sentence(client.get(f"{solved.path}/columns?columns=x"), 422)


def test_infinity_is_a_word_and_what_is_not_defined_null(store: Store) -> None:
    store_result(store, result(), tomllib.loads(fronts.JOB))
    with client_of(store) as client:
        found = client.get("/api/v1/jobs/1/columns").json()
    assert found["values"]["motion_error_mm"] == ["inf", None]
    assert found["values"]["crank_mm"] == [0.1 + 0.2, 1e-300]


def test_large_answers_are_compressed_where_that_is_accepted(store: Store, solved: Solved) -> None:
    rows = solved.result.designs * 50
    assert math.isfinite(float(rows[0]["rod_mm"] or 0.0))
    store_result(store, solved.result, tomllib.loads(fronts.JOB), designs=rows)
    with client_of(store) as client:
        plain = client.get("/api/v1/jobs/1/columns", headers={"Accept-Encoding": "identity"})
        packed = client.get("/api/v1/jobs/1/columns", headers={"Accept-Encoding": "gzip, br"})
    assert "content-encoding" not in plain.headers
    assert packed.headers["content-encoding"] == "gzip"
    assert packed.headers["vary"] == "Accept-Encoding"
    assert packed.num_bytes_downloaded < plain.num_bytes_downloaded
    assert packed.json() == plain.json()


def test_what_a_client_has_is_not_sent_again(solved: Solved, client: httpx.Client) -> None:
    path = f"{solved.path}/columns?columns=rod"
    tag = client.get(path).headers["etag"]
    again = client.get(path, headers={"If-None-Match": tag})
    assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", tag)
    assert client.get(path, headers={"If-None-Match": '"other"'}).status_code == 200


def test_a_job_without_a_result_has_no_columns(store: Store) -> None:
    add(store)
    with client_of(store) as client:
        assert "has no result" in refusal_sentence(client.get("/api/v1/jobs/1/columns"), 409)
        assert "no job 9" in refusal_sentence(client.get("/api/v1/jobs/9/columns"), 404)
