"""Claim of a worker on a job: all writes for the job go through its claim."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from sqlalchemy import ColumnElement, Connection, and_, case, delete, insert, select, update

from ...model.errors import LeaseLost
from ..runs.result import Result, json_ready
from .database import Database, Full, Unavailable
from .database_clock import JUMP, later, now
from .job_rows import NewEvent, add_events, evaluation_records, state_event
from .queue import MOST_DELAY, write_files
from .records import NOT_DONE, Artefact, Job
from .schema import designs, exact, jobs, records, workers
from .serialisation import (
    cells_json,
    checksum,
    compact_json,
    database_text,
    packed_exact,
    packed_record,
    result_summary,
)

if TYPE_CHECKING:
    from ...optimise.front.progress import Progress
    from ...optimise.search.checkpoints import Record

_log = logging.getLogger(__name__)
_REPORT_AFTER = 1.0  # s after which a waiting write is reported
_PAUSE = 0.25  # s between two attempts of a write that the database rejected
Writer = Callable[[Connection], None]
Patience = Callable[[float], bool]
"""Whether a write waits for space after finding the disk full; called with the time waited so far, s."""


def _no_patience(_: float) -> bool:
    return False


class Claim:
    """Right to write to a job until its lease ends.

    Every write is one transaction. It takes effect only if the fence is still that of this claim and the lease has
    ended neither by the monotonic clock of this process nor by the database clock, which may jump. Otherwise nothing is
    written and `LeaseLost` is raised, even if no other worker has claimed the job yet. Every write renews the lease. A
    write that the database rejects, or whose answer is lost, is retried while the lease lasts, and takes effect once.
    Threads may share a claim.

    A write that finds the disk full waits for free space, while other threads renew the lease, which takes less space.
    If even the renewal fails, no other worker can claim the job either, and this one keeps it until another can.

    has_started: whether its search has evaluated anything yet. astray: whether the lease ends at a wrong time because
    the database clock has jumped; it must be renewed. patient: whether a write waits for free space. waits: reason why
    a write waits; empty if none waits. waited: time that writes have waited for free space, s.
    """

    def __init__(self, database: Database, job: Job, lease: float) -> None:
        """Create the claim on a job that was just claimed. lease: duration of the lease, s."""
        self.job = job
        self.lease = lease
        self.cancel_asked = job.cancel_asked
        self.has_started = False
        self._database = database
        self._lock = threading.Condition()
        self._writes = 0
        self._attempts = job.attempts
        self._records = job.records
        self._unsent: list[Record] = []
        self._renewed = time.monotonic()
        self.astray = False
        self.patient: Patience = lambda _: True
        self.waits = ""
        self.waited = 0.0

    @property
    def seconds_since_renewal(self) -> float:
        """Time since the lease was last renewed, s."""
        return time.monotonic() - self._renewed

    def evaluation_records(self) -> list[Record]:
        """Return the records of the job's evaluations so far, in order."""
        with self._database.reading() as connection:
            return evaluation_records(connection, self.job.id)

    def keep_record(self, record: Record) -> None:
        """Accept the next record; it is written with the next progress report, or at the end."""
        with self._lock:
            self.has_started = True
            self._unsent.append(record)

    def report(self, progress: Progress, front: Mapping[str, Any] | None = None) -> None:
        """Write the progress of the search and the records since the last report. Loading does not count as a start.

        front: some designs on the front so far, as JSON. Only the latest is stored, with the job: a front in each event
        would inflate a store with many runs.
        """
        self.has_started = self.has_started or not progress.is_preparing
        data = json_ready(asdict(progress), gaps=True)
        standing = data if front is None else {**data, "front": json_ready(front, gaps=True)}
        self._write({"progress": compact_json(standing)}, [("progress", data)])

    def renew(self) -> None:
        """Renew the lease and check for cancellation; additionally writes only the reason why a write waits."""
        with self._lock:  # otherwise the write may end its wait meanwhile
            self._write(
                {"reason": database_text(self.waits)} if self.waits else {}, [], keep=False, patient=_no_patience
            )

    def refresh_cancellation(self) -> None:
        """Check for cancellation of the job without writing. Raises `LeaseLost` if another worker has claimed it."""
        left = (jobs.c.lease_until - now()).label("left")
        query = select(jobs.c.cancel_asked, left).where(self._is_held_row, jobs.c.state == "running")
        with self._database.reading() as connection:
            row = connection.execute(query).first()
        if row is None:
            raise self._lease_lost_error()
        self.cancel_asked = self.cancel_asked or row.cancel_asked
        self.astray = not 0.5 * self.lease <= row.left <= self.lease + JUMP

    def add_message(self, text: str) -> None:
        """Add a message to the events of the job."""
        self._write({}, [("message", {"text": database_text(text)})])

    def start_over(self, reason: str) -> None:
        """Delete all records: the search restarts. reason: reason for the events of the job."""
        with self._lock:
            self._unsent = []
            of_job = records.c.job == self.job.id

            def forget(connection: Connection) -> None:
                connection.execute(delete(records).where(of_job))

            self._write({"records": 0}, [("message", {"text": database_text(reason)})], forget)
            self._records = 0

    def write_files(self, *files: Artefact) -> None:
        """Write files of the job, replacing those with the same names."""
        self._write({}, [], lambda connection: write_files(connection, self.job.id, files))

    def finish(self, result: Result, files: Sequence[Artefact] = ()) -> None:
        """Write the result and end the job as done, infeasible or cancelled, all in one transaction."""
        record = result.record()
        del record["designs"]
        record["columns"] = list(result.designs[0]) if result.designs else []
        rows = [
            {"job": self.job.id, "number": number, "cells": cells_json(row)}
            for number, row in enumerate(result.designs)
        ]
        content = None if result.exact is None else packed_exact(result.exact)

        left: dict[str, Any] = {} if result.status == "cancelled" else {"records": 0}
        texts = {"result": compact_json(record), "summary": compact_json(result_summary(result))}

        def write_result(connection: Connection) -> None:
            of_job = jobs.c.id == self.job.id
            sums = checksum(connection.scalar(select(jobs.c.tables).where(of_job)), *texts.values())
            sums += checksum(*(str(row["cells"]) for row in rows), content)
            connection.execute(update(jobs).where(of_job).values(checksum=sums))
            for table in (designs, exact):
                connection.execute(delete(table).where(table.c.job == self.job.id))
            if rows:
                connection.execute(insert(designs), rows)
            if content is not None:
                connection.execute(insert(exact), {"job": self.job.id, "content": content})
            write_files(connection, self.job.id, files)
            if result.status != "cancelled":  # a cancelled job can be resumed
                connection.execute(delete(records).where(records.c.job == self.job.id))

        self._end(result.status, result.message, {**texts, **left}, write_result)

    def fail(self, reason: str, *, again: bool, delay: float = 0.0) -> None:
        """Return the job to the queue after an error.

        again: whether another attempt may succeed; the job is then queued again after `delay` s, at most a minute,
        unless no attempts are left. Otherwise it is set aside as failed.
        """
        attempts = 0 if self._unsent else self._attempts
        tries = f" (attempt {attempts} of {self.job.most_attempts})" if again and attempts else ""
        if again and attempts < self.job.most_attempts:
            self._end_without_result(
                "queued", f"{reason}{tries}", {"due": later(min(delay, MOST_DELAY)), "finished": None}
            )
        else:
            self._end_without_result("failed", f"{reason}{tries}", {})

    def end_as_cancelled(self, reason: str = NOT_DONE) -> None:
        """End the job as cancelled, with the result from before this claim."""
        self._end_without_result("cancelled", reason, {})

    def hand_back(self, reason: str, *, delay: float = 0.0) -> None:
        """Queue the job again unchanged, without counting the attempt: the job did not cause the stop.

        delay: time until it may be claimed, s, at most a minute.
        """
        fewer = case((jobs.c.attempts > 0, jobs.c.attempts - 1), else_=0)
        due = {"due": later(min(delay, MOST_DELAY))} if delay else {}
        self._end_without_result("queued", reason, {"finished": None, "attempts": fewer, **due})

    def release(self) -> None:
        """End the lease immediately, regardless of clocks, unless another worker has the job."""
        with self._database.writing() as connection:
            connection.execute(update(jobs).where(self._is_held_row, jobs.c.state == "running").values(lease_until=0.0))

    def _end_without_result(self, state: str, reason: str, changes: dict[str, Any]) -> None:
        """End the claim without a result. Records that do not fit on the disk are omitted: they are recomputed."""
        try:
            self._end(state, reason, changes, patient=_no_patience)
        except Full:
            self._end(state, reason, changes, keep=False, patient=lambda _: self.seconds_since_renewal <= self.lease)

    def _end(
        self, state: str, reason: str, changes: dict[str, Any], also_write: Writer | None = None, **options: Any
    ) -> None:
        reason = database_text(reason)
        ended = {"state": state, "reason": reason, "worker": None, "lease_until": None, "finished": now()}
        self._write({**ended, **changes}, [state_event(state, reason)], also_write, **options)

    def _write(
        self,
        changes: dict[str, Any],
        new_events: Sequence[NewEvent],
        also_write: Writer | None = None,
        *,
        keep: bool = True,
        patient: Patience | None = None,
    ) -> None:
        tried, full, reported, began = False, False, False, time.monotonic()
        with self._lock:
            try:
                while True:
                    try:
                        self._write_in_transaction(
                            {"reason": "", **changes} if full else changes,
                            new_events,
                            also_write,
                            keep=keep,
                            tried=tried,
                        )
                        return
                    except Unavailable as error:
                        waited, disk_full = time.monotonic() - began, isinstance(error, Full)
                        if not (
                            (patient or self.patient)(waited) if disk_full else self.seconds_since_renewal <= self.lease
                        ):
                            raise
                        if waited > _REPORT_AFTER and not reported:
                            _log.warning("waits to write: %s", error)
                            reported = True
                        if disk_full:
                            full, self.waits = True, f"waits: {error}"
                            self._lock.wait(_PAUSE)  # other threads write meanwhile
                        else:
                            tried = True
                            time.sleep(_PAUSE)  # other threads must not write: this write may have taken effect
            finally:
                if full:
                    self.waits = ""
                    self.waited += time.monotonic() - began

    def _write_in_transaction(
        self,
        changes: dict[str, Any],
        new_events: Sequence[NewEvent],
        also_write: Writer | None,
        *,
        keep: bool,
        tried: bool,
    ) -> None:
        """Write everything in one transaction. tried: whether an earlier attempt may already have taken effect."""
        pending, started = self._unsent if keep else [], time.monotonic()
        rows = [
            {"job": self.job.id, "number": number, "content": packed_record(record)}
            for number, record in enumerate(pending, self._records)
        ]
        values: dict[str, Any] = {
            "writes": self._writes + 1,
            "events": jobs.c.events + len(new_events),
            "lease_until": later(self.lease),
            "records": self._records + len(rows),
        }
        if rows:
            values["attempts"] = 0  # the job makes progress, so earlier failures do not count
        condition = and_(self._is_held_row, jobs.c.state == "running", jobs.c.writes == self._writes)
        if self.seconds_since_renewal > self.lease and not self.waits:
            condition = and_(condition, jobs.c.lease_until > now())
        change = (
            update(jobs).where(condition).values({**values, **changes}).returning(jobs.c.events, jobs.c.cancel_asked)
        )
        with self._database.writing() as connection:
            row = connection.execute(change).first()
            if row is not None:
                self.cancel_asked = self.cancel_asked or row.cancel_asked
                add_events(connection, self.job.id, row.events, new_events)
                if rows:
                    connection.execute(insert(records), rows)
                connection.execute(update(workers).where(workers.c.id == self.job.worker).values(seen=now()))
                if also_write is not None:
                    also_write(connection)
            elif not tried or connection.scalar(select(jobs.c.writes).where(self._is_held_row)) != self._writes + 1:
                raise self._lease_lost_error()  # otherwise written: only the answer to an earlier attempt was lost
        self._renewed, self.astray = started, False
        self._writes += 1
        self._records += len(rows)
        self._unsent = self._unsent[len(pending) :]
        self._attempts = 0 if rows else self._attempts

    @property
    def _is_held_row(self) -> ColumnElement[bool]:
        return and_(jobs.c.id == self.job.id, jobs.c.fence == self.job.fence)

    def _lease_lost_error(self) -> LeaseLost:
        return LeaseLost(
            f"only the holder of a lease may write to a job; claim {self.job.fence} of job {self.job.id} has lost "
            "it; leave the job: another worker continues from what was committed"
        )
