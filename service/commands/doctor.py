"""`slidercrank doctor`: checks the service on this machine, and backs up its store."""

from __future__ import annotations

import contextlib
import os
import platform
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

import typer

from ...model.errors import NotFound, SlidercrankError
from ...objectives.kinds import count_with_noun
from ..jobs.stores import Address, has_store, is_store_specified, printable_store_address, store_address
from ..resources.memory import size_text
from ..runs.result import json_text
from ..runs.run_folder import runs_folder
from ..text.options import File, Json, Runs
from ..text.screen import console, print_message, print_output

if TYPE_CHECKING:
    from ..store.database import Database

UNHEALTHY = 1
"""Exit code if a check fails; 2 is for wrong input."""
Grade = Literal["ok", "note", "problem"]
_LEAST_SPACE, _LITTLE_SPACE = 200e6, 2e9  # bytes
_CLOCKS = 2.0  # difference between clocks, s, that deserves a note
_REMEDY = "; stop the service and restore a backup, see docs/service.md"
_PACKAGES = ("slidercrank", "numpy", "numba", "scipy", "sqlalchemy", "alembic", "fastapi", "uvicorn")
_OPTIONAL = ("psycopg", "distributed", "pyarrow")


def doctor(
    store: Address = None,
    runs: Runs = None,
    backup: Annotated[File, "Copy a store on disk to a new file, even while it is in use."] = None,
    json: Json = False,
) -> None:
    """Check store, workers, disks and software; the exit code is 1 if any check fails.

    Checks the database, its tables and its clock, jobs that wait without a worker, writable folders, free disk space
    and versions. No job is changed.
    """
    address = store_address(store, runs)
    if backup is not None:
        _back_up(store, runs, backup)
    checks = diagnose(address, runs_folder(runs), named=is_store_specified(store))
    healthy = all(check.grade != "problem" for check in checks)
    if json:
        print_output(json_text({"healthy": healthy, "checks": [check._asdict() for check in checks]}))
    else:
        screen = console()
        for check in checks:
            style = {"problem": "bold", "note": "", "ok": "dim"}[check.grade]
            screen.print(f"{check.grade:<9}{check.name:<18} {check.text}", style=style, soft_wrap=True)
    if not healthy:
        raise typer.Exit(UNHEALTHY)


def _back_up(store: str | None, runs: Path | None, target: Path) -> None:
    from ..store.damage_check_and_backup import back_up
    from ..store.database import Database

    if not has_store(store, runs):
        raise NotFound(
            f"there is no store at {printable_store_address(store, runs)}; name the store to copy with --store"
        )
    with contextlib.closing(Database(store_address(store, runs))) as database:
        back_up(database, target)
    print_message(f"{target}: a copy of {database.name}")


class Check(NamedTuple):
    """Check with its outcome. text: finding, and the remedy unless it is ok."""

    name: str
    grade: Grade
    text: str


def diagnose(address: str, runs: Path, *, named: bool = False) -> list[Check]:
    """Check the store at an address, the folder of runs and this machine; change no job.

    named: whether the address was specified; if not, the store may be missing.
    """
    return [
        *_check_store(address, named),
        _check_writable("runs", runs),
        *([] if "://" in address else [_check_free_space("disk of the store", Path(address).parent)]),
        _check_free_space("disk of runs", runs),
        _check_compiled_model(),
        _check_versions(),
    ]


def _check_store(address: str, named: bool) -> Iterator[Check]:
    from ..store.address import file_of, has_content
    from ..store.database import Database

    try:
        file = file_of(address)
        if file is not None and not has_content(file):
            text = (
                f"no store at {file}; the first job would create an empty one. Put the file back or restore a "
                "backup: see "
            )
            fresh = f"no store at {file} yet; the first job creates it"
            yield Check("store", "problem", f"{text}docs/service.md") if named else Check("store", "ok", fresh)
            yield _check_writable("place of the store", file.parent)
            return
        with contextlib.closing(Database(address)) as database:
            yield from () if file is None else _check_access(file)
            yield from _check_database(address, database)
    except SlidercrankError as error:
        yield Check("store", "problem", str(error))


def _check_access(file: Path) -> Iterator[Check]:
    """Check who may access a store file, which holds everything that the service's token protects."""
    from ..store.database import is_readable_and_writable, permission_remedy

    if not is_readable_and_writable(file):
        text = f"{file} is not writable, so no job can make progress; {permission_remedy(file)}"
        yield Check("permissions", "problem", text)
    elif os.name == "posix" and (mode := file.stat().st_mode & 0o077):
        text = f"other users of this machine can read or write {file} (their mode: {mode:03o}); run chmod 600 {file}"
        yield Check("permissions", "note", text)


