"""Which store the command line uses."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..runs.run_folder import disk, runs_place

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


def open_store(option: str | None, runs: Path | None = None) -> Store:
    """Open the store, and create it where it is a file that is not there yet.

    Raises `StoreError` where that is not possible, `InputError` for an address that is none.
    """
    from ..store import Store

    address = store_address(option, runs)
    if "://" not in address:
        with disk(Path(address).parent):
            Path(address).parent.mkdir(parents=True, exist_ok=True)
    return Store(address)


def has_store(option: str | None, runs: Path | None = None) -> bool:
    """Whether there is a store to look into, without making one."""
    address = store_address(option, runs)
    return "://" in address or Path(address).is_file()
