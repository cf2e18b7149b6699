"""Connections to a service, byte by byte."""

from __future__ import annotations

import contextlib
import json
import socket
from collections.abc import Iterator
from typing import IO

import httpx

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


def send_parts(there: socket.socket, *parts: bytes) -> tuple[int, dict[str, object]]:
    with contextlib.suppress(ConnectionError):
        for part in parts:
            there.sendall(part)
    return answer(there)


def status_of(came: IO[bytes] | socket.SocketIO) -> int:
    """Return the status of the next answer, which is read to its end."""
    status, length = int(came.readline().split()[1]), 0
    while line := came.readline().strip():
        name, _, value = line.partition(b":")
        if name.lower() == b"content-length":
            length = int(value)
    came.read(length)
    return status
