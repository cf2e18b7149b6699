"""Clients without the token that send requests and take no answers, beside slow ones with it, which lose nothing."""

from __future__ import annotations

import contextlib
import socket
import time
from typing import Literal

from slidercrank.service.store import Store

from .api_process import Api, api
from .patient import patient_clients
from .places import place
from .watched import FILES, SIGNS, Flooded, many_files, watch_flooded_api

_REQUEST = b"GET /api/v1/health/live HTTP/1.1\r\nHost: localhost\r\n"
_HEAD = _REQUEST + b"".join(b"a%d: %s\r\n" % (number, b"b" * 600) for number in range(80)) + b"\r\n"
Attack = Literal["many", "long", "heads", "bodies"]
ATTACKS: dict[Attack, tuple[int, bytes]] = {
    "many": (530, (_REQUEST + b"\r\n") * 300),
    "long": (40, (_REQUEST + b"\r\n") * 9000),
    "heads": (530, _HEAD + _HEAD[:-2]),
    "bodies": (530, _REQUEST + b"Content-Length: 1000000\r\n\r\n" + b"b" * 500_000),
}
"""Connections, and what each sends: 300 and 9,000 requests of 53 bytes, large heads, bodies that do not end."""


def stall(attack: Attack, seconds: float) -> Flooded:
    """Attack an API of its own in one of the ways of `ATTACKS`, and return what came of it.

    seconds: how long at least.
    """
    flooded = Flooded()
    with place("sqlite") as where, Store(where.address) as store, many_files(), api(where.address, FILES) as served:
        served.until_it_answers()
        with patient_clients(store, served, flooded.violations), watch_flooded_api(served, flooded):
            _send(served, flooded, *ATTACKS[attack], seconds)
    return flooded


def _send(served: Api, flooded: Flooded, count: int, content: bytes, seconds: float) -> None:
    """Keep connections open for some time, send content on each and take nothing; open those anew that were closed."""
    end = time.monotonic() + seconds
    with contextlib.ExitStack() as stack:
        held: dict[int, tuple[socket.socket, memoryview]] = {}
        stack.callback(_close, held)
        while time.monotonic() < end or flooded.signs < SIGNS:
            for number in range(count):
                try:
                    if number not in held:
                        held[number] = _connected(served), memoryview(content)
                        flooded.requests += content.count(b"GET ")
                    there, rest = held[number]
                    if there.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR):
                        raise ConnectionResetError
                    held[number] = there, rest[there.send(rest) :]
                except BlockingIOError:
                    pass
                except OSError:
                    if number in held:
                        held.pop(number)[0].close()
            time.sleep(0.05)


def _close(held: dict[int, tuple[socket.socket, memoryview]]) -> None:
    for there, _ in held.values():
        there.close()


def _connected(served: Api) -> socket.socket:
    there = socket.socket()
    there.settimeout(5.0)
    there.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
    try:
        there.connect(served.where)
    except OSError:
        there.close()
        raise
    there.setblocking(False)
    return there
