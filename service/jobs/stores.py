"""Store of the command line, with its jobs by number or as "latest", and the folders of its runs."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError, NotFound
from ...model.file_name_encoding import path_text
from ..runs.run_folder import MARK, RunFolder, runs_folder, translate_disk_errors
from ..text.screen import print_message

if TYPE_CHECKING:
    from ..store import Job, State, Store

STORE_VARIABLE = "SLIDERCRANK_STORE"
FILE = "slidercrank.db"

Address = Annotated[
    str | None,
    typer.Option(
        "--store",
        metavar="ADDRESS",
        help=f"Store of jobs: a file, or postgresql://user@host/database. [default: SLIDERCRANK_STORE, else {FILE} in "
        "the folder of runs]",
    ),
]
Name = Annotated[str, typer.Argument(metavar="JOB", help='The job: its number, or "latest".')]


def store_address(option: str | None, runs: Path | None = None) -> str:
    """Return the address of the store: the option, or SLIDERCRANK_STORE, or a file in the folder of runs."""
    return option or os.environ.get(STORE_VARIABLE) or str(runs_folder(runs) / FILE)


def printable_store_address(option: str | None, runs: Path | None = None) -> str:
    """Return the address of the store without secrets, for output."""
    from ..store.address import without_secrets

    return without_secrets(store_address(option, runs))


def is_store_specified(option: str | None) -> bool:
    """Whether the location of the store was specified; otherwise it is the default."""
    return bool(option or os.environ.get(STORE_VARIABLE))


def open_store(option: str | None, runs: Path | None = None) -> Store:
    """Open the store; create its file if missing.

    Raises `StoreError` if that fails, `InputError` for an invalid address.
    """
    from ..store import Store

    address = store_address(option, runs)
    if "://" not in address:
        with translate_disk_errors(Path(address).parent):
            Path(address).parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    return Store(address)


def has_store(option: str | None, runs: Path | None = None) -> bool:
    """Whether there is a store to inspect; does not create one.

    Raises `InputError` for an invalid address, and `StoreError` for a file that cannot be a store; see `has_content`.
    """
    address = store_address(option, runs)
    with translate_disk_errors(Path(address).parent):
        if not is_store_specified(option) and not any(Path(f"{address}{end}").exists() for end in ("", "-wal")):
            return False  # the usual case, handled without importing SQLAlchemy
    from ..store.address import file_of, has_content

    file = file_of(address)
    return file is None or has_content(file)


def warn_without_workers(store: Store) -> None:
    """Report waiting jobs if no worker is available to solve them."""
    if not store.count_present_workers():
        print_message("slidercrank: no worker is running, so jobs wait; start one with: slidercrank serve")


@contextmanager
def existing_store(option: str | None) -> Iterator[Store]:
    """Yield the store, and close it afterwards. Raises `NotFound` for a missing file, which is not created."""
    if not has_store(option):
        raise NotFound(
            f"there is no store at {printable_store_address(option)}; submit a job first, or name another with --store"
        )
    with open_store(option) as store:
        yield store


def find_job(store: Store, name: str) -> Job:
    """Return the job of a given name. Raises `NotFound` if there is none, `InputError` for an invalid name."""
    if name == "latest":
        latest = store.jobs(limit=1)
        if not latest:
            raise NotFound(f"there is no job in {store.name} yet; submit one")
        return latest[0]
    if not (name.isascii() and name.isdecimal() and len(name) <= 18):
        from ..store.address import without_secrets

        raise InputError(
            f'a job must be given by its number, or "latest"; got {without_secrets(name)[:80]!r}; list the jobs'
        )
    return store.job(int(name))


_FOUND: tuple[State, ...] = ("done", "infeasible", "cancelled")


def find_run(text: str, place: Path) -> Path:
    """Return the folder of a run, given by path, name, unique prefix of a name, or "latest".

    A job number in the store is accepted too; its folder is written if missing. Raises `InputError` if no run or
    several runs match, and `RunError` for a job without a result yet.
    """
    if (text == "latest" or not Path(text).exists()) and has_store(None, place):
        with open_store(None, place) as store:
            job = _stored_job(store, text, place)
            if job is not None:
                return export_run_folder(store, job, place)
    return find_folder(text, place)


def export_run_folder(store: Store, job: Job, place: Path) -> Path:
    """Write the run folder of a job that has a result, unless it exists, and return it."""
    path = place / job.run
    if path.is_dir():
        return path
    result = store.result(job.id)
    files = {name: store.artefact(job.id, name).content for name in store.artefact_names(job.id)}
    versions = json.loads(files.pop("versions.json", b"{}"))
    with RunFolder(place, job.name) as folder:
        folder.rename(job.run)
        folder.keep_files(files)
        folder.keep_result(replace(result, run=path_text(path)), versions)
    return path


def _stored_job(store: Store, text: str, place: Path) -> Job | None:
    """Return the job that a text refers to, or None if it refers to a folder."""
    if text.isdecimal():
        try:
            return store.job(int(text))
        except NotFound:
            return None
    if text == "latest":
        latest = store.jobs(states=_FOUND, limit=1)
        names = [folder.name for folder in run_folders(place)]
        return latest[0] if latest and latest[0].run > max(names, default="") else None
    return store.find_by_run(text)


def find_folder(text: str, place: Path) -> Path:
    """Return the folder of a run on disk; see `find_run`.

    Raises `InputError` if no run or several runs match.
    """
    names = sorted(
        (run.name for run in run_folders(place)), key=lambda name: (name[:15], (place / name).stat().st_mtime_ns)
    )
    if text == "latest":
        if not names:
            raise InputError(f"there is no run in {place} yet; optimise a job first")
        return place / names[-1]
    if text in names:
        return place / text
    path = Path(text)
    if text and path.is_dir():
        return path
    if text and path.exists():
        raise InputError(f"a run must be a folder; got the file {text}; name its folder")
    matches = [name for name in names if name.startswith(text)] if text else []
    if len(matches) == 1:
        return place / matches[0]
    if matches:
        examples = ", ".join(matches[:4]) + (", ..." if len(matches) > 4 else "")
        raise InputError(f"the start of a run's name must be unique; {text!r} matches {examples}; give more of it")
    last = f"; the latest is {names[-1]}" if names else ""
    raise InputError(f"there is no run {path_text(text)!r}, neither as a folder nor in {place}{last}")


def run_folders(place: Path) -> list[Path]:
    """Return the run folders in a location, unordered."""
    if not place.is_dir():
        return []
    return [
        folder
        for folder in place.iterdir()
        if not folder.name.startswith(".") and ((folder / MARK).is_file() or (folder / "front.json").is_file())
    ]
