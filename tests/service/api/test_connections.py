"""Connections that ask too much, too slowly or nothing at all: refused or closed, and all others are answered."""

from __future__ import annotations

import contextlib
import itertools
import json
import random
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import httpx
import psutil
import pytest

from slidercrank.service.api import connections, server
from slidercrank.service.api.connections import MOST_HEAD, Connection
from slidercrank.service.store import Store
from tests.service.api.serving import TOKEN, client_of
from tests.service.store.contents import add

LIVE = b"GET /api/v1/health/live HTTP/1.1\r\nHost: localhost\r\n"


@contextlib.contextmanager
def connected(client: httpx.Client, *, takes: int = 65_536) -> Iterator[socket.socket]:
    """Connect. takes: bytes that wait in the system at each end."""
    with socket.socket() as there:
        there.settimeout(10.0)
        there.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, takes)
        there.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, takes)
        there.connect(("127.0.0.1", client.base_url.port or 0))
        yield there


def ask_until_nothing_is_read(there: socket.socket) -> None:
    """Send requests without taking an answer until the service reads no more of them."""
    there.settimeout(0.3)
    with contextlib.suppress(TimeoutError):
        for _ in range(1000):
            there.sendall((LIVE + b"\r\n") * 100)
    there.settimeout(10.0)


def answer(there: socket.socket) -> tuple[int, dict[str, object]]:
    """Return status and problem document of what a connection is answered before it is closed."""
    content = b""
    with contextlib.suppress(ConnectionResetError):
        while part := there.recv(65_536):
            content += part
    head, _, body = content.partition(b"\r\n\r\n")
    assert b"content-type: application/problem+json" in head.lower()
    assert b"connection: close" in head.lower()
    return int(head.split()[1]), json.loads(body)


def sent(there: socket.socket, *parts: bytes) -> tuple[int, dict[str, object]]:
    with contextlib.suppress(ConnectionError):
        for part in parts:
            there.sendall(part)
    return answer(there)


@pytest.fixture(scope="module")
def open_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with Store(tmp_path_factory.mktemp("open") / "store.db") as store, client_of(store, token=TOKEN) as client:
        yield client


@pytest.mark.parametrize("size", [MOST_HEAD + 1, 40_000_000])
def test_an_endless_address_is_refused_before_it_ends(open_service: httpx.Client, size: int) -> None:
    begin = time.process_time()
    with connected(open_service) as there:
        status, document = sent(there, b"GET /", b"a" * size, b" HTTP/1.1\r\nHost: localhost\r\n\r\n")
    assert status == document["status"] == 414
    assert "at most 65536 bytes" in str(document["detail"])
    assert time.process_time() - begin < 1.0  # 3.4 s for 40 MB where it was read to its end


@pytest.mark.parametrize(
    "headers",
    [
        b"X: " + b"a" * MOST_HEAD,
        b"X: " + b"a" * 20_000_000,
        b"a:\r\n" * 30_000,
        b"a:\r\n" * 1000,
        b"X-" + b"a" * 200_000 + b": 1",
    ],
)
def test_endless_headers_are_refused(open_service: httpx.Client, headers: bytes) -> None:
    with connected(open_service) as there:
        status, document = sent(there, LIVE, headers, b"\r\n\r\n")
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
        assert sent(there, asked[:-2] + token + b"\r\n", rest)[0] == 431


def memory() -> int:
    taken: int = psutil.Process().memory_info().rss
    return taken


def test_what_is_not_http_gets_a_problem_document(open_service: httpx.Client) -> None:
    for noise in (
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n",
        b"HELO there\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
    ):
        with connected(open_service) as there:
            assert sent(there, noise)[0] == 400


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


def test_a_request_that_never_ends_is_given_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(connections, "HEAD_SECONDS", 0.3)
    monkeypatch.setattr(connections, "BODY_SECONDS", 0.5)
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
            "the body must be there within 0.5 s; not all came; send less, or over a faster connection",
        )
        time.sleep(0.6)  # a connection at rest after an answer is kept
        assert client.get("/health/live").status_code == 200
    assert "nothing was asked within 0.3 s" in caplog.text


def test_half_open_connections_keep_nobody_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 20)
    with Store(tmp_path / "store.db") as store, client_of(store) as client, contextlib.ExitStack() as stack:
        assert client.get("/health/live").status_code == 200
        for number in range(100):
            there = stack.enter_context(connected(client))
            there.sendall(LIVE[: number % len(LIVE)])
            if number % 10 == 0:
                begin = time.monotonic()
                assert client.get("/health/live").status_code == 200
                assert time.monotonic() - begin < 1.0
        kept = client.get("/health/live")
        assert kept.status_code == 200
    assert "closed to make room: more than 20" in caplog.text


def test_where_all_connections_are_being_answered_a_new_one_is_told_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 3)
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


