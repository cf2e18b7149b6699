"""Database opened by its address: commits survive crashes, and failures are reported in one sentence.

SQLite: write-ahead log, `synchronous=FULL`, and every write transaction starts with `BEGIN IMMEDIATE`, so that none
must be aborted half-way because of another writer. PostgreSQL: psycopg 3, `synchronous_commit=on`.
"""

import contextlib
import math
import os
import sqlite3
import time
from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import Any, Self

from sqlalchemy import URL, Connection, Engine, create_engine, event
from sqlalchemy.exc import ArgumentError, DBAPIError, InterfaceError, InvalidatePoolError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from ...model.errors import StoreError
from ...model.file_name_encoding import path_text
from ...model.optional_packages import NamingExtra
from ..resources.disk import LEAST, free_bytes, free_space_text
from .address import HIDDEN, address_without_secrets, file_of, secrets_of, store_file_exists, url_of

_PATIENCE = 30.0  # s to wait for other writers
_POOL = {"pool_size": 20, "pool_use_lifo": True}  # as many stay open as API threads use simultaneously
_SNAPSHOT = {"isolation_level": "REPEATABLE READ"}  # for PostgreSQL; a SQLite transaction has it anyway
_IDLE = 0.1  # idle s after which a connection is tested: no server restarts faster
_POSTGRESQL = {
    "synchronous_commit": "on",
    "lock_timeout": "30s",
    # Otherwise a worker stopped in the middle of a transaction would hold its job forever.
    "idle_in_transaction_session_timeout": "10s",
}


_DISK_FULL = "53100"  # of PostgreSQL


class Unavailable(StoreError):
    """Temporary refusal by the database: it restarts, its disk is full, or another writer is active."""


class Full(Unavailable):
    """Disk of the database is full."""


