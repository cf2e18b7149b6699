"""A small disk with room for a lease but not for a round, at random moments, longer than attempts last."""

from __future__ import annotations

import random
import tempfile
import time
from pathlib import Path

from slidercrank.service.store import Store

from .audit import keep_audit
from .crew import crew
from .feed import Feed
from .full_disk import is_intact
from .kills import finish
from .small_disk import small_disk
from .stored_results import undisturbed
from .verdict import Verdict, judge

_ROOM = 60_000  # bytes that are left at most
_ATTEMPTS = 3
_LEASE = 2.0  # s: on a busy machine, too, a worker renews it unless there is no room
_UNDER_WAY = 1.0  # s, by which a claim that began before the disk was full has ended
_LASTS = (1.0, 2.0)  # of the time in which all attempts of a job could be used up
_SIZE = "12m"  # a store takes its write-ahead log into its file at 4 MB, and needs room for both


def fill_store_disk(count: int, seed: int) -> Verdict:
    """Fill the disk of a store `count` times while workers solve jobs; return the final states of the jobs."""
    chance = random.Random(seed)
    expected = undisturbed()
    full: list[tuple[float, float]] = []
    with small_disk(_SIZE) as disk, tempfile.TemporaryDirectory(prefix="faults-") as beside:
        address, journal = str(disk.folder / "store.db"), Path(beside) / "journal"
        with Store(address) as store:
            keep_audit(address)
            feed = Feed(store, chance, most_attempts=_ATTEMPTS)
            with crew(address, journal, lease=_LEASE) as workers:
                for _ in range(count):
                    feed.fill()
                    time.sleep(chance.uniform(0.0, 1.0))
                    disk.fill(left=chance.randrange(_ROOM))
                    time.sleep(_UNDER_WAY)
                    begin = time.time()
                    time.sleep(_ATTEMPTS * _LEASE * chance.uniform(*_LASTS))
                    full.append((begin, time.time()))
                    disk.empty()
                feed.fill()
                finish(feed, workers)
                verdict = judge(address, feed.jobs, expected, journal)
            for job in feed.jobs:
                for one in store.events(job, limit=1_000_000):
                    if one.data.get("state") == "running" and any(begin < one.at < end for begin, end in full):
                        verdict.violate("lost", f"job {job} was claimed on a full disk")
        if not is_intact(address):
            verdict.violate("lost", "the file is damaged")
    if not verdict.failed:
        verdict.violate("lost", "no write failed, so that nothing was tried")
    return verdict
