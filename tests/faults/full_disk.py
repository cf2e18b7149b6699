"""A disk that is full at random moments. SQLite's files may not grow, by the limit that the kernel sets on workers."""

from __future__ import annotations

import random
import sqlite3
import time
from pathlib import Path

from slidercrank.service.store import Store

from .audit import keep_audit
from .crew import crew
from .feed import Feed
from .kills import LEASE, finish
from .places import place
from .stored_results import undisturbed
from .verdict import Verdict, judge

_ROOM = 40_000  # bytes that are left at most
_JOURNAL = 100_000  # bytes that the journal may have, which has to go on
_LASTS = (0.1, 2.5)  # s


def fill_disk_at_random(count: int, seed: int) -> Verdict:
    """Fill the disk `count` times while workers solve jobs, and return what came of the jobs."""
    chance = random.Random(seed)
    expected = undisturbed()
    damaged = 0
    with place("sqlite") as where, Store(where.address) as store:
        keep_audit(where.address)
        log = Path(f"{where.address}-wal")
        feed = Feed(store, chance)
        journal = where.folder / "journal"
        with crew(where.address, journal, lease=LEASE) as workers:
            for _ in range(count):
                feed.fill()
                time.sleep(chance.uniform(0.0, 0.5))
                most = max(log.stat().st_size + chance.randrange(_ROOM), _JOURNAL)
                _limit(workers.pids(), most)
                time.sleep(chance.uniform(*_LASTS))
                _limit(workers.pids(), None)
                damaged += not is_intact(where.address)
            feed.fill()
            finish(feed, workers)
            verdict = judge(where.address, feed.jobs, expected, journal)
    for _ in range(damaged):
        verdict.violate("lost", "the file is damaged")
    if not verdict.failed:
        verdict.violate("lost", "no write failed, so that nothing was tried")
    return verdict


def is_intact(file: str) -> bool:
    """Whether SQLite finds nothing wrong in a file."""
    connection = sqlite3.connect(file)
    try:
        return bool(connection.execute("PRAGMA integrity_check").fetchone()[0] == "ok")
    finally:
        connection.close()


def _limit(pids: list[int], size: int | None) -> None:
    import resource  # not on Windows

    soft = resource.RLIM_INFINITY if size is None else size
    for pid in pids:
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (soft, resource.RLIM_INFINITY))