class Database:
    """An open database. Both kinds of transaction raise `StoreError` if the database refuses or cannot be reached.

    last_full: time when its disk was last found full, s on the monotonic clock.
    """

    def __init__(self, address: str | PathLike[str]) -> None:
        """Open the database at an address: postgresql://..., sqlite:///file, or the path of a file.

        Raises `InputError` for any other form of address, `StoreError` if it cannot be opened.
        """
        url = url_of(address)
        self.name = address_without_secrets(url)
        self._secrets = secrets_of(url)
        self.last_full = -math.inf
        self.sqlite = url.get_backend_name() == "sqlite"
        self._file = file_of(address)
        alone = False
        if self._file is not None:
            store_file_exists(self._file)
            with contextlib.suppress(OSError):  # if it cannot be created, opening it reports why
                # The files of the write-ahead log, beside it, get its permissions. An existing file is left alone:
                # closing it would release the locks that SQLite holds on it for other connections of this process.
                os.close(os.open(self._file, os.O_CREAT | os.O_EXCL | os.O_RDWR, 0o600))
            self._known, self._open = _file_identity(self._file), is_readable_and_writable(self._file)
            log, shared = (Path(f"{self._file}{end}") for end in ("-wal", "-shm"))
            if not self._open and log.exists() and not shared.exists():
                raise StoreError(
                    f"a read-only store with a write-ahead log needs the file -shm beside it; {self.name} has "
                    f"{path_text(log)} alone; copy both to a folder where you may write, and name the copy"
                )
            # A file that nobody can write is opened as immutable; otherwise SQLite would look for a log that it cannot
            # create, or leave one behind.
            alone = not self._open and not log.exists()
            if alone and os.access(self._file, os.R_OK):
                unchanging = {"mode": "ro", "immutable": "1", "uri": "true"}
                url = url.set(database=self._file.absolute().as_uri()).update_query_dict(unchanging)
        self._folder = Path(url.database or ".").parent if self.sqlite else None
        with self._translated_errors():
            self.engine = _sqlite_engine(url) if self.sqlite else _postgresql_engine(url)
        self._reader = self.engine.execution_options(reading=True, **({} if self.sqlite else _SNAPSHOT))
        if self.sqlite and not alone:
            self._use_write_ahead_log()

    def require_disk_space(self) -> None:
        """Raise `Full` if the disk of a file is full; the disk of a server is unknown."""
        if self._folder is not None and free_bytes(self._folder) < LEAST:
            raise self._full_error("its disk is full")

    def require_ready(self) -> None:
        """Raise `StoreError` if the disk of a file is full, or a server accepts no changes."""
        self.require_disk_space()
        if self.sqlite:
            return
        query = "SELECT pg_is_in_recovery() OR current_setting('default_transaction_read_only')::bool"
        with self.reading() as connection:
            if connection.exec_driver_sql(query).scalar():
                raise StoreError(
                    f"the store must be a database that can be written; {self.name} is read-only; name the primary "
                    "server, or switch default_transaction_read_only off there"
                )

    def _full_error(self, reason: str) -> Full:
        self.last_full = time.monotonic()
        free_space = "" if self._folder is None else f"; {free_space_text(self._folder)}"
        return Full(f"the store needs free space on its disk; {self.name} gave: {reason}{free_space}; free some space")

    def _is_full(self, error: Exception) -> bool:
        cause = error.orig if isinstance(error, DBAPIError) else error
        if self._folder is None:
            return getattr(cause, "sqlstate", None) == _DISK_FULL
        code = (getattr(cause, "sqlite_errorcode", None) or 0) & 0xFF
        lacking = (sqlite3.SQLITE_IOERR, sqlite3.SQLITE_CANTOPEN)  # the message if its log has no space
        return code == sqlite3.SQLITE_FULL or (code in lacking and free_bytes(self._folder) < LEAST)

    def close(self) -> None:
        """Close all connections."""
        self.engine.dispose()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @contextlib.contextmanager
    def reading(self) -> Iterator[Connection]:
        """Enter a transaction that sees one state of the database and does not block writers."""
        self._require_unchanged_file()
        with self._translated_errors(), self._reader.begin() as connection:
            yield connection

    @contextlib.contextmanager
    def writing(self) -> Iterator[Connection]:
        """Enter a write transaction; committed at the end, rolled back completely after an error."""
        self._require_unchanged_file()
        if self._file is not None and not self._open:
            raise StoreError(
                f"the store must be a database that can be written; {self.name} is read-only; only read from it, or "
                f"{permission_remedy(self._file)}"
            )
        with self._translated_errors(), self.engine.begin() as connection:
            yield connection

    def _require_unchanged_file(self) -> None:
        """Raise `StoreError` if the file was deleted or replaced: further writes would be lost."""
        if self._file is not None and _file_identity(self._file) != self._known:
            raise StoreError(
                f"the file of a store must stay in place while it is used; {self.name} was deleted, moved or replaced; "
                "put it back, or stop what uses it and start again"
            )
        # Open transactions would continue, but no new one could begin.
        if self._file is not None and self._open and not is_readable_and_writable(self._file):
            raise StoreError(
                f"the file of a store must stay readable and writable while it is used; {self.name} is no longer; "
                f"{permission_remedy(self._file)}"
            )

    @contextlib.contextmanager
    def _translated_errors(self) -> Iterator[None]:
        try:
            yield
        except (ArgumentError, DBAPIError, PoolTimeoutError, sqlite3.Error) as error:
            if self._is_full(error):
                # Its own message contains the secrets.
                raise self._full_error(self._without_secrets(_error_text(error))) from None
            kind = Unavailable if _is_temporary(error) else StoreError
            raise kind(
                f"the store must be a database that can be reached, read and written; {self.name} gave: "
                f"{self._without_secrets(_error_text(error))}; check that it runs, that the disk has space and that "
                "you may write there"
            ) from None

    def _without_secrets(self, text: str) -> str:
        for secret in self._secrets:
            text = text.replace(secret, HIDDEN)
        return text

    def _use_write_ahead_log(self) -> None:
        """Switch SQLite to a write-ahead log, a permanent setting of the file; processes may try it together."""
        end = time.monotonic() + _PATIENCE
        while True:
            try:
                with self._translated_errors(), self.engine.connect() as connection:
                    raw: Any = connection.connection.dbapi_connection
                    mode = raw.execute("PRAGMA journal_mode=WAL").fetchone()[0]
                break
            except Unavailable as error:
                if "locked" not in str(error) or time.monotonic() > end:
                    raise
                time.sleep(0.05)
        if mode != "wal":
            raise StoreError(
                f"the file of a store must allow SQLite's write-ahead log; {self.name} has the log {mode}; "
                "put it on a local disk"
            )


