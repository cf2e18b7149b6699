"""Bodies and addresses that no job has, refused before anything reads them."""

from __future__ import annotations

import json
from collections.abc import Iterator

import httpx
import pytest

from slidercrank.model.errors import InputError
from slidercrank.service.api.computing import RateLimit
from slidercrank.service.api.job_requests import EXAMPLE
from slidercrank.service.api.strict_input import read_json
from tests.service.api.serving import refusal_sentence

JSON = {"Content-Type": "application/json"}


def post(client: httpx.Client, text: str | bytes, path: str = "/jobs") -> httpx.Response:
    """Return the answer to a body of JSON."""
    return client.post(path, content=text, headers=JSON)


def test_an_oversized_body_is_refused(shared: httpx.Client) -> None:
    body = json.dumps({"job": EXAMPLE}) + " " * 1_048_576
    assert "at most 1048576 bytes" in refusal_sentence(post(shared, body), 413)


def test_an_oversized_body_in_chunks_is_refused_before_it_has_all_come(shared: httpx.Client) -> None:
    sent = 0

    def chunks() -> Iterator[bytes]:
        nonlocal sent
        for _ in range(10_000):
            sent += 65_536
            yield b" " * 65_536

    try:
        response = shared.post("/jobs", content=chunks(), headers=JSON)
    except httpx.WriteError:  # the service hung up while the client was still sending
        pass
    else:
        refusal_sentence(response, 413)
    assert sent < 1_000 * 65_536  # a tenth: what the sockets' buffers hold on the way depends on the machine


def test_a_body_as_large_as_allowed_is_read_also_in_chunks(shared: httpx.Client) -> None:
    text = json.dumps({"job": EXAMPLE}).ljust(1_048_576).encode()
    assert post(shared, text, "/check").status_code == 200
    chunks = (text[start : start + 65_536] for start in range(0, len(text), 65_536))
    assert shared.post("/check", content=chunks, headers=JSON).status_code == 200


@pytest.mark.parametrize("deep", ["[" * 33 + "]" * 33, "[" * 500_000, '{"a":' * 100_000, '{"a":' * 40 + "1" + "}" * 40])
def test_deep_json_is_refused(shared: httpx.Client, deep: str) -> None:
    refusal_sentence(post(shared, deep), 400)
    refusal_sentence(post(shared, f'{{"job": {deep}}}', "/check"), 400)


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999", "-1e400"])
def test_numbers_that_are_not_finite_are_refused(shared: httpx.Client, number: str) -> None:
    assert "a number must be finite" in refusal_sentence(post(shared, f'{{"job": {{}}, "priority": {number}}}'), 400)


@pytest.mark.parametrize("number", [str(2**53 + 1), "-" + "9" * 30, "9" * 5_000, "9" * 1_000_000])
def test_huge_integers_are_refused(shared: httpx.Client, number: str) -> None:
    assert "at most 2^53" in refusal_sentence(post(shared, f'{{"job": {{"a": {number}}}}}'), 400)


@pytest.mark.parametrize("path", ["/jobs/99999999999999999999", "/jobs/" + "9" * 5_000, "/jobs?before=" + "9" * 400])
def test_huge_numbers_in_addresses_are_refused(shared: httpx.Client, path: str) -> None:
    assert len(refusal_sentence(shared.get(path), 422)) < 500


@pytest.mark.parametrize("text", [r'"\u0000"', r'{"a\u0000b": 1}', r'["\ud800"]', r'{"\udfff": 1}'])
def test_nul_and_half_characters_in_json_are_refused(shared: httpx.Client, text: str) -> None:
    assert "no NUL" in refusal_sentence(post(shared, f'{{"job": {text}}}'), 400)


@pytest.mark.parametrize("path", ["/jobs?name=%00", "/jobs/1/files/%00", "/%00", "/jobs?name=a%00b&limit=1"])
def test_nul_in_addresses_is_refused(shared: httpx.Client, path: str) -> None:
    assert "must not contain NUL" in refusal_sentence(shared.get(path), 400)


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"{",
        b"\xff\xfe{}",
        b'{"job": {}, "job": {}}',
        b"[]",
        b"null",
        b'"job"',
        b'{"job": []}',
        b'{"job": {}} {}',
        b"\0",
    ],
)
def test_bodies_that_are_no_submission_are_refused(shared: httpx.Client, text: bytes) -> None:
    response = post(shared, text)
    assert response.status_code in (400, 422)
    refusal_sentence(response, response.status_code)


def test_moderate_json_is_read_as_it_is() -> None:
    value = {"a": [1, -1.5, 2**53, True, None, "ü"], "b": {"c": {"d": []}}}
    assert read_json(json.dumps(value).encode(), 4) == value
    with pytest.raises(InputError, match="at most 3 deep"):
        read_json(json.dumps(value).encode(), 3)


def test_a_rate_limit_lets_as_many_again_over_a_minute() -> None:
    now = 0.0
    limit = RateLimit(60, clock=lambda: now)
    assert [limit.seconds_until_admitted() for _ in range(60)] == [0.0] * 60
    assert limit.seconds_until_admitted() == pytest.approx(1.0)
    now = 0.25
    assert limit.seconds_until_admitted() == pytest.approx(0.75)
    now = 2.0
    assert [limit.seconds_until_admitted() for _ in range(2)] == [0.0, 0.0]
    assert limit.seconds_until_admitted() > 0.0
    assert RateLimit(0).seconds_until_admitted() == 0.0
