"""A PostgreSQL server of the tests' own: started in a temporary folder, gone after them."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from sqlalchemy import create_engine

_SCHEMAS = count()


class Cluster:
    """A running server. It listens on a socket in its folder only."""

    def __init__(self, programs: Path, folder: Path) -> None:
        self.folder = folder
        self._programs = programs
        # PostgreSQL refuses to run as root.
        self._user = _unprivileged() if os.geteuid() == 0 else None
        if self._user is not None:
            import pwd

            os.chown(folder, pwd.getpwnam(self._user).pw_uid, -1)
        self._run("initdb", "--auth=trust", "--username=tests", "--encoding=UTF8", "--no-sync", "--locale=C")
        self.start()

    def new_address(self) -> str:
        """Return an address with nothing there: a schema of its own, which takes less time and disk than a database."""
        name = f"store_{next(_SCHEMAS)}"
        engine = create_engine(f"postgresql+psycopg://tests@/postgres?host={self.folder}")
        with engine.begin() as connection:
            connection.exec_driver_sql(f"CREATE SCHEMA {name}")
        engine.dispose()
        return f"postgresql://tests@/postgres?host={self.folder}&options=-csearch_path%3D{name}"

    def start(self) -> None:
        """Start the server, and wait until it answers."""
        options = f"-k {self.folder} -c listen_addresses='' -c fsync=off -c max_connections=60 -c shared_buffers=16MB"
        self._run("pg_ctl", "start", "--wait", f"--options={options}", f"--log={self.folder / 'server.log'}")

    def stop(self, *, mode: str = "immediate") -> None:
        """Stop the server; at once, as a crash does, unless told otherwise."""
        self._run("pg_ctl", "stop", "--wait", f"--mode={mode}")

    def _run(self, program: str, *arguments: str) -> None:
        done = subprocess.run(
            [self._programs / program, f"--pgdata={self.folder / 'data'}", *arguments],
            user=self._user,
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,  # a pipe would be held open by the server
            stderr=subprocess.DEVNULL,
            check=False,
        )
        assert done.returncode == 0, f"{program} {' '.join(arguments)} ended with {done.returncode}"


@contextmanager
def cluster(programs: Path) -> Iterator[Cluster]:
    """Give a server while it is needed."""
    # The path of a socket may have about 100 characters, which those of pytest can exceed.
    folder = Path(tempfile.mkdtemp(prefix="pg-"))
    started = None
    try:
        started = Cluster(programs, folder)
        yield started
    finally:
        if started is not None:
            started.stop()
        shutil.rmtree(folder, ignore_errors=True)


def why_not() -> str | None:
    """Return why no server can be started here; None if one can."""
    if os.name == "nt":
        return "the tests start PostgreSQL on POSIX systems only"
    if programs() is None:
        return "PostgreSQL's initdb and pg_ctl are not installed (Debian: postgresql)"
    if os.geteuid() == 0 and _unprivileged() is None:
        return "PostgreSQL refuses to run as root, and there is no user postgres or nobody"
    return None


def programs() -> Path | None:
    """Return the folder of PostgreSQL's programs, where they are installed."""
    found = shutil.which("initdb")
    places = [Path(found).resolve().parent] if found else []
    places += sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    return next((place for place in places if (place / "initdb").is_file() and (place / "pg_ctl").is_file()), None)


def _unprivileged() -> str | None:
    import pwd  # not on Windows

    names = {user.pw_name for user in pwd.getpwall()}
    return next((name for name in ("postgres", "nobody") if name in names), None)
