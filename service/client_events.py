"""The events of a job as a service tells them, over as many connections as it takes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import httpx

from ..model.errors import ServiceError
from .client_connection import Connection, Tries

_ENDED = 204


def followed(connection: Connection, number: int, after: int) -> Iterator[dict[str, Any]]:
    """Yield the events of a job after one, as they happen, until the service says that there will be no more.

    Every connection says which event came last, so none is missed and none comes twice.
    """
    tries = Tries(connection)
    while True:
        headers = {"Accept": "text/event-stream", "Last-Event-ID": str(after)}
        try:
            with connection.stream(f"jobs/{number}/events", headers) as answer:
                if answer.status_code == _ENDED:
                    return
                for event in _events(answer.iter_lines()):
                    after = int(event["number"])
                    tries = Tries(connection)
                    yield event
        except httpx.TransportError as error:
            tries.wait(error)
        except ServiceError:
            if not tries.left:
                raise
            tries.pause()


def _events(lines: Iterator[str]) -> Iterator[dict[str, Any]]:
    """Yield the data of server-sent events; one that is cut off is left out. (WHATWG, HTML standard, 9.2.6)"""
    data: list[str] = []
    for line in lines:
        if line.startswith("data:"):
            data.append(line.removeprefix("data:").removeprefix(" "))
        elif not line and data:
            yield json.loads("\n".join(data))
            data = []
