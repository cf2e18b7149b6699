"""Workers and the API killed by SIGKILL at random moments, one at a time or all at once."""

from __future__ import annotations

import random
import time

from slidercrank.service.store import Store

from .api_process import Api, api
from .audit import keep_audit
from .caller import Caller
from .crew import Crew, crew
from .feed import Feed
from .places import Kind, place
from .stored_results import undisturbed
from .verdict import Verdict, judge

LEASE = 1.0
GRACE = 2.0  # s beyond the lease within which another worker goes on
_BETWEEN = 0.6  # s between two blows, on average
_AT_WORK = 0.6  # s, at most, from the submission of jobs to the next blow: they take no longer
_ALL = 0.1  # share of the blows that hit all workers and the API
_API = 0.2  # share of those that hit the API only; both if it answers: else it would never come to that
_BUSY = 0.8  # share of the others that hit a worker that has a job


def kills(kind: Kind, count: int, seed: int) -> Verdict:
    """Kill workers and the API `count` times while jobs are submitted and solved, and return what came of the jobs.

    It goes on until one of those killed had a job.
    """
    chance = random.Random(seed)
    expected = undisturbed()
    with place(kind) as where, Store(where.address) as store, api(where.address) as server:
        keep_audit(where.address)
        feed = Feed(store, chance)
        journal = where.folder / "journal"
        with crew(where.address, journal, lease=LEASE) as workers, Caller(server.url, feed.jobs, seed) as caller:
            struck, at_work = 0, False
            while struck < count or not at_work:
                time.sleep(chance.expovariate(1.0 / _BETWEEN))
                feed.fill()
                time.sleep(chance.uniform(0.0, _AT_WORK))
                victims, with_api = _victims(chance, workers, feed, server)
                workers.kill(*victims)
                at_work = at_work or not set(victims).isdisjoint(feed.busy())
                if with_api:
                    server.kill()
                struck += len(victims) + with_api
            caller.finish()
            finish(feed, workers)
            verdict = judge(where.address, feed.jobs, expected, journal, workers.deaths, within=LEASE + GRACE)
        _judge_caller(verdict, caller, store, set(feed.jobs))
    return verdict


def _judge_caller(verdict: Verdict, caller: Caller, store: Store, numbers: set[int]) -> None:
    if caller.error is not None:
        verdict.violate("events missed", f"the client gave up: {caller.error}")
    for number, seen in caller.seen.items():
        if seen != list(range(1, store.job(number).events + 1)):
            verdict.violate("events missed", f"job {number}: {seen}")
    there = {job.id for job in store.jobs(limit=1_000_000)}
    for number in there.symmetric_difference(numbers):
        verdict.violate("lost", f"job {number} was submitted twice or is gone")


def finish(feed: Feed, workers: Crew, *, patience: float = 60.0) -> None:
    """Wait until all jobs have ended, or until none of them goes on any more."""
    end = time.monotonic() + patience
    while feed.under_way() and time.monotonic() < end:
        time.sleep(0.1)
    fallen = workers.fallen()
    if fallen:
        raise SystemExit(f"workers ended that nobody killed: {', '.join(fallen)}")


def _victims(chance: random.Random, workers: Crew, feed: Feed, server: Api) -> tuple[list[str], bool]:
    """Return which workers are to be killed next, and whether the API is."""
    names = workers.names()
    blow = chance.random()
    if blow < _ALL + _API and server.answers():
        return (names if blow < _ALL else []), True
    busy = [name for name in feed.busy() if name in names]
    return [chance.choice(busy if busy and chance.random() < _BUSY else names)], False
