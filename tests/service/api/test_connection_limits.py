"""Connections that ask too much, too slowly or nothing at all: refused or closed, and all others are answered."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import psutil
import pytest

from slidercrank.service.api import connection_limits
from slidercrank.service.api.connection_limits import MOST_HEAD
from slidercrank.service.store import Store
from tests.service.api.connected import LIVE, answer, connected, send_parts, status_of
from tests.service.api.serving import TOKEN, client_of
from tests.service.store.contents import add


@pytest.fixture(scope="module")
def open_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with Store(tmp_path_factory.mktemp("open") / "store.db") as store, client_of(store, token=TOKEN) as client:
        yield client


@pytest.mark.parametrize("size", [2 * MOST_HEAD, 40_000_000])
def test_an_endless_address_is_refused_before_it_ends(open_service: httpx.Client, size: int) -> None:
    begin = time.process_time()
    with connected(open_service) as there:
        status, document = send_parts(there, b"GET /", b"a" * size, b" HTTP/1.1\r\nHost: localhost\r\n\r\n")
    assert status == document["status"] == 431
    assert "at most 65536 bytes" in str(document["detail"])
    assert time.process_time() - begin < 1.0  # 3.4 s for 40 MB where it was read to its end


@pytest.mark.parametrize(
    "headers",
    [
        b"X: " + b"a" * 2 * MOST_HEAD,
        b"X: " + b"a" * 20_000_000,
        b"a:\r\n" * 30_000,
        b"X-" + b"a" * 200_000 + b": 1",
    ],
)
def test_endless_headers_are_refused(open_service: httpx.Client, headers: bytes) -> None:
    with connected(open_service) as there:
        status, document = send_parts(there, LIVE, headers, b"\r\n\r\n")
    assert status == document["status"] == 431


def test_headers_of_the_allowed_size_are_taken(open_service: httpx.Client) -> None:
    response = open_service.get("/health/live", headers={"X-Long": "a" * 60_000})
    assert response.status_code == 200


@pytest.mark.parametrize(
    "rest",
    [b"0\r\n" + b"T: x\r\n" * 1_000_000, b"1;" + b"x" * 20_000_000, b"0\r\nT: " + b"x" * 20_000_000],
    ids=["trailers", "extension", "trailer"],
)
def test_what_comes_with_chunks_has_its_limits_too(open_service: httpx.Client, rest: bytes) -> None:
    asked = b"POST /api/v1/jobs HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
    token = f"Authorization: Bearer {TOKEN}\r\n".encode()
    for head in (asked, asked[:-2] + token + b"\r\n"):
        before = memory()
        with connected(open_service) as there, contextlib.suppress(ConnectionError):
            for begin in range(0, len(rest), 1 << 20):
                if begin == 0:
                    there.sendall(head)
                there.sendall(rest[begin : begin + (1 << 20)])
        assert open_service.get("/health/live").status_code == 200
        assert memory() - before < 300e6
    with connected(open_service) as there:
        assert send_parts(there, asked[:-2] + token + b"\r\n", rest)[0] == 431


def memory() -> int:
    taken: int = psutil.Process().memory_info().rss
    return taken


def test_what_is_not_http_gets_a_problem_document(open_service: httpx.Client) -> None:
    for noise in (
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n",
        b"HELO there\r\n\r\n",
        b"GET / HTTP/1.x\r\n\r\n",
    ):
        with connected(open_service) as there:
            assert send_parts(there, noise)[0] == 400


def test_a_body_after_a_pipelined_request_is_no_head(open_service: httpx.Client) -> None:
    body = b'{"job": "' + b"a" * 100_000 + b'"}'
    token = f"Authorization: Bearer {TOKEN}\r\n".encode()
    post = b"POST /api/v1/check HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n" + token
    post += b"Content-Length: %d\r\n\r\n" % len(body) + body
    with connected(open_service) as there:
        there.sendall(post + LIVE[:20])
        time.sleep(0.2)
        there.sendall(LIVE[20:] + b"Connection: close\r\n\r\n")
        content = b""
        while part := there.recv(65_536):
            content += part
    assert content.count(b"HTTP/1.1 ") == 2
    assert content.endswith(b'{"status":"live"}')


@pytest.mark.parametrize("unit", [b"b", b"\n\r\n"], ids=["plain", "like the ends of heads"])
def test_all_of_a_large_body_is_read_before_the_next_request(tmp_path: Path, unit: bytes) -> None:
    body = unit * (600_000 // len(unit))
    post = b"POST /api/v1/check HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n" % len(body)
    last = LIVE + b"Connection: close\r\n\r\n"
    with Store(tmp_path / "store.db") as store, client_of(store) as client, connected(client) as there:
        there.sendall(post + body + last)
        came = there.makefile("rb", 0)
        assert [status_of(came), status_of(came)] == [415, 200]


def test_a_body_that_comes_in_large_parts_has_its_time_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connection_limits, "BODY_SECONDS", 0.3)
    head = f"POST /api/v1/check HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {TOKEN}\r\n".encode()
    head += b"Content-Type: application/json\r\nContent-Length: 1000000\r\n\r\n"
    with Store(tmp_path / "store.db") as store, client_of(store, token=TOKEN) as client, connected(client) as there:
        there.sendall(head)
        sent_size = 0
        with contextlib.suppress(ConnectionError):
            while sent_size < 1_000_000:  # takes 1.25 s
                there.sendall(b"b" * 40_000)
                sent_size += 40_000
                time.sleep(0.05)
        assert answer(there)[0] == 408


def test_a_request_that_never_ends_is_given_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(connection_limits, "HEAD_SECONDS", 0.3)
    monkeypatch.setattr(connection_limits, "BODY_SECONDS", 0.5)
    post = b"POST /api/v1/check HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\n1"
    with Store(tmp_path / "store.db") as store, client_of(store) as client:
        with connected(client) as silent, connected(client) as half, connected(client) as slow:
            half.sendall(LIVE)
            slow.sendall(post + b"234567890" + post)
            assert silent.recv(100) == b""
            assert answer(half)[0] == 408
            assert status_of(slow.makefile("rb", 0)) == 415
            status, document = answer(slow)
        assert (status, document["detail"]) == (
            408,
            "the body must arrive within 0.5 s; it is incomplete; send less, or use a faster connection",
        )
        time.sleep(0.6)  # a connection at rest after an answer is kept
        assert client.get("/health/live").status_code == 200
    assert "closed: no request within 0.3 s" in caplog.text


def test_half_open_connections_keep_nobody_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(connection_limits, "MOST_CONNECTIONS", 20)
    monkeypatch.setattr(connection_limits, "HEAD_SECONDS", 1e6)  # whoever waits for them is never answered
    with Store(tmp_path / "store.db") as store, client_of(store) as client, contextlib.ExitStack() as stack:
        assert client.get("/health/live").status_code == 200
        for number in range(100):
            there = stack.enter_context(connected(client))
            there.sendall(LIVE[: number % len(LIVE)])
            if number % 10 == 0:
                assert client.get("/health/live").status_code == 200
        kept = client.get("/health/live")
        assert kept.status_code == 200
    assert "closed because there were more than 20" in caplog.text


def test_where_all_connections_are_being_answered_a_new_one_is_told_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection_limits, "MOST_CONNECTIONS", 3)
    stream = b"GET /api/v1/jobs/1/events HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n\r\n"
    with Store(tmp_path / "store.db") as store, client_of(store) as client, contextlib.ExitStack() as stack:
        add(store)
        for _ in range(3):
            there = stack.enter_context(connected(client))
            there.sendall(stream)
            assert there.recv(12) == b"HTTP/1.1 200"
        with connected(client) as late:
            status, document = answer(late)
        assert status == 503
        assert "at most 3 connections" in str(document["detail"])
