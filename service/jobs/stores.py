"""Store of the command line, and its jobs by number or as "latest"."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError, NotFound
from ..runs.run_folder import runs_folder, translate_disk_errors
from ..text.screen import print_message

if TYPE_CHECKING:
    from ..store import Job, Store

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
