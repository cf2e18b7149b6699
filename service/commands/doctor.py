"""`slidercrank doctor`: whether the service can do its work here, and a backup of its store."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Annotated

import typer

from ...model.errors import NotFound
from ..jobs.stores import Address, has_store, is_named, store_address
from ..runs.run_folder import runs_place
from ..text.options import File, Json, Runs
from ..text.screen import console, give, say

UNHEALTHY = 1
"""Exit code where something is not in order; 2 is for wrong input."""


def doctor(
    store: Address = None,
    runs: Runs = None,
    backup: Annotated[File, "Copy a store that is a file into a new file, while it is used."] = None,
    json: Json = False,
) -> None:
    """Look whether store, workers, disks and software are in order; exit code 1 if anything is not.

    Looked at are: the database and its tables, whether anything in it is damaged, its clock, jobs that wait without a
    worker, places to write, free disk, versions. No job is changed.
    """
    from ..runs.result import json_text
    from .diagnosis import diagnose

    address = store_address(store, runs)
    if backup is not None:
        _back_up(store, runs, backup)
    checks = diagnose(address, runs_place(runs), named=is_named(store))
    healthy = all(check.grade != "problem" for check in checks)
    if json:
        give(json_text({"healthy": healthy, "checks": [check._asdict() for check in checks]}))
    else:
        screen = console()
        for check in checks:
            style = {"problem": "bold", "note": "", "ok": "dim"}[check.grade]
            screen.print(f"{check.grade:<9}{check.name:<18} {check.text}", style=style, soft_wrap=True)
    if not healthy:
        raise typer.Exit(UNHEALTHY)


def _back_up(store: str | None, runs: Path | None, target: Path) -> None:
    from ..store.backup import back_up
    from ..store.database import Database

    if not has_store(store, runs):
        raise NotFound(f"there is no store at {store_address(store, runs)}; name the one to copy with --store")
    with contextlib.closing(Database(store_address(store, runs))) as database:
        back_up(database, target)
    say(f"{target}: a copy of {database.name}")
