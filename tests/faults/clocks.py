"""The clock of a database set at random moments, by an hour or a day, while workers drain its queue."""

from __future__ import annotations

import random
import time

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from tests.service.store.clocks import Clock

from .audit import keep_audit
from .crew import crew
from .jobs import KINDS, tables
from .kills import LEASE
from .places import Kind, place
from .stored_results import undisturbed
from .verdict import Verdict, judge

_STEPS = (3600.0, 86_400.0)  # s
_BETWEEN = (0.2, 4.0)  # s from one step to the next: workers claim again two seconds after one
_JOBS = 6  # that wait each time
_PATIENCE = 60.0  # s that workers may take without a step


def clocks(kind: Kind, count: int, seed: int) -> Verdict:
    """Set the clock `count` times while workers drain one queue after the other; return what came of the jobs."""
    chance = random.Random(seed)
    expected = undisturbed()
    with place(kind) as where:
        journal, file = where.folder / "journal", where.folder / "clock"
        numbers: dict[int, str] = {}
        verdict = Verdict()
        with Clock(file).shown() as clock, Store(where.address) as store:
            keep_audit(where.address)
            while count > 0:
                numbers |= {submit(store, tables(job)).id: job for job in chance.choices(KINDS, k=_JOBS)}
                with crew(where.address, journal, size=2, lease=LEASE, clock=file) as workers:
                    end = time.monotonic() + _PATIENCE
                    while not workers.drained() and time.monotonic() < end:
                        time.sleep(chance.uniform(*_BETWEEN))
                        if count > 0:
                            count -= 1
                            clock.ahead += chance.choice(_STEPS) * chance.choice((1.0, -1.0))
                            end = time.monotonic() + _PATIENCE
                    if not workers.drained():
                        verdict.violate("late", "a worker that drains has not ended")
                waiting = store.count_by_state().get("queued", 0)
                if waiting:
                    verdict.violate(
                        "lost", f"{waiting} of {_JOBS} jobs wait though all workers ended: no job is waiting"
                    )
            verdict.add(judge(where.address, numbers, expected, journal))
    return verdict
