"""A worker in a process of its own: the service's, with notes of its actions and with slower rounds."""

from __future__ import annotations

import contextlib
import logging
import random
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from slidercrank.model.errors import LeaseLost
from slidercrank.service.store import Claim, Store
from slidercrank.service.store.database import Database, Unavailable
from slidercrank.service.workers.worker import work
from tests.service.store.clocks import Clock

from .journal import Journal
from .lifeline import die_with_parent


def main(address: str, name: str, lease: float, journal: Path, pause: float, clock: Path | None) -> None:
    """Solve jobs for ever. pause: how long, in s, a round takes longer at most.

    clock: file of the one that the store is to have; then only until no job waits.
    """
    die_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the harness, which ends its workers
    logging.disable()  # it is expected to warn
    _record_writes(Journal(journal), pause)
    with contextlib.nullcontext() if clock is None else Clock(clock).shown(), Store(address) as store:
        work(store, name=name, lease=lease, drain=clock is not None)


def _record_writes(journal: Journal, pause: float) -> None:
    report, write, writing = Claim.report, Claim._write, Database.writing
    chance = random.Random()

    def slow_report(claim: Claim, progress: Any, *front: Any) -> None:
        if not progress.steps:
            journal.note("evaluated", claim.job.id, claim.job.fence, progress.round)
        time.sleep(chance.uniform(0.0, pause))
        report(claim, progress, *front)

    def noted_write(claim: Claim, *given: Any, **options: Any) -> None:
        with claim._lock:
            try:
                write(claim, *given, **options)
            except LeaseLost:
                journal.note("refused", claim.job.id, claim.job.fence, claim._writes + 1)
                raise
            journal.note("wrote", claim.job.id, claim.job.fence, claim._writes)

    @contextlib.contextmanager
    def noted_writing(database: Database) -> Iterator[Any]:
        try:
            with writing(database) as connection:
                yield connection
        except Unavailable:
            journal.note("failed", 0, 0, 0)
            raise

    for owner, name, noted in (
        (Claim, "report", slow_report),
        (Claim, "_write", noted_write),
        (Database, "writing", noted_writing),
    ):
        setattr(owner, name, noted)
