"""Workers that are killed or paused at any moment lose nothing, double nothing and change nothing.

Processes of their own, real signals, a made-up search.
"""

from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Callable, Iterator
from multiprocessing import get_context
from multiprocessing.process import BaseProcess

import pytest

from slidercrank.service.store import Store
from tests.service.store.contents import add, search_record
from tests.service.store.made_up_worker import ROUNDS, found, main

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the test sends signals of POSIX systems")
LEASE = 0.6
JOBS = 6
Start = Callable[[], BaseProcess]


@pytest.fixture
def start(address: str) -> Iterator[Start]:
    """Return a function that starts a worker on the store; all are gone after the test."""
    context = get_context("forkserver")  # the imports are done once for all workers
    context.set_forkserver_preload([main.__module__])
    started: list[BaseProcess] = []

    def begin() -> BaseProcess:
        worker = context.Process(target=main, args=(address, LEASE), daemon=True)
        worker.start()
        started.append(worker)
        return worker

    yield begin
    for worker in started:
        worker.kill()
        worker.join()


def send(worker: BaseProcess, blow: signal.Signals) -> None:
    assert worker.pid is not None
    os.kill(worker.pid, blow)


def wait(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end, "it did not come about within a minute"
        time.sleep(0.05)


def test_killed_and_paused_workers_lose_and_double_nothing(store: Store, start: Start) -> None:
    chance = random.Random(5)
    jobs = [add(store, most_attempts=100).id for _ in range(JOBS)]
    workers = [start() for _ in range(3)]
    wait(lambda: store.count_by_state().get("running") == 3)
    for blow in (signal.SIGKILL, signal.SIGSTOP):
        send(workers[blow == signal.SIGSTOP], blow)
        time.sleep(chance.uniform(0.0, 0.2))
    time.sleep(2.0 * LEASE)
    send(workers[1], signal.SIGCONT)
    wait(lambda: store.count_by_state() == {"done": JOBS})
    expected = found([search_record(number) for number in range(ROUNDS)])
    for job in jobs:
        assert store.result(job).designs == expected
        events = store.events(job)
        # What was committed is never done again: a round and its record are there together or not at all.
        assert [event.data["round"] for event in events if event.kind == "progress"] == list(range(1, ROUNDS + 1))
        states = [event.data["state"] for event in events if event.kind == "state"]
        assert (states[0], states[-1], states.count("done")) == ("queued", "done", 1)
    claims = sum(store.job(job).fence for job in jobs)
    assert claims > JOBS  # some were taken from the hands of others
