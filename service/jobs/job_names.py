"""Jobs of a store by the names that people give them on the command line: a number, or "latest"."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError, NotFound
from .stores import has_store, open_store, store_address

if TYPE_CHECKING:
    from ..store import Job, Store

Name = Annotated[str, typer.Argument(metavar="JOB", help='The job: its number, or "latest".')]


@contextmanager
def store_that_is_there(option: str | None) -> Iterator[Store]:
    """Give the store, closed at the end. Raises `NotFound` for a file that is not there: looking makes none."""
    if not has_store(option):
        raise NotFound(
            f"there is no store at {store_address(option)}; submit a job first, or name another with --store"
        )
    with open_store(option) as store:
        yield store


def find_job(store: Store, name: str) -> Job:
    """Return the job of a name. Raises `NotFound` if there is none, `InputError` for what is no name."""
    if name == "latest":
        latest = store.jobs(limit=1)
        if not latest:
            raise NotFound(f"there is no job in {store.name} yet; submit one")
        return latest[0]
    if not (name.isascii() and name.isdecimal() and len(name) <= 18):
        raise InputError(f'a job is called by its number, or "latest"; got {name[:80]!r}; list the jobs')
    return store.job(int(name))
