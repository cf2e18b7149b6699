"""Contract of every store on jobs, whatever its database."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, get_args

import numpy as np
import pytest

from slidercrank.model.errors import InputError, QueueFull
from slidercrank.service.store import Artefact, Job, State, Store
from slidercrank.service.store.bookmarks_and_wishes import bookmark_design
from slidercrank.service.store.job_rows import Order
from tests.service.store.contents import (
    TABLES,
    add,
    all_rows,
    claim_waiting_job,
    result,
    search_record,
)


def test_a_submitted_job_waits_and_is_what_was_submitted(store: Store) -> None:
    job = add(store, priority=3, most_attempts=5)
    assert store.job(job.id) == job
    assert (job.name, job.state, job.priority, job.most_attempts, job.fence) == ("Feeder", "queued", 3, 5, 0)
    assert job.submitted == pytest.approx(job.due, abs=1.0)
    assert store.job_tables(job.id) == TABLES
    assert [(event.number, event.kind, event.data["state"]) for event in store.events(job.id)] == [
        (1, "state", "queued")
    ]


def test_jobs_are_listed_latest_first_in_pages_by_state_and_by_name(store: Store) -> None:
    numbers = [add(store, name).id for name in ("Feeder", "Sieve", "feeder 100 %")]
    claim_waiting_job(store)
    assert [job.id for job in store.jobs()] == numbers[::-1]
    assert [job.id for job in store.jobs(limit=2)] == numbers[:0:-1]
    assert [job.id for job in store.jobs(before=numbers[1])] == numbers[:1]
    assert [job.id for job in store.jobs(states=["queued"])] == numbers[:0:-1]
    assert [job.id for job in store.jobs(name="FEED")] == [numbers[2], numbers[0]]
    assert [job.id for job in store.jobs(name="0 %")] == [numbers[2]]
    assert [job.id for job in store.jobs(numbers=[numbers[0], 99, numbers[2]])] == [numbers[2], numbers[0]]
    assert store.jobs(numbers=[numbers[2]], before=numbers[2]) == []
    assert store.count_by_state() == {"queued": 2, "running": 1}


def test_every_order_of_jobs_is_that_of_its_key_page_by_page(store: Store) -> None:
    random = np.random.default_rng(3)
    numbers = [add(store, str(name)).id for name in random.choice(["press", "Press", "Äpfel", "sieve", "100 %"], 23)]
    for number in random.choice(numbers, 7, replace=False):
        store.cancel(int(number))
    for _ in range(4):
        claim_waiting_job(store)
    for number in random.choice(numbers, 6, replace=False):
        bookmark_design(store, int(number), dimensions=(0.04, 0.1, 0.0), name="Rounded", decided=bool(number % 2))
    keys: dict[Order, Callable[[Job], Any]] = {
        "newest": lambda job: -job.id,
        "oldest": lambda job: job.id,
        "state": lambda job: get_args(State).index(job.state),
        "decided": lambda job: job.decision is None,
    }
    for order, key in keys.items():
        expected = [job.id for job in sorted(store.jobs(), key=lambda job: (key(job), -job.id))]
        assert [job.id for job in store.jobs(order=order)] == expected
        pages: list[int] = []
        while page := [job.id for job in store.jobs(order=order, limit=5, before=pages[-1] if pages else None)]:
            pages += page
        assert pages == expected
    names = [job.name.lower() for job in store.jobs(order="name") if job.name.isascii()]
    assert names == sorted(names)
    waiting = [job.id for job in store.jobs(order="state", states=["queued"], name="press")]
    assert waiting == [job.id for job in store.jobs(states=["queued"], name="press")]
    assert str(store.count_workers_and_waiting_jobs()) == "no worker, 12 waiting: start one with slidercrank worker"
    store.register("one")
    assert str(store.count_workers_and_waiting_jobs()) == "1 worker, 0 busy, 12 waiting"


def test_the_highest_priority_is_claimed_first_then_the_oldest(store: Store) -> None:
    low, first, second = add(store, priority=-1), add(store), add(store)
    high = add(store, priority=5)
    assert [claim_waiting_job(store).job.id for _ in range(4)] == [high.id, first.id, second.id, low.id]
    assert store.claim("first") is None


def test_each_job_is_claimed_once_however_many_workers_ask(store: Store, address: str) -> None:
    numbers = {add(store).id for _ in range(12)}
    start = threading.Barrier(4)

    def claim_all(worker: int) -> list[int]:
        with Store(address) as own:
            start.wait()
            found = []
            while (claim := own.claim(f"worker {worker}", lease=60.0)) is not None:
                found.append(claim.job.id)
            return found

    with ThreadPoolExecutor(4) as pool:
        claimed = [number for found in pool.map(claim_all, range(4)) for number in found]
    assert sorted(claimed) == sorted(numbers)


def test_a_waiting_job_is_cancelled_at_once(store: Store) -> None:
    job = add(store)
    assert store.cancel(job.id).state == "cancelled"
    assert store.claim("first") is None
    assert store.cancel(job.id).events == 2  # a second time changes nothing


def test_only_an_ended_job_is_deleted_and_nothing_of_it_stays(store: Store, address: str) -> None:
    job = add(store)
    claim = claim_waiting_job(store)
    claim.keep_record(search_record(1))
    with pytest.raises(InputError, match="job 1 is running; cancel it first"):
        store.delete(job.id)
    claim.finish(result("cancelled"), [Artefact(name="a", media_type="text/plain", content=b"")])
    store.delete(job.id)
    assert all(not rows for rows in all_rows(address).values())
    with pytest.raises(InputError, match="there is no job 1"):
        store.job(job.id)
    assert add(store).id == job.id + 1  # a number never comes back


def test_no_more_jobs_wait_than_may(store: Store) -> None:
    store.most_queued = 2
    add(store)
    add(store)
    with pytest.raises(QueueFull, match="at most 2 jobs may wait; 2 do"):
        add(store)
    claim_waiting_job(store)
    add(store)


def test_submissions_at_the_same_moment_do_not_overfill_the_queue(address: str) -> None:
    def submit(_: int) -> bool:
        with Store(address, most_queued=3) as own:
            try:
                add(own)
            except QueueFull:
                return False
            return True

    with ThreadPoolExecutor(4) as pool:
        assert sum(pool.map(submit, range(8))) == 3


def test_a_key_submits_once(store: Store, address: str) -> None:
    job = add(store, key="today")
    assert add(store, key="today") == job
    with pytest.raises(InputError, match="'today' is that of job 1, which differs"):
        store.submit({**TABLES, "name": "Sieve"}, name="Sieve", key="today")
    assert add(store).id != add(store).id

    def submit(_: int) -> int:
        with Store(address) as own:
            return add(own, key="at once").id

    with ThreadPoolExecutor(4) as pool:
        assert len(set(pool.map(submit, range(8)))) == 1


def test_workers_are_known_while_they_are_there(store: Store) -> None:
    store.register("first")
    store.register("second")
    add(store)
    seen = {worker.id: worker.seen for worker in store.workers()}
    time.sleep(0.01)  # a clock that counts milliseconds has to go on
    claim_waiting_job(store, "first").renew()
    assert [worker.id for worker in store.workers()] == ["first", "second"]
    assert store.workers()[0].seen > seen["first"]
    assert 0.0 <= store.workers()[1].silent < 60.0
    store.unregister("first")
    assert [worker.id for worker in store.workers()] == ["second"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"key": ""}, "got ''"),
        ({"key": "a\nb"}, "printable"),
        ({"most_attempts": 0}, "got 0 and 0"),
        ({"priority": 1001}, "got 1001 and 3"),
    ],
)
def test_a_submission_out_of_bounds_is_refused(options: dict[str, Any], words: str, store: Store) -> None:
    with pytest.raises(InputError, match=words):
        add(store, **options)
    with pytest.raises(InputError, match="at most an hour; got 0"):
        store.claim("first", lease=0.0)
