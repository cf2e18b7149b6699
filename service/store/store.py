"""Store of jobs, their events and their results, in one database that many processes share."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Any, Unpack

from sqlalchemy import Connection, and_, delete, func, select, update

from ...model.errors import InputError, NotFound, StoreError
from ..runs.result import Result
from ..runs.run_folder import run_name
from ..runs.runs_on_disk import result_from
from . import queue
from .claim import Claim
from .database_clock import ClockJumps, now
from .job_rows import (
    Order,
    add_events,
    change_state,
    damaged_result_error,
    evaluation_records,
    job_by_number,
    news_of,
    ordered_jobs,
    require_checksum,
    require_resumable,
    result_record,
)
from .records import ENDED, JOB_COLUMNS, NO_LIMITS, NOT_DONE, Artefact, Event, Job, Limits, News, Queueing, State
from .schema import artefacts, designs, events, exact, jobs
from .schema_version import create_or_upgrade_tables
from .serialisation import database_text, rows_from_cells, unpacked_exact
from .workers import Workers

if TYPE_CHECKING:
    from ...optimise.search.checkpoints import Record

MOST_QUEUED = 10_000
MOST_ATTEMPTS = 3
LEASE = 30.0


class Store(Workers):
    """An open store.

    Threads may share it; each process opens its own. Can be used as a context manager, which closes it.

    Every method raises `StoreError` if the database refuses or cannot be reached, and `NotFound` for a missing job.
    All data that a method has written when it returns survives a crash of the machine.
    """

    def __init__(self, address: str | PathLike[str], *, most_queued: int = MOST_QUEUED) -> None:
        """Open the store at an address: the path of a file, sqlite:///file, or postgresql://user@host/database.

        Creates or upgrades the tables. most_queued: maximum number of waiting jobs.
        """
        super().__init__(address)
        self.most_queued = most_queued
        self._jumps = ClockJumps()
        try:
            create_or_upgrade_tables(self)
        except BaseException:
            self.close()
            raise

    def require_writable(self) -> None:
        """Raise `StoreError` if jobs cannot be added."""
        with self.writing() as connection:
            queue.lock_submissions(connection)

    def submit(
        self,
        tables: Mapping[str, Any],
        *,
        name: str,
        limits: Limits = NO_LIMITS,
        files: Sequence[Artefact] = (),
        origin: int | None = None,
        **queueing: Unpack[Queueing],
    ) -> Job:
        """Queue a job and return it. The job itself is not validated; `submission.submit` checks it first.

        tables: tables of its job file. files: accompanying files, such as the original job file. origin: number of the
        job from which it was copied. queueing: see `Queueing`.

        Raises `QueueFull`, and `InputError` if the key belongs to another job.
        """
        queueing_values: Queueing = {"priority": 0, "key": None, "most_attempts": MOST_ATTEMPTS, **queueing}
        queue.require_valid_submission(**queueing_values)
        key, values = queueing_values["key"], {**queueing_values, "origin": origin}
        with self.writing() as connection:
            queue.lock_submissions(connection)  # so that two submissions can neither share a key nor overfill the queue
            earlier = queue.submitted_before(connection, key, tables) if key else None
            if earlier is None:
                queue.require_place_in_queue(connection, self.most_queued)
                number = queue.add_job(connection, tables, files, limits, name=name, run=run_name(name), **values)
        return self.job(number if earlier is None else earlier.id)

    def begin(
        self, tables: Mapping[str, Any], *, name: str, run: str, worker: str, lease: float, files: Sequence[Artefact]
    ) -> Claim:
        """Add a job that its submitter solves itself, in `run`, and return its claim. The job is never retried."""
        with self.writing() as connection:
            queue.lock_submissions(connection)
            number = queue.add_job(connection, tables, files, NO_LIMITS, name=name, run=run, most_attempts=1)
            return self._claim(connection, job_by_number(connection, number), worker, lease, f"begun by {worker}")

    def reclaim(self, number: int, *, worker: str, lease: float, alone: bool = False) -> Claim:
        """Claim a cancelled or failed job immediately, to continue it.

        alone: also allow a running job whose worker is gone.

        Raises `InputError` for a job in another state.
        """
        with self.writing() as connection:
            job = job_by_number(connection, number, lock=True)
            if not (alone and job.state == "running"):
                require_resumable(job)
            return self._claim(connection, job, worker, lease, f"taken up by {worker}")

    def _claim(self, connection: Connection, job: Job, worker: str, lease: float, reason: str) -> Claim:
        again = {"attempts": 1, "cancel_asked": False, "finished": None}
        running_job = change_state(
            connection, job, "running", reason, **{**queue.claim_changes(worker, lease), **again}
        )
        return Claim(self, running_job, lease)

    def job(self, number: int) -> Job:
        """Return a job with its state. The reason of a waiting job says whether disk space or a worker is missing."""
        with self.reading() as connection:
            stored = job_by_number(connection, number)
        return self._with_waiting_reasons([stored])[0]

    def _with_waiting_reasons(self, listed: list[Job]) -> list[Job]:
        try:
            self.require_disk_space()
        except StoreError as error:
            reason = f"waits: {error}"
            return [replace(job, reason=reason) if job.state in ("queued", "running") else job for job in listed]
        if any(job.state == "queued" and not job.reason for job in listed):
            crew = self.count_workers_and_waiting_jobs()
            busy = f"every worker is busy ({crew.workers})" if crew.workers else "no worker is running"
            reason = busy if crew.busy == crew.workers else ""
            return [replace(job, reason=reason) if job.state == "queued" and not job.reason else job for job in listed]
        return listed

    def evaluation_records(self, number: int) -> list[Record]:
        """Return the records of a job's evaluations so far, in order."""
        with self.reading() as connection:
            return evaluation_records(connection, number)

    def find_by_run(self, run: str) -> Job | None:
        """Return the job with a run folder name, or None."""
        with self.reading() as connection:
            row = connection.execute(select(*JOB_COLUMNS).where(jobs.c.run == run)).first()
        return None if row is None else Job.from_row(row)

    def jobs(
        self,
        *,
        states: Collection[State] = (),
        name: str = "",
        before: int | None = None,
        numbers: Collection[int] = (),
        limit: int = 100,
        order: Order = "newest",
    ) -> list[Job]:
        """Return jobs in an order. states: states to include, all if empty. name: part of the name, ignoring case.

        before: number of a job; only jobs after it in this order, for paging. numbers: numbers to include, all if
        empty. limit: maximum number of jobs.
        """
        query = ordered_jobs(select(*JOB_COLUMNS), order, before).limit(limit)
        if numbers:
            query = query.where(jobs.c.id.in_(numbers))
        if states:
            query = query.where(jobs.c.state.in_(states))
        if name:
            query = query.where(jobs.c.name.icontains(database_text(name), autoescape=True))
        with self.reading() as connection:
            listed = [Job.from_row(row) for row in connection.execute(query)]
        return self._with_waiting_reasons(listed)

    def count_by_state(self) -> dict[str, int]:
        """Return the number of jobs in each state that occurs."""
        with self.reading() as connection:
            rows = connection.execute(select(jobs.c.state, func.count()).group_by(jobs.c.state)).all()
        return {row.state: int(row[1]) for row in rows}

    def longest_wait(self) -> float:
        """Return the waiting time, s, of the oldest job that a worker may claim; 0 if none waits."""
        waiting = and_(jobs.c.state == "queued", jobs.c.due <= now())
        with self.reading() as connection:
            return connection.scalar(select(now() - func.min(jobs.c.due)).where(waiting)) or 0.0

    def job_tables(self, number: int) -> dict[str, Any]:
        """Return the tables of a job's file."""
        with self.reading() as connection:
            job_by_number(connection, number)
            text = connection.execute(select(jobs.c.tables).where(jobs.c.id == number)).scalar_one()
        tables: dict[str, Any] = json.loads(text)
        return tables

    def events(self, number: int, *, after: int = 0, limit: int = 1000) -> list[Event]:
        """Return at most `limit` events of a job after a given number, in order."""
        query = select(events).where(and_(events.c.job == number, events.c.number > after))
        with self.reading() as connection:
            job_by_number(connection, number)
            return [Event.from_row(row) for row in connection.execute(query.order_by(events.c.number).limit(limit))]

    def news(self, after: Mapping[int, int], *, limit: int = 1000) -> dict[int, News]:
        """Return the news of jobs after a given event of each, at most `limit` events per job."""
        with self.reading() as connection:
            return news_of(connection, after, limit)

    def result_record(self, number: int) -> dict[str, Any]:
        """Return the result of a job as in `Result.record`, with "count" and "columns" in place of the designs.

        Raises `RunError` if it has no result (yet), or a damaged one.
        """
        with self.reading() as connection:
            job = job_by_number(connection, number)
            record, _ = result_record(connection, job)
            if job.summary is not None:
                return {**record, "count": job.summary["designs"]}
            # Only results in the earliest stores have none.
            count = select(func.count()).select_from(designs).where(designs.c.job == number)
            return {**record, "count": connection.execute(count).scalar_one()}

    def result(self, number: int) -> Result:
        """Return the result of a job. Raises `RunError` if it has no result (yet), or a damaged one."""
        with self.reading() as connection:
            stored, expected = result_record(connection, job_by_number(connection, number))
            cells = select(designs.c.cells).where(designs.c.job == number).order_by(designs.c.number)
            cell_texts = connection.execute(cells).scalars().all()
            content = connection.execute(select(exact.c.content).where(exact.c.job == number)).scalar_one_or_none()
        try:
            require_checksum(expected, *cell_texts, content)
            columns = stored.pop("columns")
            exact_designs = None if content is None else unpacked_exact(content)
            return result_from(stored, rows_from_cells(columns, cell_texts), str(stored["run"]), exact_designs)
        except (ValueError, KeyError, TypeError) as error:
            raise damaged_result_error(number, error) from error

    def artefact_names(self, number: int) -> list[str]:
        """Return the names of a job's files, in alphabetical order."""
        with self.reading() as connection:
            job_by_number(connection, number)
            return sorted(connection.execute(select(artefacts.c.name).where(artefacts.c.job == number)).scalars())

    def artefact(self, number: int, name: str) -> Artefact:
        """Return a file of a job. Raises `NotFound` if there is no file with that name."""
        of_file = and_(artefacts.c.job == number, artefacts.c.name == name)
        with self.reading() as connection:
            row = connection.execute(select(artefacts.c.media_type, artefacts.c.content).where(of_file)).first()
        if row is None:
            raise NotFound(f"job {number} has no file {name!r}; choose one of its files")
        return Artefact(name=name, media_type=row.media_type, content=bytes(row.content))

    def cancel(self, number: int) -> Job:
        """Cancel and return a job: immediately if no worker has it, otherwise when its worker notices.

        A cancelled job keeps its result so far, and can be resumed. An ended job does not change.
        """
        with self.writing() as connection:
            job = job_by_number(connection, number, lock=True)
            ended = select(queue.ENDED_LEASE).where(jobs.c.id == number)
            if job.state == "queued" or (job.state == "running" and connection.scalar(ended)):
                left: dict[str, Any] = {"finished": now(), "worker": None, "lease_until": None}
                return change_state(connection, job, "cancelled", NOT_DONE, **left)
            if job.state == "running" and not job.cancel_asked:
                values = {"cancel_asked": True, "events": job.events + 1}
                connection.execute(update(jobs).where(jobs.c.id == number).values(values))
                add_events(connection, number, job.events + 1, [("message", {"text": "asked to stop"})])
            return job_by_number(connection, number)

    def resume(self, number: int) -> Job:
        """Queue a cancelled or failed job again, to continue from its records, and return it.

        Raises `InputError` for a job in another state.
        """
        with self.writing() as connection:
            job = job_by_number(connection, number, lock=True)
            require_resumable(job)
            again = {"attempts": 0, "cancel_asked": False, "due": now(), "finished": None}
            change_state(connection, job, "queued", "resumed", **again)
        return self.job(number)

    def delete(self, number: int) -> None:
        """Delete an ended job and all its data. Raises `InputError` for a job that has not ended."""
        with self.writing() as connection:
            job = job_by_number(connection, number, lock=True)
            if job.state not in ENDED:
                raise InputError(
                    f"only a job that has ended can be deleted; job {number} is {job.state}; cancel it first"
                )
            connection.execute(delete(jobs).where(jobs.c.id == number))

    def claim(self, worker: str, *, lease: float = LEASE, most_running: int | None = None) -> Claim | None:
        """Give the first waiting job to a worker for `lease` s; None if there is none at present.

        See `queue.claim_next`.

        most_running: maximum number of jobs held by workers simultaneously; None for no limit. Raises `Full` if a job
        waits and the disk is full: its claim may fit into the files, but not its records.
        """
        if not 0.0 < lease <= 3600.0:
            raise InputError(f"a lease must last more than 0 s and at most an hour; got {lease} s")
        with self.reading() as connection:
            if not queue.any_claimable(connection, self._jumps, self.last_full):
                return None
        self.require_disk_space()
        with self.writing() as connection:
            if most_running is not None:
                queue.lock_submissions(connection)
                if queue.count_running(connection) >= most_running:
                    return None
            job = queue.claim_next(connection, worker, lease)
        return None if job is None else Claim(self, job, lease)
