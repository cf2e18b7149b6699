"""Workers killed by SIGKILL at random moments, one at a time or all at once."""

from __future__ import annotations

import random
import time

from slidercrank.service.store import Store

from .audit import keep_audit
from .crew import Crew, crew
from .feed import Feed
from .found import undisturbed
from .places import Kind, place
from .verdict import Verdict, judge

LEASE = 1.0
GRACE = 2.0  # s beyond the lease within which another worker goes on
_BETWEEN = 0.5  # s between two blows, on average
_ALL = 0.1  # share of the blows that hit all workers
_BUSY = 0.8  # share of the others that hit one that has a job


def kills(kind: Kind, count: int, seed: int) -> Verdict:
    """Kill workers `count` times while they solve jobs, and return what came of the jobs."""
    chance = random.Random(seed)
    expected = undisturbed()
    with place(kind) as where, Store(where.address) as store:
        keep_audit(where.address)
        feed = Feed(store, chance)
        journal = where.folder / "journal"
        feed.fill()
        with crew(where.address, journal, lease=LEASE) as workers:
            struck = 0
            while struck < count:
                time.sleep(chance.expovariate(1.0 / _BETWEEN))
                feed.fill()
                victims = _victims(chance, workers, feed)[: count - struck]
                workers.kill(*victims)
                struck += len(victims)
            finish(feed, workers)
            verdict = judge(where.address, feed.jobs, expected, journal, workers.deaths)
    if verdict.slowest > LEASE + GRACE:
        verdict.violate("late", f"a job went on after {verdict.slowest:.2f} s, lease {LEASE:g} s")
    return verdict


def finish(feed: Feed, workers: Crew, *, patience: float = 60.0) -> None:
    """Wait until all jobs have ended, or until none of them goes on any more."""
    end = time.monotonic() + patience
    while feed.under_way() and time.monotonic() < end:
        time.sleep(0.1)
    fallen = workers.fallen()
    if fallen:
        raise SystemExit(f"workers ended that nobody killed: {', '.join(fallen)}")


def _victims(chance: random.Random, workers: Crew, feed: Feed) -> list[str]:
    names = workers.names()
    if chance.random() < _ALL:
        return names
    busy = [name for name in feed.busy() if name in names]
    return [chance.choice(busy if busy and chance.random() < _BUSY else names)]
