"""The store: jobs, what happens to them and what they found, in one database that many processes share."""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Mapping
from os import PathLike
from typing import Any

from sqlalchemy import Connection, and_, delete, func, insert, select, text, update

from ...model.errors import InputError, QueueFull, RunError
from ..result import Result, Row, finite
from ..stored_runs import result_from
from .claim import Claim
from .claiming import any_claimable, claim_next
from .clock import now
from .database import Database
from .events_log import add_events, state_event
from .packing import plain, row_of, text_of
from .records import ENDED, RESUMABLE, SHOWN, Artefact, Event, Job, State, Worker, job_of
from .schema import artefacts, designs, events, jobs, workers
from .schema_version import LOCK, upgrade

MOST_QUEUED = 10_000
MOST_ATTEMPTS = 3
LEASE = 30.0
_FORGOTTEN = 7 * 86_400.0


class Store:
    """An open store. Threads may share it; processes open their own. Also a context manager, which closes it.

    Every method raises `StoreError` when the database refuses or cannot be reached, and `InputError` for a job that is
    not there. What a method has written when it returns outlives a crash of the machine.
    """

    def __init__(self, address: str | PathLike[str], *, most_queued: int = MOST_QUEUED) -> None:
        """Open the store at an address: the path of a file, sqlite:///file, or postgresql://user@host/database.

        The tables are created, or brought up to date. most_queued: how many jobs may wait.
        """
        self._database = Database(address)
        self.name = self._database.name
        self.most_queued = most_queued
        try:
            upgrade(self._database)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close all connections."""
        self._database.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def submit(
        self,
        tables: Mapping[str, Any],
        *,
        name: str,
        priority: int = 0,
        key: str | None = None,
        most_attempts: int = MOST_ATTEMPTS,
        most_seconds: float | None = None,
    ) -> Job:
        """Queue a job and return it. The job itself is not read; `submission.submit` checks it first.

        tables: of its job file. priority: higher ones are claimed first. key: of this submission; with one that was
        used before, nothing is queued and the job of that time is returned. most_attempts: how often it is tried
        without going forward before it is set aside. most_seconds: how long its search may take; it then ends with what
        it found, as if it had been cancelled.

        Raises `QueueFull`, and `InputError` if the key was used for another job.
        """
        _require_bounds(priority, key, most_attempts, most_seconds)
        stated = text_of(tables)
        row = {
            "key": key,
            "name": plain(name),
            "tables": stated,
            "state": "queued",
            "priority": priority,
            "most_attempts": most_attempts,
            "most_seconds": most_seconds,
            "submitted": now(),
            "due": now(),
            "events": 1,
        }
        with self._database.writing() as connection:
            if not self._database.sqlite:  # so that two submissions neither share a key nor overfill the queue
                connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK + 1})
            known = connection.execute(select(*SHOWN, jobs.c.tables).where(jobs.c.key == key)).first() if key else None
            if known is not None:
                if json.loads(known.tables) != json.loads(stated):
                    raise InputError(f"a key stands for one job; {key!r} is that of job {known.id}, which differs")
                return _job(connection, known.id)
            waiting = connection.scalar(select(func.count()).where(jobs.c.state == "queued")) or 0
            if waiting >= self.most_queued:
                raise QueueFull(f"at most {self.most_queued} jobs may wait; {waiting} do; wait, or cancel some")
            number = connection.execute(insert(jobs).values(row).returning(jobs.c.id)).scalar_one()
            add_events(connection, number, 1, [state_event("queued")])
            return _job(connection, number)

    def job(self, number: int) -> Job:
        """Return where a job stands."""
        with self._database.reading() as connection:
            return _job(connection, number)

    def jobs(
        self, *, states: Collection[State] = (), name: str = "", before: int | None = None, limit: int = 100
    ) -> list[Job]:
        """Return jobs, latest first. states: of these; all if empty. name: contains this, in any case of letters.

        before: older than the job of this number, to turn pages. limit: at most so many.
        """
        query = select(*SHOWN).order_by(jobs.c.id.desc()).limit(limit)
        if states:
            query = query.where(jobs.c.state.in_(states))
        if name:
            query = query.where(jobs.c.name.icontains(plain(name), autoescape=True))
        if before is not None:
            query = query.where(jobs.c.id < before)
        with self._database.reading() as connection:
            return [job_of(row) for row in connection.execute(query)]

    def counts(self) -> dict[str, int]:
        """Return how many jobs are in each state that any is in."""
        with self._database.reading() as connection:
            found = connection.execute(select(jobs.c.state, func.count()).group_by(jobs.c.state)).all()
        return {row.state: int(row[1]) for row in found}

    def tables(self, number: int) -> dict[str, Any]:
        """Return the tables of a job's file."""
        with self._database.reading() as connection:
            _job(connection, number)
            found = connection.execute(select(jobs.c.tables).where(jobs.c.id == number)).scalar_one()
        tables: dict[str, Any] = json.loads(found)
        return tables

    def events(self, number: int, *, after: int = 0, limit: int = 1000) -> list[Event]:
        """Return what happened to a job after its event of a number, in order, at most `limit` events."""
        query = select(events).where(and_(events.c.job == number, events.c.number > after))
        with self._database.reading() as connection:
            _job(connection, number)
            found = connection.execute(query.order_by(events.c.number).limit(limit)).all()
        return [
            Event(job=number, number=row.number, at=row.at, kind=row.kind, data=json.loads(row.data)) for row in found
        ]

    def result(self, number: int) -> Result:
        """Return what a job found. Raises `RunError` if it has no result (yet), or a damaged one."""
        with self._database.reading() as connection:
            job = _job(connection, number)
            record = connection.scalar(select(jobs.c.result).where(jobs.c.id == number))
            cells = select(designs.c.cells).where(designs.c.job == number).order_by(designs.c.number)
            found = connection.execute(cells).scalars().all()
        if record is None:
            raise RunError(f"job {number} has no result: it is {job.state}; wait for it, or see its events")
        try:
            stored = json.loads(record)
            columns = stored.pop("columns")
            rows: list[Row] = [row_of(columns, text) for text in found]
            return result_from({**stored, "designs": finite(rows)}, rows, str(stored["run"]))
        except (ValueError, KeyError, TypeError) as error:
            raise RunError(
                f"the result of job {number} is damaged: {type(error).__name__}: {error}; submit the job again"
            ) from error

    def artefacts(self, number: int) -> list[str]:
        """Return the names of a job's files, in alphabetical order."""
        with self._database.reading() as connection:
            _job(connection, number)
            return sorted(connection.execute(select(artefacts.c.name).where(artefacts.c.job == number)).scalars())

    def artefact(self, number: int, name: str) -> Artefact:
        """Return a file of a job. Raises `InputError` if it has none of that name."""
        own = and_(artefacts.c.job == number, artefacts.c.name == name)
        with self._database.reading() as connection:
            row = connection.execute(select(artefacts.c.media_type, artefacts.c.content).where(own)).first()
        if row is None:
            raise InputError(f"job {number} has no file {name!r}; choose one of its files")
        return Artefact(name=name, media_type=row.media_type, content=bytes(row.content))

    def cancel(self, number: int) -> Job:
        """Cancel a job and return it: at once if it waits or its worker is gone, else when its worker hears of it.

        A cancelled job keeps what it found, and can go on. One that has ended stays as it is.
        """
        with self._database.writing() as connection:
            job = _job(connection, number, lock=True)
            ended = select(jobs.c.lease_until < now()).where(jobs.c.id == number)
            if job.state == "queued" or (job.state == "running" and connection.scalar(ended)):
                left: dict[str, Any] = {"finished": now(), "worker": None, "lease_until": None}
                return _become(connection, job, "cancelled", "cancelled before it was done", **left)
            if job.state == "running" and not job.cancel_asked:
                values = {"cancel_asked": True, "events": job.events + 1}
                connection.execute(update(jobs).where(jobs.c.id == number).values(values))
                add_events(connection, number, job.events + 1, [("message", {"text": "asked to stop"})])
            return _job(connection, number)

    def resume(self, number: int) -> Job:
        """Queue a cancelled or failed job again, to go on from the generations that it has, and return it.

        Raises `InputError` for a job in another state.
        """
        with self._database.writing() as connection:
            job = _job(connection, number, lock=True)
            if job.state not in RESUMABLE:
                raise InputError(
                    f"only a cancelled or failed job can go on; job {number} is {job.state}; submit it anew"
                )
            again = {"attempts": 0, "cancel_asked": False, "due": now(), "finished": None}
            return _become(connection, job, "queued", "resumed", **again)

    def delete(self, number: int) -> None:
        """Delete a job that has ended and everything of it. Raises `InputError` for a job that has not."""
        with self._database.writing() as connection:
            job = _job(connection, number, lock=True)
            if job.state not in ENDED:
                raise InputError(
                    f"only a job that has ended can be deleted; job {number} is {job.state}; cancel it first"
                )
            connection.execute(delete(jobs).where(jobs.c.id == number))

    def claim(self, worker: str, *, lease: float = LEASE) -> Claim | None:
        """Give the foremost waiting job to a worker for `lease` s; None if no job waits. See `claiming.claim_next`."""
        if not 0.0 < lease <= 3600.0:
            raise InputError(f"a lease lasts more than 0 s and at most an hour; got {lease} s")
        with self._database.reading() as connection:
            if not any_claimable(connection):
                return None
        with self._database.writing() as connection:
            job = claim_next(connection, worker, lease)
        return None if job is None else Claim(self._database, job, lease)

    def greet(self, worker: str) -> None:
        """Note that a worker is there; forget those that have been silent for days."""
        with self._database.writing() as connection:
            seen = update(workers).where(workers.c.id == worker).values(seen=now())
            if not connection.execute(seen).rowcount:
                connection.execute(delete(workers).where(workers.c.seen < now() - _FORGOTTEN))
                connection.execute(insert(workers).values(id=worker, started=now(), seen=now()))

    def part(self, worker: str) -> None:
        """Note that a worker has left."""
        with self._database.writing() as connection:
            connection.execute(delete(workers).where(workers.c.id == worker))

    def workers(self) -> list[Worker]:
        """Return all workers that came and have not left, the one heard of last first."""
        query = select(*workers.c, (now() - workers.c.seen).label("silent")).order_by(workers.c.seen.desc())
        with self._database.reading() as connection:
            return [Worker(**row._mapping) for row in connection.execute(query)]


