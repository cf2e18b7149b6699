"""`slidercrank doctor`: what it looks at, and that its exit code says whether anything is wrong."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import sqlite3
import sys
from collections import namedtuple
from pathlib import Path

import pytest
from sqlalchemy import update

from slidercrank.service.store import Store
from slidercrank.service.store.database import Database
from slidercrank.service.store.database_clock import now
from slidercrank.service.store.schema import workers
from tests.service.conftest import Command
from tests.service.store.contents import add, claim_waiting_job, end_lease, result

needs_proc = pytest.mark.skipif(sys.platform != "linux", reason="/proc is a folder of Linux")


@pytest.fixture
def file(runs: Path) -> Path:
    """Return where the store is, in a folder that is there."""
    runs.mkdir()
    return runs / "slidercrank.db"


def checks_by_name(command: Command, *options: object) -> tuple[int, dict[str, tuple[str, str]]]:
    """Return the exit code, and grade and text of every check by its name."""
    done = command("doctor", "--json", *options)
    found = json.loads(done.stdout)
    assert found["healthy"] == (done.exit_code == 0)
    return done.exit_code, {check["name"]: (check["grade"], check["text"]) for check in found["checks"]}


def test_a_fresh_machine_is_healthy_and_stays_as_it_is(runs: Path, command: Command) -> None:
    code, found = checks_by_name(command)
    assert code == 0
    assert found["store"] == ("ok", f"no store at {runs / 'slidercrank.db'} yet; the first job creates it")
    assert "slidercrank 0." in found["versions"][1]
    assert not runs.exists()


def test_a_store_in_use_is_healthy(file: Path, command: Command) -> None:
    with Store(file) as store:
        store.register("one")
        add(store)
        claim_waiting_job(store).finish(result())
        add(store)
        code, found = checks_by_name(command)
    assert code == 0
    assert {name: grade for name, (grade, _) in found.items() if grade != "ok"} == {}
    assert found["jobs"] == ("ok", "1 done, 1 queued")
    assert found["workers"] == ("ok", "1 running")
    text = command("doctor").stdout
    assert "ok       integrity          no damage found\n" in text


def test_jobs_that_wait_without_a_worker_are_a_problem(file: Path, command: Command) -> None:
    with Store(file) as store:
        add(store)
    code, found = checks_by_name(command)
    assert (code, found["workers"][0]) == (1, "problem")
    assert "1 job waiting without a worker; start slidercrank serve or slidercrank worker" in found["workers"][1]


def test_ended_leases_and_silent_workers_are_told(file: Path, command: Command) -> None:
    with Store(file) as store:
        for name in ("one", "lost"):
            store.register(name)
        add(store)
        claim_waiting_job(store, "lost")
        database = Database(file)
        with database.writing() as connection:
            connection.execute(update(workers).where(workers.c.id == "lost").values(seen=now() - 300.0))
        database.close()
        end_lease(str(file), 1)
        code, found = checks_by_name(command)
    assert code == 0
    assert found["workers"] == ("note", "1 running; 1 not heard from for more than 120 s: stopped or disconnected")
    assert found["leases"] == ("note", "the leases of jobs 1 have expired; the next free worker continues them")


def test_what_is_no_database_is_a_problem(file: Path, command: Command) -> None:
    file.write_text("no database")
    code, found = checks_by_name(command)
    assert (code, found["store"][0]) == (1, "problem")
    assert "file is not a database" in found["store"][1]


def test_a_store_of_a_later_release_is_a_problem_and_stays_as_it_is(file: Path, command: Command) -> None:
    Store(file).close()
    with sqlite3.connect(file) as connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
    connection.close()
    code, found = checks_by_name(command)
    assert (code, found["tables"][0]) == (1, "problem")
    assert "their version is 9999, but this release supports" in found["tables"][1]
    with sqlite3.connect(file) as connection:
        assert connection.execute("SELECT version_num FROM alembic_version").fetchall() == [("9999",)]
    connection.close()


def test_a_database_without_tables_is_noted_and_gets_none(file: Path, command: Command) -> None:
    with contextlib.closing(sqlite3.connect(file)) as fresh:
        fresh.execute("PRAGMA user_version = 1")
    code, found = checks_by_name(command)
    assert (code, found["tables"][0]) == (0, "note")
    connection = sqlite3.connect(file)
    assert connection.execute("SELECT count(*) FROM sqlite_master").fetchone() == (0,)
    connection.close()


def test_a_file_that_may_not_be_written_is_a_problem(
    file: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    Store(file).close()
    monkeypatch.setattr(os, "access", lambda path, _mode: Path(path).stat().st_mode & 0o600 == 0o600)
    assert checks_by_name(command)[0] == 0
    file.chmod(0o400)
    code, found = checks_by_name(command)
    assert (code, found["permissions"][0]) == (1, "problem")
    assert f"chmod u+rw {file}" in found["permissions"][1]


def test_a_server_that_is_away_is_a_problem(command: Command) -> None:
    code, found = checks_by_name(command, "--store", "postgresql://nobody:secret@/none?host=/no/such/place")
    assert (code, found["store"][0]) == (1, "problem")
    assert "must be a database that can be reached" in found["store"][1]
    assert "secret" not in found["store"][1]


@pytest.mark.parametrize(("free", "grade", "code"), [(1e6, "problem", 1), (1e9, "note", 0), (1e10, "ok", 0)])
def test_a_full_disk_is_a_problem(
    free: float, grade: str, code: int, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage(0, 0, free))
    got, found = checks_by_name(command)
    assert (got, found["disk of runs"][0]) == (code, grade)


@needs_proc
def test_a_place_that_cannot_be_written_is_a_problem(command: Command) -> None:
    code, found = checks_by_name(command, "--runs", "/proc/none")
    assert (code, found["runs"][0]) == (1, "problem")
    assert "/proc/none is not writable" in found["runs"][1]


@needs_proc
def test_a_model_that_would_be_compiled_anew_every_time_is_a_problem(
    command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", "/proc/none")
    code, found = checks_by_name(command)
    assert (code, found["compiled model"][0]) == (1, "problem")


def test_a_backup_is_made_and_checked_in_one_go(file: Path, tmp_path: Path, command: Command) -> None:
    with Store(file) as store:
        store.register("one")
        add(store)
        done = command("doctor", "--backup", tmp_path / "backup.db")
    assert done.exit_code == 0
    assert f"{tmp_path / 'backup.db'}: a copy of" in done.stderr
    with Store(tmp_path / "backup.db") as copied:
        assert [job.name for job in copied.jobs()] == ["Feeder"]


def test_without_a_store_there_is_no_backup(command: Command, tmp_path: Path) -> None:
    done = command("doctor", "--backup", tmp_path / "backup.db")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "there is no store at" in done.stderr
    assert not (tmp_path / "backup.db").exists()


def test_a_store_that_was_deleted_is_a_problem(file: Path, command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    with Store(file) as store:
        add(store)
        file.unlink()
        code, found = checks_by_name(command)
        assert (code, found["store"][0]) == (1, "problem")
        assert "a write-ahead log must have its store beside it" in found["store"][1]
    for left in file.parent.iterdir():
        left.unlink()
    assert checks_by_name(command)[0] == 0
    assert checks_by_name(command, "--store", file)[0] == 1, "somebody says that there is one"
    monkeypatch.setenv("SLIDERCRANK_STORE", str(file))
    assert checks_by_name(command)[0] == 1


def test_a_store_that_others_may_read_is_noted(file: Path, command: Command) -> None:
    Store(file).close()
    assert "permissions" not in checks_by_name(command)[1]
    file.chmod(0o644)
    code, found = checks_by_name(command)
    assert (code, found["permissions"][0]) == (0, "note")
    assert f"chmod 600 {file}" in found["permissions"][1]


@pytest.mark.parametrize("made", ["CREATE TABLE parts(name)", "CREATE TABLE alembic_version(version_num)"])
def test_a_database_of_something_else_is_a_problem_and_gets_no_tables(made: str, file: Path, command: Command) -> None:
    connection = sqlite3.connect(file)
    connection.execute(made)
    connection.commit()
    names = "SELECT name FROM sqlite_master"
    before = connection.execute(names).fetchall()
    if "alembic" in made:
        connection.execute("INSERT INTO alembic_version VALUES ('9999')")
        connection.commit()
    done = command("jobs")
    assert done.exit_code == 2
    assert "a store must be a database of its own" in done.stderr
    assert connection.execute(names).fetchall() == before
    connection.close()
    code, found = checks_by_name(command)
    assert (code != 0, found["tables"][0]) == (True, "problem")
