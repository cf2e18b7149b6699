"""Inspection of a database, on both kinds: damage is found, and nothing else."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest
from sqlalchemy import delete, insert, update

from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import clock_ahead, damages, server_version
from slidercrank.service.store.database import Database
from slidercrank.service.store.schema import designs, events, jobs
from slidercrank.service.store.schema_version import stored_and_known_version
from tests.service.store.contents import add, claim_waiting_job, progress, result, search_record

UNSAFE = "fsync is off: a crash can lose committed data; switch it on"
"""The servers of the tests run so."""


def damage_found(address: str) -> list[str]:
    """Return the damage that is found."""
    database = Database(address)
    wrong = damages(database)
    database.close()
    return wrong


@pytest.fixture
def used(store: Store, address: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return the address of a store in which jobs have ended, were cancelled, and are under way."""
    monkeypatch.setattr("slidercrank.service.store.damage_check_and_backup._SETTINGS", ())
    for _ in range(4):
        add(store)
    for status in ("done", "cancelled", "infeasible"):
        claim = claim_waiting_job(store)
        claim.keep_record(search_record(0))
        claim.report(progress(1))
        claim.finish(result(status, rows=[] if status == "infeasible" else None))
    claim = claim_waiting_job(store)
    claim.keep_record(search_record(0))
    claim.report(progress(1))
    return address


def test_a_store_in_use_has_no_damages(used: str) -> None:
    assert damage_found(used) == []


def test_rows_that_are_missing_or_too_many_are_named(used: str) -> None:
    database = Database(used)
    with database.writing() as connection:
        connection.execute(delete(designs).where(designs.c.job == 1, designs.c.number == 1))
        connection.execute(insert(events).values(job=2, number=99, at=0.0, kind="message", data="{}"))
        connection.execute(update(jobs).where(jobs.c.id == 4).values(records=3))
    database.close()
    assert damage_found(used) == [
        "job 1 should have 2 designs but has 1",
        "job 2 should have 4 events but has 5",
        "job 4 should have 3 records but has 1",
    ]


def test_clock_and_version_are_those_of_the_database(store: Store, address: str) -> None:
    database = Database(address)
    assert abs(clock_ahead(database)) < 5.0
    assert server_version(database).startswith(("SQLite 3.", "PostgreSQL 1"))
    version, latest, known = stored_and_known_version(database)
    assert version == latest
    assert known
    database.close()


def test_a_server_that_does_not_write_through_is_told(server: object, tmp_path: Path) -> None:
    from tests.service.store.postgresql import Cluster

    assert isinstance(server, Cluster)
    address = server.new_address()
    with Store(address):
        database = Database(address)
        assert UNSAFE in damages(database)
        database.close()


def test_a_damaged_file_is_told(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    with Store(file) as store:
        for _ in range(50):
            add(store)
    with sqlite3.connect(file) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    connection.close()
    content = bytearray(file.read_bytes())
    # Rows of jobs alone: what tables there are is read when the store is opened.
    rows = [page for page in range(4096, len(content), 4096) if b"Feeder" in content[page : page + 4096]]
    for page in rows[-2:]:
        content[page : page + 4096] = b"\xa5" * 4096
    file.write_bytes(content)
    database = Database(file)
    assert damages(database)
    database.close()
