"""Backup of a store into a file while the store is in use."""

from __future__ import annotations

import contextlib
import os
import sqlite3
from pathlib import Path

from ...model.errors import InputError, StoreError
from ..runs.run_folder import sync
from .database import Database

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
        os.close(os.open(draft, os.O_CREAT | os.O_EXCL | os.O_RDWR, 0o600))  # it has all data of the store
        with (
            contextlib.closing(sqlite3.connect(source, timeout=_PATIENCE)) as original,
            contextlib.closing(sqlite3.connect(draft)) as copy,
        ):
            original.backup(copy)  # in one step, so that no writer makes it restart
            copy.execute("PRAGMA journal_mode=DELETE")  # so that the copy is one file
            verdict = copy.execute("PRAGMA integrity_check").fetchone()[0]
        if verdict != "ok":
            raise StoreError(f"a backup must be whole; that of {database.name} gave: {verdict}; run slidercrank doctor")
        sync(draft)
        draft.rename(target)
        sync(target.parent)
    except (sqlite3.Error, OSError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise StoreError(
            f"a backup must go to a writable place; {target} gave: {reason}; see that the folder is there and "
            "the disk has room"
        ) from error
    finally:
        with contextlib.suppress(OSError):
            draft.unlink(missing_ok=True)