def _job(connection: Connection, number: int, *, lock: bool = False) -> Job:
    query = select(*SHOWN).where(jobs.c.id == number)
    row = connection.execute(query.with_for_update() if lock else query).first() if 0 < number < 2**63 else None
    if row is None:
        raise InputError(f"there is no job {number}; list the jobs")
    return job_of(row)


def _become(connection: Connection, job: Job, state: State, reason: str, **changes: Any) -> Job:
    values = {"state": state, "reason": reason, "events": job.events + 1, **changes}
    connection.execute(update(jobs).where(jobs.c.id == job.id).values(values))
    add_events(connection, job.id, job.events + 1, [state_event(state, reason)])
    return _job(connection, job.id)


def _require_bounds(priority: int, key: str | None, most_attempts: int, most_seconds: float | None) -> None:
    if not (abs(priority) <= 1000 and 1 <= most_attempts <= 1000):
        raise InputError(
            f"a job has a priority from -1000 to 1000 and 1 to 1000 attempts; got {priority} and {most_attempts}; "
            "choose within these"
        )
    if key is not None and not (0 < len(key) <= 255 and key.isprintable()):
        raise InputError(f"a key has 1 to 255 printable characters; got {key[:300]!r}; choose another one")
    if most_seconds is not None and not 0.0 < most_seconds < math.inf:
        raise InputError(f"a search may take more than 0 s; got a limit of {most_seconds} s; leave it out for no limit")
