"""How databases are opened, what their tables are, and what happens when they refuse."""

from __future__ import annotations

import contextlib
import os
import random
import shutil
import string
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import Connection, create_engine, text

from slidercrank.model.errors import InputError, LeaseLost, MissingExtra, StoreError
from slidercrank.service.store import Artefact, Store
from slidercrank.service.store.address import store_file_exists, without_secrets
from slidercrank.service.store.damage_check_and_backup import back_up, damages
from slidercrank.service.store.database import Database, Unavailable
from slidercrank.service.store.queue import claim_next
from slidercrank.service.store.schema import metadata
from tests.service.conftest import Command
from tests.service.fronts import job_file
from tests.service.store.contents import add, all_rows, claim_waiting_job, end_lease, progress, result, search_record
from tests.service.store.postgresql import Cluster


@pytest.fixture
def database(address: str) -> Iterator[Database]:
    """Return the database of an empty store, once of each kind."""
    Store(address).close()
    opened = Database(address)
    yield opened
    opened.close()


def test_the_migrated_tables_are_those_that_the_code_knows(database: Database) -> None:
    with database.reading() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True, "compare_server_default": False})
        assert compare_metadata(context, metadata) == []


def test_a_store_of_a_later_release_is_refused_and_left_as_it_is(database: Database, address: str) -> None:
    with database.writing() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(StoreError, match="has version 9999, this release supports 0009"):
        Store(address)
    with database.reading() as connection:
        assert connection.scalar(text("SELECT version_num FROM alembic_version")) == "9999"


def test_many_may_open_a_new_store_at_the_same_moment(address: str) -> None:
    def open_and_add(_: int) -> int:
        with Store(address) as store:
            return add(store).id

    with ThreadPoolExecutor(6) as pool:
        assert sorted(pool.map(open_and_add, range(6))) == [1, 2, 3, 4, 5, 6]


@pytest.mark.parametrize("step", range(4))
def test_another_may_create_the_store_at_every_step_of_the_check(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: int
) -> None:
    file = tmp_path / "store.db"
    stat = Path.stat
    calls = 0
    others: list[Store] = []

    def stat_after_another_created_it(path: Path, **options: bool) -> os.stat_result:
        nonlocal calls
        calls += 1
        if calls == step + 1:
            with monkeypatch.context() as undisturbed:
                undisturbed.setattr(Path, "stat", stat)
                others.append(Store(file))
        return stat(path, **options)

    monkeypatch.setattr(Path, "stat", stat_after_another_created_it)
    assert store_file_exists(file)
    others[0].close()


