"""Commits that fail, one by one: each of a job's life, before and after taking effect, and for long."""

from __future__ import annotations

import contextlib
import sqlite3
import time
from collections.abc import Iterator
from typing import Any, Literal

from sqlalchemy import Connection, event
from sqlalchemy.exc import OperationalError

from slidercrank.model.errors import StoreError
from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work

from .audit import keep_audit
from .full_disk import is_intact
from .jobs import tables
from .places import Kind, place
from .stored_results import undisturbed
from .verdict import Verdict, judge

_KIND = "random 3"
_LEASE = 0.3
Failure = Literal["refused", "answer lost", "refused for long"]
_FAILURES: tuple[Failure, ...] = ("refused", "answer lost", "refused for long")


class _Failing:
    """Lets commits fail from the one of a number on. reached: whether there were so many. lifted: none fails now."""

    def __init__(self, store: Store, number: int, failure: Failure) -> None:
        self.reached = False
        self.lifted = False
        self._left = number
        self._failure = failure
        event.listen(store.engine, "commit", self._commit)

    def _commit(self, connection: Connection) -> None:
        if self.lifted or connection.get_execution_options().get("reading", False):
            return
        self._left -= 1
        if self._left > 0:
            return
        self.reached = True
        self.lifted = self._failure != "refused for long"
        raw: Any = connection.connection.dbapi_connection
        if self._failure == "answer lost":
            raw.commit()
        if isinstance(raw, sqlite3.Connection):
            raise sqlite3.OperationalError("disk I/O error")
        raise OperationalError("COMMIT", {}, Exception("the server closed the connection unexpectedly"))


def commits(kind: Kind, every: int = 1) -> tuple[int, Verdict]:
    """Let the commits of a job's life fail in every way; return their number and the verdict.

    every: only each one of so many.
    """
    expected = undisturbed()
    count = 0
    total = Verdict()
    with place(kind) as where:
        for failure in _FAILURES:
            for number in range(1, 1000, every):
                address = where.address if kind == "postgresql" else str(where.folder / f"{failure} {number}.db")
                if where.server is not None:
                    address = where.server.new_address()
                with Store(address) as store:
                    keep_audit(address)
                    failing = _Failing(store, number, failure)
                    job = _submit_and_solve(store, failing, total)
                if not failing.reached:
                    break
                count += 1
                total.add(judge(address, {job: _KIND}, expected, where.folder / "none"))
                if kind == "sqlite" and not is_intact(address):
                    total.violate("lost", f"the file is damaged after commit {number} {failure}")
    return count, total


def _submit_and_solve(store: Store, failing: _Failing, total: Verdict) -> int:
    """Submit a job and solve it, trying again after the fault where that is for the caller to do."""
    job = None
    for _ in range(10):
        with _collect_store_errors(total):
            job = submit(store, tables(_KIND), key="one", most_attempts=1000)
            work(store, name="w1", lease=_LEASE, drain=True)
            if store.job(job.id).state == "done":
                return job.id
        failing.lifted = failing.lifted or failing.reached
        time.sleep(_LEASE)
    raise SystemExit("a job did not come to its end within 10 tries")


@contextlib.contextmanager
def _collect_store_errors(total: Verdict) -> Iterator[None]:
    """Take errors of the store, as sentences; whatever else comes through is a fault of the software."""
    try:
        yield
    except StoreError as error:
        total.failed += 1
        if "the store must be" not in str(error):
            total.violate("lost", f"not a clean error: {error}")
