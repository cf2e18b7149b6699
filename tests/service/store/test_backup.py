"""A backup is whole while the store is in use, and what is restored from it goes on."""

from __future__ import annotations

import shutil
import threading
from pathlib import Path

import pytest

from slidercrank.model.errors import InputError, StoreError
from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up, damages
from slidercrank.service.store.database import Database
from tests.service.store.contents import (
    add,
    all_rows,
    claim_waiting_job,
    is_same_record,
    progress,
    result,
    search_record,
)


def copy(file: Path, target: Path) -> None:
    """Back up a store."""
    database = Database(file)
    try:
        back_up(database, target)
    finally:
        database.close()


def test_a_restored_store_has_everything_and_its_jobs_go_on(tmp_path: Path) -> None:
    file, backup = tmp_path / "store.db", tmp_path / "backup.db"
    with Store(file) as store:
        add(store)
        claim = claim_waiting_job(store)
        claim.keep_record(search_record(0))
        claim.report(progress(1))
        claim.hand_back("the backup comes")
        before = all_rows(str(file))
        copy(file, backup)
        add(store, "after the backup")
    assert [path.name for path in sorted(tmp_path.glob("backup*"))] == ["backup.db"]
    for path in tmp_path.glob("store.db*"):
        path.unlink()
    shutil.copy(backup, file)
    assert all_rows(str(file)) == before
    with Store(file) as store:
        claim = claim_waiting_job(store)
        assert is_same_record(claim.evaluation_records()[0], search_record(0))
        claim.finish(result())
        assert store.job(1).state == "done"


def test_a_backup_is_of_one_moment_while_others_write(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    stop = threading.Event()

    def submit() -> None:
        with Store(file) as own:
            while not stop.is_set():
                add(own)

    with Store(file) as store:
        thread = threading.Thread(target=submit)
        thread.start()
        try:
            for number in range(5):
                count = len(store.jobs(limit=10_000))
                copy(file, tmp_path / f"{number}.db")
                database = Database(tmp_path / f"{number}.db")
                assert damages(database) == []
                database.close()
                with Store(tmp_path / f"{number}.db") as copied:
                    assert len(copied.jobs(limit=10_000)) >= count
        finally:
            stop.set()
            thread.join()


def test_a_backup_never_takes_the_place_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    Store(file).close()
    with pytest.raises(InputError, match=r"a backup must be a new file; .*store\.db already exists"):
        copy(file, file)


def test_a_backup_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    file = tmp_path / "store.db"
    Store(file).close()
    with pytest.raises(StoreError, match="a backup must go to a writable place"):
        copy(file, tmp_path / "none" / "backup.db")
    assert not (tmp_path / "none").exists()


def test_a_store_on_a_server_is_not_copied_so(address: str, store: Store, tmp_path: Path) -> None:
    database = Database(address)
    if not database.sqlite:
        with pytest.raises(InputError, match="back it up with pg_dump"):
            back_up(database, tmp_path / "backup.db")
    database.close()