@pytest.fixture
def ahead(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Give how many requests were read and not yet answered on a connection, each time that one was read.

    Fails where more than 100 kB wait to be read.
    """
    counts: list[int] = []

    class Counted(Connection):
        unanswered = 0

        def data_received(self, data: bytes) -> None:
            super().data_received(data)
            if len(self._backlog) > 100_000:
                counts.append(len(self._backlog))

        def on_headers_complete(self) -> None:
            self.unanswered += 1
            counts.append(self.unanswered)
            super().on_headers_complete()

        def on_response_complete(self) -> None:
            self.unanswered -= 1
            super().on_response_complete()

    monkeypatch.setattr(connections, "Connection", Counted)
    return counts


def test_requests_that_come_together_are_read_one_at_a_time_and_all_answered(tmp_path: Path, ahead: list[int]) -> None:
    chance = random.Random(36)
    token = f"Authorization: Bearer {TOKEN}\r\n".encode()
    check = b"POST /api/v1/check HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n" + token
    blank = b'{"job": {"name": "' + b"a" * 3000 + b'"}}\r\n\r\n\r\n\r\n'
    asked = {
        LIVE + b"\r\n": 200,
        b"GET /api/v1/jobs HTTP/1.1\r\nHost: localhost\r\n\r\n": 401,
        b"GET /api/v1/jobs/9 HTTP/1.1\r\nHost: localhost\r\n" + token + b"\r\n": 404,
        check + b"Content-Length: %d\r\n\r\n" % len(blank) + blank: 422,
        check + b"Transfer-Encoding: chunked\r\n\r\n%x\r\n" % len(blank) + blank + b"\r\n0\r\n\r\n": 422,
    }
    with Store(tmp_path / "store.db") as store, client_of(store, token=TOKEN) as client:
        for _ in range(10):
            requests = chance.choices(list(asked), k=20)
            content = b"".join(requests)
            cuts = sorted(chance.choices(range(len(content)), k=chance.choice([0, 2, 200])))
            with connected(client) as there:
                for begin, end in itertools.pairwise([0, *cuts, len(content)]):
                    there.sendall(content[begin:end])
                came = there.makefile("rb")
                assert [status_of(came) for _ in requests] == [asked[request] for request in requests]
        with connected(client, takes=1) as there:
            ask_until_nothing_is_read(there)
    assert max(ahead) <= 2  # the second where it comes with the end of a body


def status_of(came: IO[bytes] | socket.SocketIO) -> int:
    """Return the status of the next answer, which is read to its end."""
    status, length = int(came.readline().split()[1]), 0
    while line := came.readline().strip():
        name, _, value = line.partition(b":")
        if name.lower() == b"content-length":
            length = int(value)
    came.read(length)
    return status


def test_the_rest_of_a_request_comes_after_the_answer_before_it(open_service: httpx.Client) -> None:
    with connected(open_service) as there:
        came = there.makefile("rb")
        there.sendall(LIVE + b"\r\n" + LIVE)
        assert status_of(came) == 200
        there.sendall(b"\r\n")
        assert status_of(came) == 200


def test_answers_that_nobody_takes_end_the_connection(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(server, "ANSWER_SECONDS", 0.4)
    with Store(tmp_path / "store.db") as store, client_of(store) as client, connected(client, takes=1) as there:
        ask_until_nothing_is_read(there)
        with pytest.raises(ConnectionResetError):
            there.sendall(bytes(50_000_000))
    assert "answers were not taken" in caplog.text


@pytest.mark.parametrize("token", [None, TOKEN])
def test_answers_that_nobody_takes_keep_nobody_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, token: str | None
) -> None:
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 3)
    with (
        Store(tmp_path / "store.db") as store,
        client_of(store, token=token) as client,
        contextlib.ExitStack() as stack,
    ):
        for _ in range(3):
            ask_until_nothing_is_read(stack.enter_context(connected(client, takes=1)))
        for _ in range(3):
            with connected(client) as late:
                late.sendall(LIVE + b"\r\n")
                assert status_of(late.makefile("rb")) == 200


def test_who_has_the_token_keeps_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 5)
    jobs = b"GET /api/v1/jobs HTTP/1.1\r\nHost: localhost\r\n"
    token = f"Authorization: Bearer {TOKEN}\r\n".encode()
    with (
        Store(tmp_path / "store.db") as store,
        client_of(store, token=TOKEN) as client,
        contextlib.ExitStack() as stack,
    ):
        known = stack.enter_context(connected(client))
        answers = known.makefile("rb")
        known.sendall(jobs + token + b"\r\n")
        assert status_of(answers) == 200
        for request, status in ((LIVE, 200), (jobs, 401)) * 10:
            other = stack.enter_context(connected(client))
            other.sendall(request + b"\r\n")
            assert status_of(other.makefile("rb")) == status
        known.sendall(jobs + token + b"\r\n")
        assert status_of(answers) == 200


def test_time_that_a_request_waits_unread_is_not_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "BODY_SECONDS", 0.2)
    stream = b"GET /api/v1/jobs/1/events HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n\r\n"
    post = b"POST /api/v1/check HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\n1"
    with Store(tmp_path / "store.db") as store, client_of(store) as client, connected(client) as there:
        job = add(store)
        there.sendall(stream + post)
        came = there.makefile("rb")
        while not came.readline().startswith(b"id: 1"):
            pass
        time.sleep(0.5)
        there.sendall(b"234567890")
        store.cancel(job.id)
        while came.readline() != b"0\r\n":  # the stream ends
            pass
        assert came.readline() == b"\r\n"
        assert status_of(came) == 415


def test_without_the_token_no_body_is_kept(open_service: httpx.Client) -> None:
    post = b"%s HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\n{"
    for place, status in ((b"GET /api/v1/health/live", 200), (b"POST /api/v1/jobs", 401)):
        with connected(open_service) as there:
            there.sendall(post % place)
            assert status_of(there.makefile("rb")) == status
