"""A full disk wherever `optimise` writes: told at once with place and room, and nothing is lost."""

from __future__ import annotations

import errno
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import text

from slidercrank.optimise.front.front import ParetoFront
from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Job, Store
from slidercrank.service.store.database import Database, Full
from slidercrank.service.workers.worker import work
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.made_up_search import search, until
from tests.service.store.small_disk import Disk, large_record
from tests.service.test_worker import TABLES


@pytest.fixture
def full_after(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that stops a store's file growing after some writes, by SQLite's own limit, or frees it."""
    opened = Database.writing
    left, limit = [10**9], [0]

    def writing(database: Database) -> Any:
        left[0] -= 1
        if left[0] < 0:
            with database.engine.connect() as connection:
                pages = connection.exec_driver_sql("PRAGMA page_count").scalar_one()
                connection.exec_driver_sql(f"PRAGMA max_page_count={limit[0] or pages}")
        return opened(database)

    def after(writes: int, *, lifted: bool = False) -> None:
        left[0], limit[0] = writes, 1 << 30 if lifted else 0

    monkeypatch.setattr(Database, "writing", writing)
    return after


def test_optimise_says_within_seconds_that_the_disk_of_the_store_is_full_and_goes_on_when_it_is_not(
    tmp_path: Path, command: Command, runs: Path, full_after: Any
) -> None:
    job = tmp_path / "job.toml"
    job.write_text(fronts.JOB.replace("samples = 512\n", 'method = "nsga2"\nsamples = 16\nevaluations = 400\n'))
    full_after(6)
    begin = time.monotonic()
    stopped = command("optimise", job, "--no-figures")
    assert time.monotonic() - begin < 30.0
    assert stopped.exit_code == 2
    assert "the store needs free space on its disk" in stopped.stderr
    assert f"{runs} has " in stopped.stderr
    assert " free; free some space; the designs found so far are kept" in stopped.stderr
    full_after(0, lifted=True)
    (run,) = (path for path in runs.iterdir() if path.is_dir())
    assert f"optimise --resume {run.name}" in stopped.stderr
    assert command("optimise", "--resume", run.name, "--no-figures").exit_code == 0
    whole = command("optimise", job, "--no-figures", "--runs", tmp_path / "whole")
    assert whole.exit_code == 0
    (other,) = (path for path in (tmp_path / "whole").iterdir() if path.is_dir())
    assert (run / "front.csv").read_text() == (other / "front.csv").read_text()


def test_what_a_database_says_of_a_full_disk_is_told_with_the_place(tmp_path: Path) -> None:
    database = Database(tmp_path / "store.db")

    def grow() -> None:
        with database.writing() as connection:
            connection.execute(text("PRAGMA max_page_count=2"))
            for name in range(20):
                connection.execute(text(f"CREATE TABLE t{name} (a)"))

    with pytest.raises(Full, match=rf"{tmp_path} has .* free; free some space"):
        grow()
    database.close()


def test_a_run_folder_on_a_full_disk_names_the_place(
    tmp_path: Path, command: Command, runs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("slidercrank.service.runs.run_folder.os.fsync", full)
    job = fronts.job_file(tmp_path)
    stopped = command("optimise", job, "--no-figures", "--store", tmp_path / "store.db")
    assert stopped.exit_code == 2
    assert f"Disk full: {runs} has " in stopped.stderr


def test_a_job_that_finds_another_disk_full_waits_for_it_and_is_not_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slidercrank.service.workers.worker._FULL", 0.05)
    tried: list[float] = []

    def solve(*given: Any, **more: Any) -> ParetoFront:
        tried.append(time.monotonic())
        if len(tried) < 6:  # more often than a job may be tried
            raise OSError(errno.ENOSPC, "No space left on device", str(tmp_path / "cache"))
        return search(*given, **more)

    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    with Store(tmp_path / "store.db") as store:
        job = submit(store, TABLES)
        while len(tried) < 6:
            work(store, drain=True)
            time.sleep(0.02)
        assert store.job(job.id).state == "done"
        reasons = [event.data.get("reason", "") for event in store.events(job.id)]
    assert any(f"waits: Disk full: {tmp_path / 'cache'} has" in one for one in reasons)


def solve_meanwhile(
    store: Store, disk: Disk, monkeypatch: pytest.MonkeyPatch, job: Job, then: Callable[[Any], None]
) -> None:
    """Let a worker solve a job whose disk is filled before its second round, and do something while it waits."""

    def fills(*given: Any, keep: Any, progress: Any, **more: Any) -> ParetoFront:
        def report(at: Any) -> None:
            if at.round == 2 and not store.job(job.id).reason:
                disk.fill()
            progress(at)

        return search(*given, keep=lambda record: keep(large_record(record.number)), progress=report, **more)

    monkeypatch.setattr("slidercrank.optimise.solve.solve", fills)
    monkeypatch.setattr("slidercrank.service.store.database_clock.SETTLING", 0.2)
    stop = threading.Event()
    worker = threading.Thread(target=work, args=(store,), kwargs={"name": "first", "lease": 0.6, "stop": stop.is_set})
    worker.start()
    try:
        until(lambda: "waits: the store needs free space on its disk" in store.job(job.id).reason)
        then(stop)
    finally:
        stop.set()
        worker.join()


def test_a_full_disk_uses_up_no_attempt_however_long_it_lasts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with Store(tmp_path / "store.db") as store:
        disk = Disk(store)
        job = submit(store, TABLES, most_attempts=1)
        begin = time.monotonic()

        def outlast(_: Any) -> None:
            until(lambda: store.job(job.id).fence > 1 or time.monotonic() - begin > 0.9)
            disk.empty()
            until(lambda: store.job(job.id).state not in ("queued", "running"))

        solve_meanwhile(store, disk, monkeypatch, job, outlast)
        ended = store.job(job.id)
        assert (ended.state, ended.fence) == ("done", 1)
        whole = submit(store, TABLES)
        monkeypatch.setattr("slidercrank.optimise.solve.solve", search)
        work(store, drain=True)
        assert store.result(job.id).designs == store.result(whole.id).designs


@pytest.mark.parametrize(("ends", "state"), [("cancel", "cancelled"), ("stop", "queued")])
def test_a_job_that_waits_for_room_ends_when_it_or_its_worker_is_to_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ends: str, state: str
) -> None:
    with Store(tmp_path / "store.db") as store:
        disk = Disk(store)
        job = submit(store, TABLES)

        def end(stop: threading.Event) -> None:
            if ends == "cancel":
                store.cancel(job.id)
            else:
                stop.set()
            until(lambda: store.job(job.id).state == state)

        solve_meanwhile(store, disk, monkeypatch, job, end)
        ended = store.job(job.id)
        assert (ended.records, ended.worker) == (1, None)
        if ends == "cancel":
            store.resume(job.id)
        else:
            assert ended.reason.startswith("waits: the store needs free space on its disk")
            assert ended.attempts == 0
        disk.empty()
        monkeypatch.setattr("slidercrank.optimise.solve.solve", search)
        work(store, drain=True)
        assert store.job(job.id).state == "done"
