"""Clients that send requests ahead without reading answers: served one by one, closed in the end, blocking nobody."""

from __future__ import annotations

import contextlib
import itertools
import random
import time
from pathlib import Path

import httpx
import pytest

from slidercrank.service.api import connection_limits, server
from slidercrank.service.api.connection_limits import Connection
from slidercrank.service.store import Store
from tests.service.api.connected import LIVE, ask_until_nothing_is_read, connected, status_of
from tests.service.api.serving import TOKEN, client_of
from tests.service.store.contents import add


@pytest.fixture
def ahead(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Give the bytes that wait to be read on a connection, each time that some were read."""
    sizes: list[int] = []

    class Counted(Connection):
        def handle_events(self) -> None:
            super().handle_events()
            sizes.append(len(self.conn.trailing_data[0]))

    monkeypatch.setattr(connection_limits, "Connection", Counted)
    return sizes


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
            ends, statuses = list(itertools.accumulate(map(len, requests))), list[int]()
            with connected(client) as there:
                came = there.makefile("rb")
                for begin, end in itertools.pairwise([0, *cuts, len(content)]):
                    there.sendall(content[begin:end])
                    while chance.random() < 0.5 and len(statuses) < 20 and ends[len(statuses)] <= end:
                        statuses.append(status_of(came))
                statuses += [status_of(came) for _ in requests[len(statuses) :]]
            assert statuses == [asked[request] for request in requests]
        with connected(client, takes=1) as there:
            ask_until_nothing_is_read(there)
    assert max(ahead) < 100_000


def test_the_rest_of_a_request_comes_after_the_answer_before_it(guarded: httpx.Client) -> None:
    with connected(guarded) as there:
        came = there.makefile("rb")
        there.sendall(LIVE + b"\r\n" + LIVE)
        assert status_of(came) == 200
        there.sendall(b"\r\n")
        assert status_of(came) == 200


def test_answers_that_nobody_takes_end_the_connection(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(server, "STALL_SECONDS", 0.4)
    with Store(tmp_path / "store.db") as store, client_of(store) as client, connected(client, takes=1) as there:
        ask_until_nothing_is_read(there)
        with pytest.raises(ConnectionResetError):
            there.sendall(bytes(50_000_000))
    assert "answers were not read" in caplog.text


@pytest.mark.parametrize("token", [None, TOKEN])
def test_answers_that_nobody_takes_keep_nobody_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, token: str | None
) -> None:
    monkeypatch.setattr(connection_limits, "MOST_CONNECTIONS", 3)
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
    monkeypatch.setattr(connection_limits, "MOST_CONNECTIONS", 5)
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
    monkeypatch.setattr(connection_limits, "BODY_SECONDS", 0.2)
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


def test_without_the_token_no_body_is_kept(guarded: httpx.Client) -> None:
    post = b"%s HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\n{"
    for place, status in ((b"GET /api/v1/health/live", 200), (b"POST /api/v1/jobs", 401)):
        with connected(guarded) as there:
            there.sendall(post % place)
            assert status_of(there.makefile("rb")) == status
