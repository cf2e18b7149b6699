"""Slow clients with the token: a download, a stream of events, and requests sent a few at a time."""

from __future__ import annotations

import contextlib
import random
import socket
import threading
from collections.abc import Callable, Iterator
from functools import partial

import httpx

from slidercrank.service.store import Claim, Store
from tests.service.store.contents import add, claim_waiting_job, result

from .api_process import TOKEN, Api

_DESIGNS, _QUANTITIES = 10_000, 25
_FEW = 5
"""Requests that are sent at a time."""
_PAUSE = 0.1  # s
_LONGEST = 300.0  # s, so that nothing waits for ever; how soon an API answers is judged by its signs of life
_TOKEN = {"Authorization": f"Bearer {TOKEN}"}
Pause = Callable[[], bool]
"""Waits a moment, and returns whether the clients are to end."""


@contextlib.contextmanager
def patient_clients(store: Store, served: Api, violations: list[str]) -> Iterator[None]:
    """Let clients ask an API of a store, and say what they did not get whole and in order."""
    chance, names = random.Random(1), ["time_ratio", *(f"quantity_{number}" for number in range(_QUANTITIES))]
    add(store)
    done = claim_waiting_job(store)
    done.finish(result(rows=[{name: chance.random() for name in names} for _ in range(_DESIGNS)]))
    add(store)
    clients = {
        "download": partial(_download, served, f"jobs/{done.job.id}/export.csv"),
        "stream": partial(_follow, served, claim_waiting_job(store, lease=3600.0)),
        "requests": partial(_ask_a_few, served),
    }
    over, begun = threading.Event(), threading.Semaphore(0)

    def pause() -> bool:
        begun.release()
        return over.wait(_PAUSE)

    def run(name: str, client: Callable[[Pause], None]) -> None:
        try:
            client(pause)
        except (OSError, AssertionError, httpx.TransportError) as error:
            violations.append(f"{name}: {type(error).__name__}: {error}")

    threads = [threading.Thread(target=run, args=client) for client in clients.items()]
    for thread in threads:
        thread.start()
        begun.acquire(timeout=_LONGEST)
    try:
        yield
    finally:
        over.set()
        for thread in threads:
            thread.join()


def _download(served: Api, path: str, pause: Pause) -> None:
    """Take a file of some MB, a kB at a time."""
    whole = httpx.get(f"{served.url}api/v1/{path}", headers=_TOKEN, trust_env=False, timeout=_LONGEST).content
    with _connected(served) as there:
        there.sendall(_request(path, "Connection: close"))
        came = there.recv(1000)
        while not pause():
            came += there.recv(1000)
        while part := there.recv(65_536):
            came += part
    assert came.endswith(whole), f"{len(came)} bytes came of {len(whole)}"


def _follow(served: Api, claim: Claim, pause: Pause) -> None:
    """Take the events of a job as they come."""
    with _connected(served) as there:
        there.sendall(_request(f"jobs/{claim.job.id}/events", "Accept: text/event-stream"))
        events, number = there.makefile("rb"), 0
        while not pause():
            number += 1
            claim.add_message(f"message {number}")
            while '"text"' not in (line := events.readline().decode()):
                assert line, f"the stream ended before message {number}"
            assert f'"message {number}"' in line, f"{line!r} came instead of message {number}"


def _ask_a_few(served: Api, pause: Pause) -> None:
    """Send requests together and take their answers, again and again on one connection."""
    jobs = range(1001, 1001 + _FEW)
    with _connected(served) as there:
        while not pause():
            there.sendall(b"".join(_request(f"jobs/{job}") for job in jobs))
            came = b""
            while came.count(b"list the jobs") < _FEW:
                part = there.recv(65_536)
                assert part, f"the connection ended after {came!r}"
                came += part
            places = [came.find(f"no job {job};".encode()) for job in jobs]
            assert places == sorted(set(places) - {-1}), f"{came!r} came for jobs {jobs}"


def _connected(served: Api) -> socket.socket:
    there = socket.create_connection(served.where, timeout=_LONGEST)
    there.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 16_384)
    return there


def _request(path: str, *headers: str) -> bytes:
    lines = [f"GET /api/v1/{path} HTTP/1.1", "Host: localhost", f"Authorization: Bearer {TOKEN}", *headers]
    return "\r\n".join([*lines, "", ""]).encode()