def _check_database(address: str, database: Database) -> Iterator[Check]:
    from ..store.damage_check_and_backup import clock_ahead, damages, server_version
    from ..store.schema_version import foreign_tables_text, stored_and_known_version

    if not database.sqlite:
        database.require_ready()
    yield Check("store", "ok", f"{database.name} answers, {server_version(database)}")
    foreign = foreign_tables_text(database)
    if foreign:
        text = f"they belong to another program ({foreign}); name another store with --store"
        yield Check("tables", "problem", text)
        return
    version, latest, is_known = stored_and_known_version(database)
    if not is_known:
        text = f"their version is {version}, but this release supports {latest}; install the release that created them"
        yield Check("tables", "problem", text)
        return
    if version != latest:
        text = f"their version is {version or 'none'}; a command that opens the store upgrades them to {latest}"
        yield Check("tables", "note", text)
        return
    yield Check("tables", "ok", f"version {version}")
    wrong = damages(database)
    text = "; ".join(wrong) + _REMEDY if wrong else "no damage found"
    yield Check("integrity", "problem" if wrong else "ok", text)
    ahead = clock_ahead(database)
    text = f"the clocks of store and machine differ by {ahead:+.2f} s"
    far = abs(ahead) > _CLOCKS
    yield Check("clock", "note" if far else "ok", f"{text}; synchronise both with NTP" if far else text)
    yield from _check_workers(address, time.time() + ahead)


def _check_workers(address: str, now: float) -> Iterator[Check]:
    """Check jobs and workers. now: time on the clock of the store."""
    from ..store import Store
    from ..store.records import SILENT

    with Store(address) as store:
        counts, active = store.count_by_state(), store.count_present_workers()
        silent = max(0, len(store.workers()) - active)
        running = store.jobs(states=["running"], limit=10_000)
    expired = [job for job in running if job.lease_until is not None and job.lease_until < now]
    text = ", ".join(f"{count} {state}" for state, count in sorted(counts.items())) or "none yet"
    yield Check("jobs", "ok", text)
    text = f"{active} running"
    if silent:
        text += f"; {silent} not heard from for more than {SILENT:g} s: stopped or disconnected"
    waiting = counts.get("queued", 0) + len(expired)
    if waiting and not active:
        jobs = count_with_noun(waiting, "job")
        text += f"; {jobs} waiting without a worker; start slidercrank serve or slidercrank worker"
    yield Check("workers", "problem" if waiting and not active else "note" if silent else "ok", text)
    names = ", ".join(str(job.id) for job in expired[:5])
    text = (
        f"the leases of jobs {names} have expired; the next free worker continues them"
        if expired
        else "none has expired"
    )
    yield Check("leases", "note" if expired else "ok", text)


def _nearest_existing(folder: Path) -> Path:
    """Return the folder, or its nearest existing parent."""
    return next((place for place in (folder, *folder.parents) if place.exists()), folder)


def _check_writable(name: str, folder: Path) -> Check:
    try:
        with tempfile.TemporaryFile(dir=_nearest_existing(folder)):
            pass
    except OSError as error:
        text = f"{folder} is not writable: {error.strerror or error}; change its permissions, or choose another folder"
        return Check(name, "problem", text)
    return Check(name, "ok", f"{folder} is writable")


def _check_free_space(name: str, folder: Path) -> Check:
    free = shutil.disk_usage(_nearest_existing(folder.absolute())).free
    grade: Grade = "problem" if free < _LEAST_SPACE else "note" if free < _LITTLE_SPACE else "ok"
    remedy = "" if grade == "ok" else "; free some space: a full disk stops all writing"
    return Check(name, grade, f"{size_text(free)} free{remedy}")


def _check_compiled_model() -> Check:
    """Check the folder with the compiled model; if it is missing, every process spends minutes on compilation."""
    from ...model.kernel.kernel_digest import choose_folder

    folder, _, refused, other_folders = choose_folder()
    if not refused:
        return Check("compiled model", "ok", f"{folder} is writable")
    grade: Grade = "problem" if folder is None or os.environ.get("NUMBA_CACHE_DIR") else "note"
    places = [f"read from {place}" for place in other_folders] + ([f"kept in {folder}"] if folder else [])
    text = f"{refused}; it is {', else '.join(places) or 'compiled at every start'}"
    return Check("compiled model", grade, f"{text}; name a folder in NUMBA_CACHE_DIR")


def _check_versions() -> Check:
    from importlib.metadata import PackageNotFoundError, version

    lines = [f"Python {platform.python_version()}"]
    for name in (*_PACKAGES, *_OPTIONAL):
        try:
            lines.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            lines.append(f"{name} not installed")
    return Check("versions", "ok", ", ".join(lines))
