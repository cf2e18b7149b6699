"""Maintenance of a store: its damage, clock and server, and a copy of it."""

import contextlib
import json
import os
import sqlite3
import time
from pathlib import Path

from sqlalchemy import ColumnElement, Connection, FromClause, func, select, text

from ...model.errors import InputError, StoreError
from ..runs.run_folder import flush_to_disk
from .database import Database, Unavailable
from .database_clock import now
from .job_rows import require_checksum
from .schema import designs, events, exact, jobs, records

_MOST = 5  # maximum number of items named for each type of damage
_SETTINGS = ("fsync", "full_page_writes")
"""PostgreSQL settings without which committed data may not survive a crash."""


def damages(database: Database) -> list[str]:
    """Return sentences on damage to the database itself, and on jobs with wrong row counts or damaged results.

    Raises `StoreError` if it cannot be reached.
    """
    try:
        with database.reading() as connection:
            damage = _sqlite_damage(connection) if database.sqlite else _postgresql_damage(connection)
            return (
                damage or _jobs_with_miscounts(connection) or _damaged_results(connection)
            )  # damaged data need not be counted
    except Unavailable:
        raise
    except StoreError as error:  # a file may be too damaged to be searched
        return [str(error)]


def clock_ahead(database: Database) -> float:
    """Return the time, s, by which the database clock is ahead of the clock of this machine."""
    with database.reading() as connection:
        before = time.time()
        database_time = connection.execute(select(now())).scalar_one()
        return database_time - 0.5 * (before + time.time())


def server_version(database: Database) -> str:
    """Return the name and version of the database."""
    query = "SELECT sqlite_version()" if database.sqlite else "SHOW server_version"
    with database.reading() as connection:
        number = str(connection.scalar(text(query))).split()[0]
    return f"{'SQLite' if database.sqlite else 'PostgreSQL'} {number}"


def _sqlite_damage(connection: Connection) -> list[str]:
    damage = list(connection.execute(text(f"PRAGMA integrity_check({_MOST})")).scalars())
    if damage != ["ok"]:
        return damage
    rows = connection.execute(text("PRAGMA foreign_key_check")).all()
    return [f"{row[0]} has a row for a job that does not exist" for row in rows[:_MOST]]


def _postgresql_damage(connection: Connection) -> list[str]:
    broken = connection.execute(
        text(
            "SELECT c.relname FROM pg_index i JOIN pg_class c ON c.oid = i.indexrelid "
            "JOIN pg_namespace n ON n.oid = c.relnamespace "
            "WHERE n.nspname = ANY (current_schemas(false)) AND NOT (i.indisvalid AND i.indisready)"
        )
    ).scalars()
    damage = [f"the index {name} is not valid; REINDEX it" for name in broken]
    failures = connection.scalar(
        text("SELECT checksum_failures FROM pg_stat_database WHERE datname = current_database()")
    )
    if failures:
        damage.append(f"{failures} pages failed their checksum; restore a backup")
    off = [name for name in _SETTINGS if connection.scalar(text(f"SHOW {name}")) != "on"]
    return [*damage, *(f"{name} is off: a crash can lose committed data; switch it on" for name in off)]


def _jobs_with_miscounts(connection: Connection) -> list[str]:
    """Return the jobs with missing or surplus rows; one statement, so that all counts refer to the same moment."""

    def count(table: FromClause) -> ColumnElement[int]:
        return select(func.count()).where(table.c.job == jobs.c.id).scalar_subquery()

    query = select(
        jobs.c.id,
        jobs.c.summary,
        jobs.c.events,
        jobs.c.records,
        count(events).label("has_events"),
        count(records).label("has_records"),
        count(designs).label("has_designs"),
    ).order_by(jobs.c.id)
    miscounts = []
    for row in connection.execute(query):
        designs_in_summary = 0 if row.summary is None else json.loads(row.summary)["designs"]
        for kind, expected, counted in (
            ("events", row.events, row.has_events),
            ("records", row.records, row.has_records),
            ("designs", designs_in_summary, row.has_designs),
        ):
            if expected != counted:
                miscounts.append(f"job {row.id} should have {expected} {kind} but has {counted}")
    return miscounts[:_MOST]


def _damaged_results(connection: Connection) -> list[str]:
    """Return the jobs that, together with their results, do not match their checksums."""
    summed = (jobs.c.tables, jobs.c.result, jobs.c.summary)
    query = select(jobs.c.id, jobs.c.checksum, *summed).where(jobs.c.checksum.is_not(None)).order_by(jobs.c.id)
    damage = []
    for job, sums, *parts in connection.execute(query):
        cells = select(designs.c.cells).where(designs.c.job == job).order_by(designs.c.number)
        content = connection.execute(select(exact.c.content).where(exact.c.job == job)).scalar_one_or_none()
        try:
            require_checksum(sums[:64], *parts)
            require_checksum(sums[64:], *connection.execute(cells).scalars(), content)
        except ValueError as error:
            damage.append(f"the result of job {job} is damaged: {error}")
    return damage[:_MOST]


_PATIENCE = 30.0  # s to wait for other writers


def back_up(database: Database, target: Path) -> None:
    """Copy a consistent snapshot of an SQLite database into a new file, which appears only when complete.

    Jobs can be submitted and solved meanwhile. The copy is checked before it gets its name. Raises `InputError` for a
    database on a server and for an existing file, `StoreError` if it cannot be read or written.
    """
    source = database.engine.url.database
    if not database.sqlite or source is None:
        raise InputError(
            f"only a store in a file can be copied this way; got {database.name}; back it up with pg_dump, see "
            "docs/service.md"
        )
    if target.exists():
        raise InputError(f"a backup must be a new file; {target} already exists; name another one, or move it away")
    draft = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        os.close(os.open(draft, os.O_CREAT | os.O_EXCL | os.O_RDWR, 0o600))  # it contains all data of the store
        with (
            contextlib.closing(sqlite3.connect(source, timeout=_PATIENCE)) as original,
            contextlib.closing(sqlite3.connect(draft)) as copy,
        ):
            original.backup(copy)  # in one step, so that no writer can make it restart
            copy.execute("PRAGMA journal_mode=DELETE")  # so that the copy is one file
            verdict = copy.execute("PRAGMA integrity_check").fetchone()[0]
        if verdict != "ok":
            raise StoreError(
                f"a backup must be intact; the backup of {database.name} gave: {verdict}; run slidercrank doctor"
            )
        flush_to_disk(draft)
        draft.rename(target)
        flush_to_disk(target.parent)
    except (sqlite3.Error, OSError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise StoreError(
            f"a backup must go to a writable place; {target} gave: {reason}; check that the folder exists and the "
            "disk has space"
        ) from error
    finally:
        with contextlib.suppress(OSError):
            draft.unlink(missing_ok=True)
