"""A full disk during a round: the job stays with its worker and continues once there is space."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from slidercrank.service.store import Limits, Store
from slidercrank.service.store.database import Full
from slidercrank.service.store.database_clock import SETTLING, ClockJumps
from slidercrank.service.workers.heartbeat import DEAF, Budget, Heartbeat
from tests.service.made_up_search import until
from tests.service.store.contents import add, claim_waiting_job, end_lease, is_same_record, progress, search_record
from tests.service.store.small_disk import Disk, large_record

LEASE = 0.2


def test_a_round_without_room_keeps_its_lease_for_as_long_as_it_waits(store: Store) -> None:
    disk = Disk(store)
    job = add(store, most_attempts=1)
    claim = claim_waiting_job(store)
    claim.keep_record(large_record(1))
    disk.fill()
    leases: set[float | None] = set()

    def outlasts() -> bool:
        leases.add(store.job(job.id).lease_until)
        return written.done() or len(leases) > 4

    with ThreadPoolExecutor(1) as pool:
        written = pool.submit(claim.report, progress(1))
        until(lambda: bool(claim.waits) or written.done())
        claim.lease = LEASE
        with Heartbeat(claim) as heartbeat:
            until(outlasts)
            assert not written.done()
            waiting = store.job(job.id)
            assert waiting.state == "running"
            assert waiting.reason.startswith("waits: the store needs free space on its disk")
            disk.empty()
            written.result(30.0)
            assert not heartbeat.lost
    assert claim.waited > 0.0
    goes_on = store.job(job.id)
    assert (goes_on.state, goes_on.reason, goes_on.fence, goes_on.attempts, goes_on.records) == (
        "running",
        "",
        1,
        0,
        1,
    )
    assert is_same_record(claim.evaluation_records()[0], large_record(1))


def test_a_job_stays_with_its_worker_while_not_even_its_lease_can_be_renewed(store: Store, address: str) -> None:
    with Store(address) as other:
        disk = Disk(store, other)
        job = add(store, most_attempts=1)
        claim = claim_waiting_job(store)
        claim.keep_record(large_record(1))
        end_lease(address, job.id)
        disk.fill(to_the_last_byte=True)
        with ThreadPoolExecutor(1) as pool:
            written = pool.submit(claim.report, progress(1))
            until(lambda: bool(claim.waits) or written.done())
            claim._renewed -= 2.0 * claim.lease
            with Heartbeat(claim) as heartbeat:
                with pytest.raises(Full, match="the store needs free space on its disk"):
                    other.claim("second")
                disk.empty()
                assert other.claim("second") is None, "its holder comes first"
                written.result(30.0)
                assert not heartbeat.lost
        goes_on = store.job(job.id)
        assert (goes_on.state, goes_on.worker, goes_on.fence, goes_on.records) == ("running", "first", 1, 1)


def test_another_worker_goes_on_with_a_job_whose_worker_died_on_a_full_disk(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slidercrank.service.store.database_clock.SETTLING", 0.2)
    disk = Disk(store)
    add(store)
    claim_waiting_job(store, lease=LEASE).keep_record(large_record(1))
    disk.fill(to_the_last_byte=True)
    until(store.has_waiting_jobs)
    with pytest.raises(Full):
        store.claim("second")
    disk.empty()
    until(lambda: store.claim("second", lease=60.0) is not None)
    assert (store.job(1).worker, store.job(1).fence) == ("second", 2)


def test_a_job_is_given_back_without_the_records_for_which_there_is_no_room(store: Store) -> None:
    disk = Disk(store)
    job = add(store)
    claim = claim_waiting_job(store, lease=LEASE)
    claim.keep_record(search_record(1))
    claim.report(progress(1))
    claim.keep_record(large_record(2))
    disk.fill()
    claim.hand_back("its worker stopped; another one continues")
    waiting = store.job(job.id)
    assert (waiting.state, waiting.records, waiting.attempts) == ("queued", 1, 0)
    assert [is_same_record(one, search_record(1)) for one in store.evaluation_records(job.id)] == [True]


def test_nothing_is_claimed_on_a_disk_without_room_though_the_claim_would_fit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store(tmp_path / "store.db") as store:
        assert store.claim("first") is None
        job = add(store)
        monkeypatch.setattr("slidercrank.service.store.database.free_bytes", lambda _: 100_000)
        for _ in range(5):
            with pytest.raises(Full):
                store.claim("first")
            store.last_full -= SETTLING
        assert store.job(job.id).attempts == 0


def test_claims_settle_after_a_full_disk_as_after_a_jump() -> None:
    here = 100.0
    jumps = ClockJumps(lambda: here)
    assert not jumps.is_steady(5000.0, last_full=here - 0.9 * SETTLING)
    assert jumps.is_steady(5000.0, last_full=here - SETTLING)


def test_time_without_room_does_not_count_as_time_of_the_search() -> None:
    waited = 20.0
    budget = Budget(Limits(seconds=60.0), waited=lambda: waited)
    budget._began -= 70.0
    assert not budget.is_spent()
    waited = 9.0
    assert budget.is_spent()


def test_a_search_that_waits_for_room_does_not_count_as_deaf(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[int] = []
    monkeypatch.setattr("slidercrank.service.workers.heartbeat._STOP_PATIENCE", 0.0)
    monkeypatch.setattr("slidercrank.service.workers.heartbeat.end_process_tree", left.append)
    job = add(store)
    claim = claim_waiting_job(store)
    heartbeat = Heartbeat(claim, budget=Budget(Limits(seconds=1e-9)), grace=10.0)
    claim.waits = "waits: the store needs free space on its disk"
    heartbeat._check_unresponsive_search()
    assert (store.job(job.id).state, left) == ("running", [])
    claim.waits = ""
    heartbeat._check_unresponsive_search()
    assert (store.job(job.id).state, left) == ("cancelled", [DEAF])
