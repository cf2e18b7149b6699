"""Choice of the store that the command line uses."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..runs.run_folder import disk, runs_place
from ..text.screen import say

if TYPE_CHECKING:
    from ..store import Store

STORE_VARIABLE = "SLIDERCRANK_STORE"
FILE = "slidercrank.db"

Address = Annotated[
    str | None,
    typer.Option(
        "--store",
        metavar="ADDRESS",
        help="Where jobs are kept: a file, or postgresql://user@host/database.  [default: SLIDERCRANK_STORE, else "
        f"{FILE} where runs are kept]",
    ),
]


def store_address(option: str | None, runs: Path | None = None) -> str:
    """Return the address of the store: the option, else SLIDERCRANK_STORE, else a file where runs are kept."""
    return option or os.environ.get(STORE_VARIABLE) or str(runs_place(runs) / FILE)


def is_named(option: str | None) -> bool:
    """Whether somebody says where the store is; else it is in its usual place."""
    return bool(option or os.environ.get(STORE_VARIABLE))


def open_store(option: str | None, runs: Path | None = None) -> Store:
    """Open the store, and create it where it is a file that is not there yet.

    Raises `StoreError` where that is not possible, `InputError` for an address that is none.
    """
    from ..store import Store

    address = store_address(option, runs)
    if "://" not in address:
        with disk(Path(address).parent):
            Path(address).parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    return Store(address)


def has_store(option: str | None, runs: Path | None = None) -> bool:
    """Whether there is a store to look into, without making one."""
    address = store_address(option, runs)
    return "://" in address or Path(address).is_file()


def tell_idle(store: Store) -> None:
    """Say that jobs wait if no worker is there to solve them."""
    if not store.workers_at_work():
        say("slidercrank: no worker is at work, so jobs wait; start one with: slidercrank serve")
