"""PostgreSQL crashed and started again at random moments, at once or after some seconds."""

from __future__ import annotations

import random
import time

from slidercrank.service.store import Store

from .audit import keep_audit
from .crew import crew
from .feed import Feed
from .kills import GRACE, LEASE, finish
from .places import place
from .stored_results import undisturbed
from .verdict import Verdict, judge

_BETWEEN = (0.5, 5.0)  # s from a start to the next crash
_AWAY = (0.0, 4.0)  # s that the server stays away; every other time it does not


def restarts(seconds: float, seed: int) -> tuple[int, Verdict]:
    """Crash the server for some time while workers solve jobs; return how often, and what came of the jobs."""
    chance = random.Random(seed)
    expected = undisturbed()
    ups: list[float] = []
    with place("postgresql") as where, Store(where.address) as store:
        assert where.server is not None
        keep_audit(where.address)
        feed = Feed(store, chance)
        journal = where.folder / "journal"
        with crew(where.address, journal, lease=LEASE) as workers:
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                feed.fill()
                time.sleep(chance.uniform(*_BETWEEN))
                where.server.stop(mode="immediate")
                if chance.random() < 0.5:
                    time.sleep(chance.uniform(*_AWAY))
                where.server.start()
                ups.append(time.time())
            feed.fill()
            finish(feed, workers)
            verdict = judge(where.address, feed.jobs, expected, journal)
        at = sorted(event.at for job in feed.jobs for event in store.events(job, limit=1_000_000))
    for up, down in zip(ups, [*ups[1:], time.time()], strict=True):
        following = next((moment for moment in at if moment > up), None)
        if following is not None and following < down:
            verdict.resumed(following - up)
        elif down - up > LEASE + GRACE + _AWAY[1]:
            verdict.violate("late", f"nothing went on for {down - up:.1f} s after a start")
    return len(ups), verdict
