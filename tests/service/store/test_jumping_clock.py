"""The clock of the database is set, forward and back by hours, while jobs wait and are solved."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from slidercrank.model.errors import LeaseLost
from slidercrank.service.store import Claim, Store
from slidercrank.service.store.database_clock import JUMP, SETTLING, ClockJumps
from slidercrank.service.workers.heartbeat import Heartbeat
from slidercrank.service.workers.worker import solve_claimed, work
from tests.service.store.clocks import Clock
from tests.service.store.contents import add, claim_waiting_job, progress, result, search_record

HOURS = [7200.0, -7200.0, 1200.0, -1200.0]
steps = pytest.mark.parametrize("step", HOURS, ids=[f"{step / 60:+.0f} min" for step in HOURS])


@pytest.fixture
def clock(tmp_path: Path) -> Iterator[Clock]:
    """Return a clock that can be set."""
    with Clock(tmp_path / "clock").shown() as made:
        yield made


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let claims settle within a moment of a jump, but not before a heartbeat has looked."""
    monkeypatch.setattr("slidercrank.service.store.database_clock.SETTLING", 0.8)


@steps
@pytest.mark.usefixtures("at_once")
def test_a_job_stays_with_its_worker_when_the_clock_is_set(store: Store, clock: Clock, step: float) -> None:
    job = add(store)
    store.register("first")
    claim = claim_waiting_job(store, "first", lease=30.0)
    assert store.claim("second") is None  # it has seen the clock as it was
    with Heartbeat(claim):
        clock.ahead = step
        for _ in range(6):
            assert store.claim("second") is None
            time.sleep(0.2)
        claim.keep_record(search_record(1))
        claim.report(progress(1))
    claim.finish(result())
    ended = store.job(job.id)
    assert (ended.state, ended.fence) == ("done", 1)


@steps
def test_a_write_between_a_jump_and_the_next_renewal_is_taken(store: Store, clock: Clock, step: float) -> None:
    add(store)
    claim = claim_waiting_job(store)
    clock.ahead = step
    claim.report(progress(1))
    left = store.job(1).lease_until
    assert left is not None
    assert left == pytest.approx(time.time() + step + claim.lease, abs=5.0)


@steps
def test_the_job_of_a_dead_worker_goes_to_another_one_when_the_clock_was_set(
    store: Store, address: str, clock: Clock, step: float
) -> None:
    job = add(store)
    store.register("first")
    lost = claim_waiting_job(store, "first", lease=30.0)
    lost.report(progress(1))
    clock.ahead = step
    with Store(address) as other:  # one that has not seen the jump
        again = other.claim("second")
        assert again is not None
        assert (again.job.id, again.job.fence) == (job.id, 2)
        with pytest.raises(LeaseLost):
            lost.finish(result())
        again.finish(result())
    states = [one.data["state"] for one in store.events(job.id) if one.kind == "state"]
    assert states == ["queued", "running", "running", "done"]


@pytest.mark.parametrize("ahead", [7200.0, 600.0])
def test_a_job_that_was_submitted_under_a_clock_set_back_since_is_claimed_at_once(
    store: Store, address: str, clock: Clock, ahead: float
) -> None:
    clock.ahead = ahead
    job = add(store)
    clock.ahead = 0.0
    with Store(address) as other:
        claim = other.claim("first")
    assert claim is not None
    assert claim.job.id == job.id


def test_a_job_that_its_worker_leaves_is_free_at_once_whatever_the_clock_says(
    store: Store, address: str, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lose(claim: Claim, _: Any) -> None:
        raise LeaseLost(f"job {claim.job.id}")

    monkeypatch.setattr("slidercrank.service.workers.worker._solve_and_end", lose)
    store.register("first")
    job = add(store)
    solve_claimed(store, claim_waiting_job(store, "first", lease=30.0), lambda: False)
    clock.ahead = -86_400.0
    store.register("first")  # it lives, so that nothing else tells that it has left the job
    assert store.has_waiting_jobs()
    with Store(address) as other:
        again = claim_waiting_job(other, "second")
        assert (again.job.id, again.job.fence) == (job.id, 2)
        solve_claimed(store, Claim(store, replace(again.job, fence=1), 30.0), lambda: False)
    left = store.job(job.id).lease_until
    assert left is not None
    assert left > 0.0, "only the latest claim lets its lease end"


@pytest.fixture
def solving(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that puts another one in the place of a worker's search; nobody waits long for a clock."""
    monkeypatch.setattr("slidercrank.service.store.database_clock.SETTLING", 0.05)
    monkeypatch.setattr("slidercrank.service.workers.worker.PULSE", 0.005)
    return lambda solve: monkeypatch.setattr("slidercrank.service.workers.worker.solve_claimed", solve)


@pytest.mark.parametrize("seed", range(3))
def test_a_worker_that_drains_solves_all_that_waits_though_the_clock_is_set(
    store: Store, clock: Clock, solving: Any, seed: int
) -> None:
    chance = random.Random(seed)
    jobs = [add(store).id for _ in range(6)]

    def solve(_store: Store, claim: Claim, *_: Any) -> None:
        clock.ahead += chance.choice([3600.0, 86_400.0]) * chance.choice([1.0, -1.0])
        claim.finish(result())

    solving(solve)
    assert work(store, drain=True) == len(jobs)
    assert store.count_by_state() == {"done": len(jobs)}
    assert {store.job(job).fence for job in jobs} == {1}


def test_a_worker_that_drains_waits_for_a_job_that_is_not_due_yet(store: Store, solving: Any) -> None:
    job = add(store)
    attempts: list[int] = []

    def solve(_store: Store, claim: Claim, *_: Any) -> None:
        attempts.append(claim.job.attempts)
        if len(attempts) == 1:
            claim.fail("an error", again=True, delay=0.2)
        else:
            claim.finish(result())

    solving(solve)
    assert work(store, drain=True) == 2
    assert (store.job(job.id).state, attempts) == ("done", [1, 2])


def test_a_job_that_is_tried_again_is_due_within_a_minute(store: Store) -> None:
    job = add(store, most_attempts=100)
    claim_waiting_job(store).fail("an error", again=True, delay=1e30)
    assert store.job(job.id).due - time.time() < 61.0
    assert store.claim("second") is None


@steps
def test_a_worker_that_is_gone_does_not_look_alive_when_the_clock_was_set(
    store: Store, clock: Clock, step: float
) -> None:
    store.register("first")
    clock.ahead = step
    store.register("second")
    assert [worker.id for worker in store.workers() if worker.silent < 30.0] == ["second"]


def test_jumps_are_told_from_delays_and_from_sleep() -> None:
    here = 100.0
    jumps = ClockJumps(lambda: here)
    assert jumps.is_steady(5000.0)
    for passed, there, settled in (
        (10.0, 5010.0, True),
        (0.5, 5010.5 + 0.9 * JUMP, True),  # a slow answer
        (0.5, 5011.0, True),
        (0.5, 8611.5, False),
        (SETTLING - 0.5, 8611.5 + SETTLING - 0.5, False),
        (0.5, 8611.5 + SETTLING, True),
        (0.5, 8612.0 + SETTLING - 2.0 * JUMP, False),
    ):
        here += passed
        assert jumps.is_steady(there) is settled, there