def test_commits_of_sqlite_are_on_the_disk_and_writers_take_turns_from_the_beginning(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    Store(file).close()
    one, other = Database(file), Database(f"sqlite:///{file}")
    with one.reading() as connection:
        pragmas = ("journal_mode", "synchronous", "foreign_keys")
        assert [connection.scalar(text(f"PRAGMA {name}")) for name in pragmas] == ["wal", 2, 1]
    with other.engine.connect() as impatient:
        impatient.exec_driver_sql("PRAGMA busy_timeout=0")  # of the connection that goes back into the pool
    with one.writing():  # has written nothing yet
        with other.reading() as connection:
            assert connection.scalar(text("SELECT count(*) FROM jobs")) == 0
        with pytest.raises(Unavailable, match="database is locked"), other.writing():
            pass
    one.close()
    other.close()


def test_commits_of_postgresql_are_on_the_disk_and_no_session_sleeps_in_a_transaction(server: Cluster) -> None:
    database = Database(server.new_address())
    with database.reading() as connection:
        names = ("synchronous_commit", "idle_in_transaction_session_timeout", "lock_timeout")
        assert [connection.scalar(text(f"SHOW {name}")) for name in names] == ["on", "10s", "30s"]
    database.close()


def test_the_clock_goes_on_within_a_transaction(database: Database) -> None:
    from sqlalchemy import select

    from slidercrank.service.store.database_clock import now

    with database.writing() as connection:
        first = connection.scalar(select(now()))
        second = first
        while second == first:
            second = connection.scalar(select(now()))
    assert first is not None
    assert second is not None
    assert 1.7e9 < first < second < first + 30.0


@pytest.mark.parametrize(
    "address", ["mysql://root:secret@there/jobs", "sqlite://", "sqlite:///:memory:", "://", "a://b:c"]
)
def test_other_addresses_are_refused_without_telling_passwords(address: str) -> None:
    with pytest.raises(InputError, match="a store must be postgresql://") as refused:
        Store(address)
    assert "secret" not in str(refused.value)


def test_workers_that_never_said_that_they_leave_are_forgotten_in_the_end(store: Store, database: Database) -> None:
    for worker in ("long gone", "silent"):
        store.register(worker)
    with database.writing() as connection:
        connection.execute(text("UPDATE workers SET seen = seen - 700000 WHERE id = 'long gone'"))
    store.register("silent")
    assert len(store.workers()) == 2
    store.register("new")
    assert [worker.id for worker in store.workers()] == ["new", "silent"]


def test_what_cannot_be_opened_says_so(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="unable to open database file"):
        Store(tmp_path / "nowhere" / "store.db")
    (tmp_path / "letter.txt").write_text("Dear Sir or Madam, " * 100)
    with pytest.raises(StoreError, match="file is not a database"):
        Store(tmp_path / "letter.txt")


def test_a_server_out_of_reach_says_so_without_telling_passwords(tmp_path: Path) -> None:
    pytest.importorskip("psycopg")
    with pytest.raises(StoreError, match="the store must be a database that can be reached") as refused:
        Store(f"postgresql://me:secret@/jobs?host={tmp_path}")
    assert "secret" not in str(refused.value)


def test_without_psycopg_the_remedy_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(MissingExtra, match=r'pip install "slidercrank\[postgres\]"'):
        Store("postgresql://me@there/jobs")


class Failing:
    """Lets writing transactions fail, before or after they are committed."""

    def __init__(self, store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
        self.left = 0
        self.after_commit = False
        self._writing = store.writing
        monkeypatch.setattr(store, "writing", self.writing)
        monkeypatch.setattr("slidercrank.service.store.claim._PAUSE", 0.0)

    @contextlib.contextmanager
    def writing(self) -> Iterator[Connection]:
        fails = self.left > 0
        self.left -= fails
        if fails and not self.after_commit:
            raise Unavailable("the disk is full")
        with self._writing() as connection:
            yield connection
        if fails:
            raise Unavailable("the server went away before it answered")


@pytest.mark.parametrize("after_commit", [False, True])
def test_a_write_that_fails_for_a_while_takes_effect_once(
    after_commit: bool, store: Store, address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = add(store)
    failing = Failing(store, monkeypatch)
    claim = store.claim("first")
    assert claim is not None
    failing.after_commit = after_commit
    for number in (1, 2, 3):
        failing.left = 3 - after_commit
        claim.keep_record(search_record(number))
        claim.report(progress(number))
    failing.left = 1
    claim.finish(result())
    assert failing.left == 0
    kinds = [event.data.get("state", event.kind) for event in store.events(job.id)]
    assert kinds == ["queued", "running", "progress", "progress", "progress", "done"]
    assert len(all_rows(address)["designs"]) == 2


def test_a_write_is_not_tried_beyond_the_lease(store: Store, address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    job = add(store)
    claim = store.claim("first")
    assert claim is not None
    failing = Failing(store, monkeypatch)
    failing.left = sys.maxsize
    claim.lease = 0.05
    before = all_rows(address)
    with pytest.raises(StoreError, match="the disk is full"):
        claim.report(progress(1))
    assert all_rows(address) == before
    failing.left = 0
    end_lease(address, job.id)
    assert store.claim("second") is not None
    failing.left = 1
    claim.lease = 60.0
    with pytest.raises(LeaseLost):  # also when the first try did not reach the database
        claim.report(progress(1))


def test_a_full_disk_loses_nothing_and_the_job_goes_on_when_there_is_room(tmp_path: Path) -> None:
    with Store(tmp_path / "store.db") as store:
        job = add(store)
        claim = store.claim("first")
        assert claim is not None
        before = all_rows(str(tmp_path / "store.db"))
        limit_pages_of_file(store, 50)
        large = Artefact(name="large", media_type="text/plain", content=b"x" * 10_000_000)
        claim.patient = lambda _: False
        with pytest.raises(StoreError, match=r"database or disk is full; .* free; free some space"):
            claim.write_files(large)
        assert all_rows(str(tmp_path / "store.db")) == before
        with store.reading() as connection:
            assert connection.scalar(text("PRAGMA integrity_check")) == "ok"
        limit_pages_of_file(store, 100_000)
        claim.write_files(large)
        assert store.artefact(job.id, "large") == large


def test_a_file_that_is_opened_twice_keeps_its_log_when_another_process_ends(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    other = "import sqlite3, sys; there = sqlite3.connect(sys.argv[1]); there.execute('UPDATE jobs SET reason = 1')"
    with Store(file) as store:
        add(store)
        Database(file).close()
        subprocess.run([sys.executable, "-c", f"{other}; there.commit(); there.close()", str(file)], check=True)
        assert Path(f"{file}-wal").exists(), "the locks of this process are gone"
        assert add(store).id == 2


def limit_pages_of_file(store: Store, pages: int) -> None:
    """Let SQLite's file have at most so many pages, as on a disk that is full."""
    with store.writing() as connection:  # one thread has one connection, so that this one is used again
        connection.execute(text(f"PRAGMA max_page_count={pages}"))


def test_workers_on_postgresql_do_not_wait_for_each_other(server: Cluster) -> None:
    with Store(server.new_address()) as store:
        first, second = add(store), add(store)
        with store.writing() as connection:
            held = claim_next(connection, "first", 60.0)
            other = store.claim("second")  # while the first one has not committed yet
            assert store.claim("third") is None
        assert held is not None
        assert other is not None
        assert (held.id, other.job.id) == (first.id, second.id)
        assert [store.job(job.id).worker for job in (first, second)] == ["first", "second"]


def test_a_server_that_takes_no_changes_is_told(server: Cluster, command: Command) -> None:
    address = server.new_address()
    engine = create_engine(f"postgresql+psycopg://tests@/postgres?host={server.folder}", isolation_level="AUTOCOMMIT")
    with Store(address) as store, engine.connect() as connection:
        store.require_ready()
        connection.exec_driver_sql("ALTER SYSTEM SET default_transaction_read_only = on")
        connection.exec_driver_sql("SELECT pg_reload_conf()")
        try:
            wait_for(lambda: refused_writing(store))
            done = command("doctor", "--store", address)
            assert done.exit_code == 1
            assert "is read-only; name the primary server" in done.stdout
        finally:
            connection.exec_driver_sql("SET default_transaction_read_only = off")
            connection.exec_driver_sql("ALTER SYSTEM RESET default_transaction_read_only")
            connection.exec_driver_sql("SELECT pg_reload_conf()")
        wait_for(lambda: not refused_writing(store))
    engine.dispose()


def refused_writing(store: Store) -> bool:
    """Whether the store says that nothing can be written."""
    with contextlib.suppress(StoreError):
        store.require_ready()
        return False
    return True


def wait_for(condition: Callable[[], bool]) -> None:
    """Wait until a condition holds; a server takes in its settings a moment later."""
    end = time.monotonic() + 10.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_a_claim_outlives_a_crash_of_the_server(server: Cluster) -> None:
    with Store(server.new_address()) as store:
        job = add(store)
        claim = store.claim("first")
        assert claim is not None
        for number in (1, 2, 3):
            claim.keep_record(search_record(number))
            claim.report(progress(number))
            if number < 3:
                server.stop()
                server.start()
        claim.finish(result())
        assert store.job(job.id).state == "done"
        rounds: list[Any] = [event.data["round"] for event in store.events(job.id) if event.kind == "progress"]
        assert rounds == [1, 2, 3]


ADDRESS = "postgresql://clerk:geheim@127.0.0.1:1/jobs?password=verraten&sslpassword=auch&host=127.0.0.1&options=-ca%3Db"


def test_nothing_secret_of_an_address_is_shown() -> None:
    with contextlib.closing(Database(ADDRESS)) as database:
        with pytest.raises(StoreError) as refused, database.reading():
            pass
        shown = f"{database.name} {refused.value} {without_secrets(ADDRESS)} {without_secrets('--store=' + ADDRESS)}"
    for secret in ("geheim", "verraten", "auch", "-ca"):
        assert secret not in shown
    assert "psycopg" not in shown
    assert "postgresql://clerk:***@127.0.0.1:1/jobs?" in shown
    assert "host=127.0.0.1" in shown


@pytest.mark.parametrize(
    "form",
    [
        "postgresql://u:{}@127.0.0.1:1/jobs",
        "postgresql+psycopg://u:{}@127.0.0.1:1",
        "postgres://u:{}%40%2F{}@127.0.0.1:1/jobs",
        "postgresql://u:a@{}@127.0.0.1:1/jobs",
        "postgresql://u:a@b/{}@127.0.0.1:1/jobs",
        "postgresql://u:{}@127.0.0.1:port/jobs",
        "postgresql://127.0.0.1:1/jobs?user=u&password={}",
        "postgresql://u@127.0.0.1:1/jobs?connect_timeout={}",
        "postgresql://u:{}@127.0.0.1:1/jobs?port=x",
        "postgresql:/u:{}@127.0.0.1/jobs",
        "postgresql:u:{}@127.0.0.1/jobs",
        "u:{}@127.0.0.1/jobs",
        "host=127.0.0.1 port=1 password={}",
        "mysql://u:{}@there/jobs",
    ],
)
def test_no_form_of_an_address_shows_its_password(
    form: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command
) -> None:
    monkeypatch.chdir(tmp_path)  # where one may be taken for the name of a file
    secret = "".join(random.Random(form).choices(string.ascii_letters, k=12))
    address = form.replace("{}", secret)
    with pytest.raises((InputError, StoreError)) as refused:
        Store(address)
    assert list(tmp_path.iterdir()) == []
    # With all that a log or SLIDERCRANK_DEBUG shows of it.
    shown = ["".join(traceback.TracebackException.from_exception(refused.value).format()), without_secrets(address)]
    for name in (("jobs",), ("cancel", "1"), ("watch", "1"), ("doctor",), ("doctor", "--backup", "copy.db")):
        done = command(*name, "--store", address)
        shown.append(done.output)
        assert done.exit_code in (1, 2) if name == ("doctor",) else done.exit_code == 2
    shown.append(command("cancel", address).output)
    assert secret not in "".join(shown)


@pytest.mark.parametrize("form", ["tests:{}@", "tests@?password={}", "tests@?sslpassword={}", "+psycopg tests:{}@"])
def test_commands_on_an_empty_store_show_no_password(form: str, server: Cluster, command: Command) -> None:
    driver, user = form.split() if " " in form else ("", form)
    user, _, option = user.replace("{}", "geheim").partition("?")
    address = server.new_address().replace("://tests@", f"{driver}://{user}") + (option and f"&{option}")
    assert "geheim" in address
    for name in (("jobs",), ("jobs", "--state", "done"), ("jobs", "--json"), ("cancel", "latest"), ("doctor",)):
        done = command(*name, "--store", address)
        assert done.exception is None or isinstance(done.exception, SystemExit)
        assert "geheim" not in done.output
        assert "***" in done.output or "--json" in name


@pytest.mark.parametrize("text", ["runs/store.db", "--designs=3", "", "--store=a=b", "./a:b@c", r"C:\jobs\me@home"])
def test_what_is_no_address_is_shown_as_it_is(text: str) -> None:
    assert without_secrets(text) == text


def test_an_address_that_cannot_be_read_is_not_shown() -> None:
    assert without_secrets("mysql://a:secret@host:port/x") == "mysql://***"
    assert "secret" not in without_secrets("http://a:secret@host/x?b=secret")


@pytest.mark.parametrize("what", ["a folder", "no regular file", "must have its store beside it"])
def test_what_can_be_no_store_is_refused_by_every_command_and_stays_as_it_is(
    what: str, tmp_path: Path, command: Command
) -> None:
    file, log = tmp_path / "store.db", tmp_path / "store.db-wal"
    if what == "a folder":
        file.mkdir()
    elif what == "no regular file":
        file = Path(os.devnull)
    else:
        log.write_bytes(b"the latest jobs")
    job = job_file(tmp_path)
    for address in {str(file), f"sqlite:///{file}"}:
        for name in (
            "jobs",
            "jobs --json",
            "cancel latest",
            f"submit {job}",
            "worker --drain",
            "doctor --backup new.db",
        ):
            done = command(*name.split(), "--store", address)
            assert (done.exit_code, done.stdout) == (2, "")
            assert what in done.stderr
            assert done.stderr.count("\n") == 1
        done = command("doctor", "--store", address)
        assert done.exit_code == 1
        assert what in done.stdout
    assert not log.exists() or log.read_bytes() == b"the latest jobs"


@pytest.mark.parametrize("place", ["empty.db", "plain.txt/store.db", 300 * "x"])
def test_looking_into_what_can_have_no_jobs_says_so_and_changes_nothing(
    place: str, tmp_path: Path, command: Command
) -> None:
    (tmp_path / "empty.db").touch()
    (tmp_path / "plain.txt").write_text("no folder")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    for address in (tmp_path / place, f"sqlite:///{tmp_path / place}"):
        for words in ("jobs", "jobs --json", "cancel latest", "watch 1", f"doctor --backup {tmp_path / 'copy.db'}"):
            done = command(*words.split(), "--store", address)
            assert (done.exit_code, done.stdout) == (2, "")
            assert done.stderr.startswith("slidercrank: a store ")
            assert done.stderr.count("\n") == 1
            assert str(tmp_path / place) in done.stderr
        done = command("doctor", "--store", address)
        assert done.exit_code == 1
        assert "problem  store              a store " in done.stdout
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_an_emptied_store_keeps_the_log_that_is_left_of_it(tmp_path: Path, command: Command) -> None:
    file, log = tmp_path / "store.db", tmp_path / "store.db-wal"
    file.touch()
    log.write_bytes(b"the latest jobs")
    for words in ("jobs", f"submit {job_file(tmp_path)}"):
        done = command(*words.split(), "--store", file)
        assert (done.exit_code, done.stdout) == (2, "")
        assert "belongs to a store that was deleted or truncated" in done.stderr
    assert log.read_bytes() == b"the latest jobs"


def test_looking_into_a_store_that_is_not_there_makes_none(tmp_path: Path, command: Command) -> None:
    assert command("jobs", "--store", f"sqlite:///{tmp_path / 'store.db'}").exit_code == 0
    assert command("cancel", "latest", "--store", f"sqlite:///{tmp_path / 'store.db'}").exit_code == 2
    assert list(tmp_path.iterdir()) == []


@contextlib.contextmanager
def as_reader(folder: Path) -> Iterator[None]:
    """Enter as somebody who may read a folder and its files but not write there."""
    for place in (*folder.iterdir(), folder):
        place.chmod(0o555 if place.is_dir() else 0o444)
    root = os.geteuid() == 0
    try:
        if root:
            os.setresuid(65534, 65534, 0)
        yield
    finally:
        if root:
            os.setresuid(0, 0, 0)
        folder.chmod(0o700)


@pytest.mark.skipif(sys.platform != "linux", reason="permissions as in POSIX, and users as in Linux")
@pytest.mark.parametrize("used", [False, True])
def test_a_store_that_cannot_be_written_can_be_looked_at(used: bool) -> None:
    with tempfile.TemporaryDirectory() as name:  # pytest's own folders are closed to others
        folder = Path(name)
        with Store(folder / "store.db") as opened:
            add(opened)
            claim_waiting_job(opened).finish(result())
            if not used:
                opened.close()
            before = sorted(folder.iterdir())
            with as_reader(folder), Store(folder / "store.db") as looked:
                assert [job.state for job in looked.jobs()] == ["done"]
                assert len(looked.result(1).designs) == 2
                assert damages(looked) == []
                with pytest.raises(StoreError, match="is read-only; only read from it, or chmod u\\+rw"):
                    add(looked)
            assert sorted(folder.iterdir()) == before


@pytest.mark.skipif(sys.platform != "linux", reason="permissions as in POSIX, and users as in Linux")
def test_a_read_only_copy_without_the_shared_file_of_its_log_says_what_it_needs() -> None:
    with tempfile.TemporaryDirectory() as name:  # pytest's own folders are closed to others
        folder = Path(name)
        with Store(folder / "store.db") as opened:
            add(opened)
            (folder / "copy").mkdir()
            for file in ("store.db", "store.db-wal"):
                shutil.copy(folder / file, folder / "copy")
        before = sorted((folder / "copy").iterdir())
        folder.chmod(0o755)
        with as_reader(folder / "copy"), pytest.raises(StoreError, match=r"store.db-wal alone; copy both to a folder"):
            Store(folder / "copy" / "store.db")
        assert sorted((folder / "copy").iterdir()) == before


@pytest.mark.skipif(sys.platform == "win32", reason="disks as in POSIX")
def test_a_store_on_a_disk_mounted_read_only_is_to_be_copied(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "store.db"
    with Store(file) as store:
        add(store)
    monkeypatch.setattr("slidercrank.service.store.database.is_readable_and_writable", lambda _path: False)
    found = os.statvfs(tmp_path)
    read_only = os.statvfs_result((*found[:8], found.f_flag | os.ST_RDONLY, *found[9:]))
    monkeypatch.setattr(os, "statvfs", lambda _path: read_only)
    for done in (command("cancel", 1, "--store", file), command("doctor", "--store", file)):
        assert f"to another folder than {tmp_path}, whose disk is read-only" in done.output
        assert "chmod" not in done.output


def test_commands_that_write_refuse_a_store_that_cannot_be_written(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store(tmp_path / "store.db") as store:
        add(store)
    monkeypatch.setattr("slidercrank.service.store.database.is_readable_and_writable", lambda _path: False)
    assert "Feeder" in command("jobs", "--store", tmp_path / "store.db").stdout
    done = command("doctor", "--store", tmp_path / "store.db")
    assert done.exit_code == 1
    assert "no damage found" in done.stdout
    assert "is not writable, so no job can make progress" in done.stdout
    for name in (("cancel", 1), ("worker", "--drain"), ("serve", "--port", 0, "--workers", 0)):
        done = command(*name, "--store", tmp_path / "store.db")
        assert (done.exit_code, done.stdout) == (2, "")
        assert "is read-only; only read from it, or chmod u+rw" in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="permissions as in POSIX")
def test_a_new_store_and_its_copy_are_for_the_eyes_of_their_owner(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    with Store(file) as store:
        add(store)
        files = sorted(tmp_path.iterdir())
        assert [path.name for path in files] == ["store.db", "store.db-shm", "store.db-wal"]
        assert [path.stat().st_mode & 0o777 for path in files] == [0o600] * 3
    with contextlib.closing(Database(file)) as database:
        back_up(database, tmp_path / "copy.db")
    assert (tmp_path / "copy.db").stat().st_mode & 0o777 == 0o600


def test_a_store_that_is_there_keeps_its_permissions(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    Store(file).close()
    file.chmod(0o660)
    Store(file).close()
    assert file.stat().st_mode & 0o777 == 0o660
