"""Clients that ask too much of an API. Every sign of life comes within a second, and the others are answered."""

from __future__ import annotations

import contextlib
import random
import socket
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import httpx

from .api_process import TOKEN, Api, api
from .places import place
from .watched import FILES, Flooded, many_files, watch_flooded_api

_TURN = 30.0  # s that a request waits while others are first, as docs/service.md says
_JOB = (
    b"Host: localhost\r\nAuthorization: Bearer "
    + TOKEN.encode()
    + b"\r\nContent-Type: %s\r\nContent-Length: %d\r\n\r\n"
)


def flood(count: int, seed: int) -> Flooded:
    """Send `count` requests of each kind to an API of its own; watch whether it answers all the time."""
    flooded, random_ = Flooded(), random.Random(seed)
    with place("sqlite") as where, many_files(), api(where.address, FILES) as served:
        served.until_it_answers()
        kinds = [kind for kind in (_bodies, _large_jobs, _addresses, _headers, _slow_bodies) for _ in range(count)]
        random_.shuffle(kinds)
        with watch_flooded_api(served, flooded):
            _half_open(served, flooded, 1100)
            for kind in kinds:
                kind(served, flooded)
            _half_open(served, flooded, 1100)
    return flooded


def _status_of_request(served: Api, *parts: bytes) -> int:
    """Send bytes and return the status of what is answered; 0 where the connection is just closed."""
    content = b""
    with contextlib.suppress(OSError), socket.create_connection(served.where, timeout=90.0) as there:
        for part in parts:
            there.sendall(part)
        there.shutdown(socket.SHUT_WR)
        while more := there.recv(65_536):
            content += more
    return int(content.split(maxsplit=2)[1]) if content.startswith(b"HTTP/1.1 ") else 0


def _require_refusal(served: Api, flooded: Flooded, what: str, *parts: bytes) -> None:
    status = _status_of_request(served, *parts)
    flooded.requests += 1
    if not (status == 0 or 400 <= status < 500):
        flooded.violations.append(f"{what}: answered with {status}")


def _posted(kind: bytes, body: bytes) -> bytes:
    return b"POST /api/v1/jobs HTTP/1.1\r\n" + _JOB % (kind, len(body)) + body


def _bodies(served: Api, flooded: Flooded) -> None:
    words = b"a." * 500_000
    tables = b"".join(b"[k%d.a.b.c]\n" % number for number in range(60_000))
    keys = b'{"job": {' + b",".join(b'"k%d": 1' % number for number in range(60_000)) + b"}}"
    for kind, body in (
        (b"application/toml", (b"q" * 99 + b".") * 31 + b"=1\n"),
        (b"application/toml", words + b"a = 1"),
        (b"application/toml", tables),
        (b"application/toml", b'"""\\' * 250_000),
        (b"application/json", b"[" * 1_000_000),
        (b"application/json", keys),
        (b"application/json", b'{"job": ' + b"9" * 1_000_000 + b"}"),
    ):
        whole = body * max(1, 1_000_000 // len(body)) if len(body) < 10_000 else body
        _require_refusal(served, flooded, "body", _posted(kind, whole))


def _large_jobs(served: Api, flooded: Flooded) -> None:
    """Send jobs that take long to read, of each five at once: two are read, the others wait."""
    for path, kind, body in (
        ("check", "application/toml", b"[[load]]\n" * 110_000),
        ("preview", "application/json", b'{"job": {"load": [' + b",".join([b"{}"] * 110_000) + b"]}}"),
        ("check", "application/json", b'{"job": {"load": [' + b",".join([b"{}"] * 9_900) + b"]}}"),
    ):
        headers = {"Authorization": f"Bearer {TOKEN}", "Content-Type": kind}
        post = partial(httpx.post, content=body, headers=headers, trust_env=False, verify=False, timeout=90.0)
        with ThreadPoolExecutor(5) as at_once:
            answers = list(at_once.map(post, [f"{served.url}api/v1/{path}"] * 5))
        flooded.requests += len(answers)
        usual = {"check": 422, "preview": 200}[path]
        flooded.violations += [
            f"a large job: {one.status_code} after {one.elapsed.total_seconds():.1f} s"
            for one in answers
            if one.status_code != usual and not _waited_in_vain(one)
        ]
        if all(_waited_in_vain(one) for one in answers):
            flooded.violations.append(f"none of the large jobs was answered: {path}")


def _waited_in_vain(answer: httpx.Response) -> bool:
    """Whether others were first for as long as a request waits for its turn."""
    return answer.status_code == 503 and "Retry-After" in answer.headers and answer.elapsed.total_seconds() >= _TURN


def _addresses(served: Api, flooded: Flooded) -> None:
    _require_refusal(served, flooded, "address", b"GET /", b"a" * 40_000_000, b" HTTP/1.1\r\nHost: localhost\r\n\r\n")


def _headers(served: Api, flooded: Flooded) -> None:
    start = b"GET /api/v1/jobs HTTP/1.1\r\nHost: localhost\r\n"
    _require_refusal(served, flooded, "headers", start, b"X: " + b"a" * 20_000_000, b"\r\n\r\n")
    _require_refusal(served, flooded, "headers", start, b"a: b\r\n" * 1_000_000, b"\r\n")


def _slow_bodies(served: Api, flooded: Flooded) -> None:
    """Begin bodies that never end, and leave."""
    for _ in range(20):
        with contextlib.suppress(OSError), socket.create_connection(served.where, timeout=5.0) as there:
            there.sendall(b"POST /api/v1/jobs HTTP/1.1\r\n" + _JOB % (b"application/json", 1000) + b"{")
        flooded.requests += 1


def _half_open(served: Api, flooded: Flooded, count: int) -> None:
    """Hold connections that have asked nothing, or half a question, while others ask."""
    with contextlib.ExitStack() as held:
        for number in range(count):
            with contextlib.suppress(OSError):
                there = held.enter_context(socket.create_connection(served.where, timeout=5.0))
                there.sendall(b"GET /api/v1/jobs HTTP/1.1\r\nHost:"[: number % 30])
            flooded.requests += 1
        time.sleep(2.0)