def _file_identity(file: Path) -> tuple[int, int] | None:
    """Return device and inode of a file, which do not change on writing; None if it does not exist."""
    try:
        status = file.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino


def is_readable_and_writable(path: Path) -> bool:
    """Whether this user may read and write the file of a store."""
    return os.access(path, os.R_OK | os.W_OK)


def permission_remedy(path: Path) -> str:
    """Return the remedy for missing permissions: a command, or another folder if the disk is read-only."""
    if os.name == "posix" and os.statvfs(path).f_flag & os.ST_RDONLY:
        place = path_text(path.parent)
        return f"copy it, with its -wal file if any, to another folder than {place}, whose disk is read-only"
    return f"chmod u+rw {path}, as the user who owns it"


def _sqlite_engine(url: URL) -> Engine:
    engine = create_engine(url, connect_args={"timeout": _PATIENCE, "isolation_level": None}, **_POOL)

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _record: Any) -> None:
        connection.execute("PRAGMA synchronous=FULL")
        connection.execute("PRAGMA foreign_keys=ON")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        reading = connection.get_execution_options().get("reading", False)
        connection.exec_driver_sql("BEGIN" if reading else "BEGIN IMMEDIATE")

    return engine


def _postgresql_engine(url: URL) -> Engine:
    options = " ".join(f"-c {name}={value}" for name, value in _POSTGRESQL.items())
    options_in_address = url.query.get("options", "")
    in_address = options_in_address if isinstance(options_in_address, str) else " ".join(options_in_address)
    arguments = {
        "options": f"{options} {in_address}".strip(),
        "connect_timeout": 10,
        "tcp_user_timeout": 20_000,  # ms until an unreachable machine counts as gone
        "application_name": "slidercrank",
    }
    used_arguments = {name: value for name, value in arguments.items() if name == "options" or name not in url.query}
    with NamingExtra("a store on PostgreSQL needs"):
        engine = create_engine(url.difference_update_query(["options"]), connect_args=used_arguments, **_POOL)

    @event.listens_for(engine, "checkin")
    def note_return(_connection: Any, record: Any) -> None:
        record.info["since"] = time.monotonic()

    @event.listens_for(engine, "checkout")
    def check_connection(connection: Any, record: Any, _proxy: Any) -> None:
        # Not every time, as the pool would: that takes as long as using the connection.
        if time.monotonic() - record.info.get("since", math.inf) > _IDLE and not _is_alive(engine, connection):
            raise InvalidatePoolError  # makes the pool drop its connections and open a new one

    return engine


def _is_alive(engine: Engine, connection: Any) -> bool:
    try:
        return engine.dialect.do_ping(connection)
    except engine.dialect.loaded_dbapi.Error:
        return False


def _is_temporary(error: Exception) -> bool:
    passing = isinstance(error, OperationalError | InterfaceError | PoolTimeoutError | sqlite3.OperationalError)
    return passing or (isinstance(error, DBAPIError) and error.connection_invalidated)


def _error_text(error: Exception) -> str:
    cause = error.orig if isinstance(error, DBAPIError) and error.orig is not None else error
    return " ".join(str(cause).split()) or type(cause).__name__
