"""Workers stopped by SIGSTOP at random moments, for longer than their lease, and woken when others have their jobs."""

from __future__ import annotations

import random
import time
from pathlib import Path

from slidercrank.service.store import Store

from .audit import keep_audit
from .crew import crew
from .feed import Feed
from .journal import notes
from .kills import LEASE, finish
from .places import Kind, place
from .stored_results import undisturbed
from .verdict import Verdict, judge

_LONGER = (0.2, 2.0)  # s beyond the lease
_MOST = 10  # times as many pauses as asked for, on a machine where writes rarely fall into them


def pauses(kind: Kind, count: int, seed: int) -> Verdict:
    """Pause busy workers `count` times and until a write is refused; return the final states of the jobs."""
    chance = random.Random(seed)
    expected = undisturbed()
    with place(kind) as where, Store(where.address) as store:
        keep_audit(where.address)
        feed = Feed(store, chance)
        journal = where.folder / "journal"
        feed.fill()
        with crew(where.address, journal, size=4, lease=LEASE) as workers:
            done = 0
            while done < count or (done < _MOST * count and not _was_refused(journal)):
                time.sleep(chance.uniform(0.0, 0.3))
                feed.fill()
                stopped = feed.busy()[: max(1, count - done)]
                for name in stopped:
                    workers.stop(name)
                    time.sleep(chance.uniform(0.0, 0.1))
                time.sleep(LEASE + chance.uniform(*_LONGER))
                for name in stopped:
                    workers.wake(name)
                done += len(stopped)
            finish(feed, workers)
            verdict = judge(where.address, feed.jobs, expected, journal)
    if not verdict.refused:
        verdict.violate("stale writes", "no write was refused, so that the fence was not tried")
    return verdict


def _was_refused(journal: Path) -> bool:
    return any(note.what == "refused" for note in notes(journal))
