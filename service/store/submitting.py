"""Putting a job into the store: queued for a worker, or in the hands of its submitter from the start."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import astuple
from typing import Any

from sqlalchemy import Connection, delete, func, insert, select, text

from ...model.errors import InputError, QueueFull
from .clock import later, now
from .records import LIMITS, SHOWN, Artefact, Job, Limits, job_of
from .rows import add_events, state_event
from .schema import artefacts, jobs
from .schema_version import LOCK
from .serialisation import plain, text_of


def require_bounds(priority: int, key: str | None, most_attempts: int) -> None:
    """Raise `InputError` for what no job can have."""
    if not (abs(priority) <= 1000 and 1 <= most_attempts <= 1000):
        raise InputError(
            f"a job has a priority from -1000 to 1000 and 1 to 1000 attempts; got {priority} and {most_attempts}; "
            "choose within these"
        )
    if key is not None and not (0 < len(key) <= 255 and key.isprintable()):
        raise InputError(f"a key has 1 to 255 printable characters; got {key[:300]!r}; choose another one")


def take_turns(connection: Connection) -> None:
    """Wait until no other session of PostgreSQL submits; those of SQLite take turns anyway."""
    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK + 1})


def submitted_before(connection: Connection, key: str, tables: Mapping[str, Any]) -> Job | None:
    """Return the job that was submitted with a key, None if there is none. Raises `InputError` if it differs."""
    row = connection.execute(select(*SHOWN, jobs.c.tables).where(jobs.c.key == key)).first()
    if row is None:
        return None
    if json.loads(row.tables) != json.loads(text_of(tables)):
        raise InputError(f"a key stands for one job; {key!r} is that of job {row.id}, which differs; use another key")
    return job_of(row, more=("tables",))


def require_room(connection: Connection, most_queued: int) -> None:
    """Raise `QueueFull` if as many jobs wait as may wait."""
    waiting = connection.scalar(select(func.count()).where(jobs.c.state == "queued")) or 0
    if waiting >= most_queued:
        raise QueueFull(f"at most {most_queued} jobs may wait; {waiting} do; wait, or cancel some")


def add_job(
    connection: Connection,
    tables: Mapping[str, Any],
    files: Sequence[Artefact],
    limits: Limits,
    *,
    name: str,
    run: str,
    **more: Any,
) -> int:
    """Insert a queued job and return its number. run: the name of its folder; another is made if that one is taken."""
    row = {
        "name": plain(name),
        "run": _free(connection, run),
        "tables": text_of(tables),
        "state": "queued",
        "submitted": now(),
        "due": now(),
        "events": 1,
        **dict(zip(LIMITS, astuple(limits), strict=True)),
        **more,
    }
    number = connection.execute(insert(jobs).values(row).returning(jobs.c.id)).scalar_one()
    put_files(connection, number, files)
    add_events(connection, number, 1, [state_event("queued")])
    return int(number)


def in_hand(worker: str, lease: float) -> dict[str, Any]:
    """Return the changes, besides the state, to a job that a worker takes for `lease` s."""
    return {
        "attempts": jobs.c.attempts + 1,
        "started": func.coalesce(jobs.c.started, now()),
        "worker": worker,
        "lease_until": later(lease),
        "fence": jobs.c.fence + 1,
        "writes": 0,
    }


def put_files(connection: Connection, job: int, files: Sequence[Artefact]) -> None:
    """Write files of a job, each in place of one of its name."""
    for file in files:
        connection.execute(delete(artefacts).where(artefacts.c.job == job, artefacts.c.name == file.name))
        row = {"name": file.name, "media_type": file.media_type, "content": file.content}
        connection.execute(insert(artefacts).values(job=job, at=now(), **row))


def _free(connection: Connection, run: str) -> str:
    start = jobs.c.run.startswith(run, autoescape=True)
    taken = set(connection.execute(select(jobs.c.run).where(start)).scalars())
    return next(name for name in (run, *(f"{run}-{i}" for i in range(2, len(taken) + 3))) if name not in taken)
