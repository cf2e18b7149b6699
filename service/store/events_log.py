"""Adding to the events of a job, in a transaction that has its row in `jobs` already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Connection, insert

from .clock import now
from .schema import events
from .serialisation import text_of

Told = tuple[str, Mapping[str, Any]]
"""Kind and data of an event."""


def add_events(connection: Connection, job: int, last: int, told: Sequence[Told]) -> None:
    """Add events of which the last has the number `last`."""
    for number, (kind, data) in enumerate(told, last - len(told) + 1):
        row = {"job": job, "number": number, "at": now(), "kind": kind, "data": text_of(data)}
        connection.execute(insert(events).values(row))


def state_event(state: str, reason: str = "") -> Told:
    """Return the event of a job that comes into a state."""
    return "state", {"state": state, "reason": reason}
