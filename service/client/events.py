"""The events of a job as a service tells them, over as many connections as it takes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import httpx

from .connection import Away, Connection, Tries

_ENDED = 204
Event = dict[str, Any]


def followed(connection: Connection, number: int, after: int) -> Iterator[Event]:
    """Yield the events of a job after a given one as they happen, until the service has no more.

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
                    tries = Tries(connection)
                    if event is not None:
                        after = int(event["number"])
                        yield event
        except (httpx.TransportError, Away) as error:
            tries.wait(error)
        else:
            if tries.made:
                tries.wait(Away("the events of a job end with the job; the service broke them off; see its log"))
            tries.made += 1


def _events(lines: Iterator[str]) -> Iterator[Event | None]:
    """Yield the data of server-sent events, None for a sign of life; leave out an event cut off.

    WHATWG, HTML standard, 9.2.6.
    """
    data: list[str] = []
    for line in lines:
        if line.startswith(":"):
            yield None
        elif line.startswith("data:"):
            data.append(line.removeprefix("data:").removeprefix(" "))
        elif not line and data:
            yield json.loads("\n".join(data))
            data = []
