"""Contract of claims in every store, whatever its database: their rights, and the job at its end."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

from slidercrank.model.errors import InputError, LeaseLost, RunError
from slidercrank.optimise.front.progress import REPEATING
from slidercrank.service.runs.result import csv_text
from slidercrank.service.store import Artefact, Claim, Store
from tests.service.store.contents import (
    ROWS,
    add,
    all_rows,
    claim_waiting_job,
    end_lease,
    is_same_record,
    progress,
    result,
    search_record,
)


def test_a_job_whose_lease_has_ended_goes_on_from_its_records(store: Store, address: str) -> None:
    add(store)
    lost = claim_waiting_job(store)
    for number in (1, 2):
        lost.keep_record(search_record(number))
        lost.report(progress(number))
    lost.keep_record(search_record(3))  # never written: its round was not told
    assert store.claim("second") is None
    end_lease(address, lost.job.id)
    again = claim_waiting_job(store, "second")
    assert (again.job.id, again.job.fence, again.job.worker) == (lost.job.id, 2, "second")
    found = again.evaluation_records()
    assert len(found) == again.job.records == 2
    assert all(is_same_record(one, search_record(number)) for number, one in enumerate(found, 1))
    assert again.job.progress is not None
    assert again.job.progress["evaluations"] == 32
    again.keep_record(search_record(3))
    again.report(progress(3))
    assert is_same_record(again.evaluation_records()[2], search_record(3))


def test_repeating_earlier_rounds_is_told_and_is_not_to_have_begun(store: Store) -> None:
    add(store)
    claim = claim_waiting_job(store)
    claim.report(replace(progress(0), stage=REPEATING, step=4, steps=12))
    assert not claim.has_started, "so that a job that is cancelled meanwhile ends at once"
    event = store.events(claim.job.id)[-1]
    assert (event.data["stage"], event.data["step"], event.data["steps"]) == (REPEATING, 4, 12)
    claim.report(progress(1))
    assert claim.has_started


WRITES: dict[str, Callable[[Claim], None]] = {
    "report": lambda claim: claim.report(progress(2)),
    "renew": lambda claim: claim.renew(),
    "say": lambda claim: claim.add_message("still here"),
    "write_files": lambda claim: claim.write_files(Artefact(name="a", media_type="text/plain", content=b"stale")),
    "finish": lambda claim: claim.finish(result()),
    "fail": lambda claim: claim.fail("stale", again=True),
    "hand_back": lambda claim: claim.hand_back("stale"),
}


@pytest.mark.parametrize("write", WRITES)
@pytest.mark.parametrize("claimed_again", [False, True])
def test_a_worker_that_wakes_after_its_lease_writes_nothing(
    write: str, claimed_again: bool, store: Store, address: str
) -> None:
    add(store)
    paused = claim_waiting_job(store)
    paused.keep_record(search_record(1))
    paused.report(progress(1))
    paused.keep_record(search_record(2))
    end_lease(address, paused.job.id)
    paused._renewed -= paused.lease + 1.0  # as its own clock tells it
    if claimed_again:
        second = claim_waiting_job(store, "second")
        second.renew()  # it has now written as often as the first: only the fence tells them apart
    before = all_rows(address)
    with pytest.raises(LeaseLost, match="claim 1 of job 1 has lost it"):
        WRITES[write](paused)
    assert all_rows(address) == before


def test_every_write_renews_the_lease(store: Store) -> None:
    job = add(store)
    claim = claim_waiting_job(store, lease=60.0)
    for write in ("report", "renew", "say", "write_files"):
        claim.lease += 600.0
        before = store.job(job.id).lease_until
        WRITES[write](claim)
        after = store.job(job.id).lease_until
        assert before is not None
        assert after is not None
        assert after > before + 300.0
    assert claim.seconds_since_renewal < 60.0


def test_progress_is_written_with_its_record_or_not_at_all(store: Store, address: str) -> None:
    job = add(store)
    claim = claim_waiting_job(store)
    claim.keep_record(search_record(1))
    claim.report(progress(1))
    before = all_rows(address)
    claim.keep_record(search_record(2))
    claim._records = 0  # the next record takes the number of the first, which the database refuses
    claim.lease = 0.0  # at once, not after many tries
    with pytest.raises(RunError, match="the store must be a database that can be"):
        claim.report(progress(2))
    assert all_rows(address) == before
    assert [event.data["round"] for event in store.events(job.id) if event.kind == "progress"] == [1]


@pytest.mark.parametrize("status", ["done", "cancelled", "infeasible"])
def test_what_was_found_is_read_as_it_was_written(status: str, store: Store) -> None:
    job = add(store)
    with pytest.raises(RunError, match="has no result: it is queued"):
        store.result(job.id)
    claim = claim_waiting_job(store)
    claim.keep_record(search_record(1))
    found = result(status, [] if status == "infeasible" else None)
    claim.finish(found, [Artefact(name="versions.json", media_type="application/json", content=b"{}\0")])
    read = store.result(job.id)
    assert csv_text(read.designs) == csv_text(found.designs)
    assert read.record() == found.record()
    ended = store.job(job.id)
    assert (ended.state, ended.reason, ended.worker, ended.lease_until) == (status, found.message, None, None)
    assert ended.finished is not None
    assert ended.records == (1 if status == "cancelled" else 0)
    assert store.artefact_names(job.id) == ["versions.json"]
    assert store.artefact(job.id, "versions.json").content == b"{}\0"
    assert store.claim("second") is None
    with pytest.raises(LeaseLost):
        claim.finish(found)


def test_an_error_is_tried_again_later_and_in_the_end_set_aside(store: Store) -> None:
    job = add(store, most_attempts=2)
    claim_waiting_job(store).fail("the disk was full", again=True, delay=60.0)
    waiting = store.job(job.id)
    assert (waiting.state, waiting.reason) == ("queued", "the disk was full (attempt 1 of 2)")
    assert waiting.due - waiting.submitted >= 60.0
    assert store.claim("second") is None
    store.cancel(job.id)
    store.resume(job.id)  # due at once, with all its attempts
    for number in (1, 2):
        claim = claim_waiting_job(store)
        assert claim.job.attempts == number
        claim.fail("the disk was full", again=True)
    failed = store.job(job.id)
    assert (failed.state, failed.reason) == ("failed", "the disk was full (attempt 2 of 2)")
    assert store.claim("second") is None


def test_any_text_is_taken(store: Store) -> None:
    job = add(store, "nul \0 and surrogate \ud800")
    assert job.name == "nul ? and surrogate ?"
    assert store.jobs(name="\0") == store.jobs(name="?") == [job]
    claim = claim_waiting_job(store)
    claim.add_message("\0\ud800")
    claim.fail("\0\ud800" + "x" * 10_000, again=False)
    failed = store.job(job.id)
    assert failed.reason.startswith("??xxx")
    assert len(failed.reason) == 4000
    for number in (0, -1, 2**63, 10**30):
        with pytest.raises(InputError, match=f"there is no job {number}"):
            store.job(number)


def test_what_cannot_succeed_is_not_tried_again(store: Store) -> None:
    job = add(store)
    claim_waiting_job(store).fail("the stroke must be positive", again=False)
    assert (store.job(job.id).state, store.job(job.id).reason) == ("failed", "the stroke must be positive")


def test_a_job_that_stops_its_workers_is_set_aside_and_the_next_one_claimed(store: Store, address: str) -> None:
    poison, good = add(store, most_attempts=2), add(store)
    for worker in ("first", "second"):
        assert claim_waiting_job(store, worker).job.id == poison.id
        end_lease(address, poison.id)
    assert claim_waiting_job(store, "third").job.id == good.id
    aside = store.job(poison.id)
    assert aside.state == "failed"
    assert "its worker stopped without a report 2 times in a row, the last one was second" in aside.reason
    assert store.resume(poison.id).attempts == 0
    assert claim_waiting_job(store).job.id == poison.id


def test_a_job_that_goes_forward_is_not_set_aside(store: Store, address: str) -> None:
    job = add(store, most_attempts=2)
    for number in range(5):
        claim = claim_waiting_job(store)
        claim.keep_record(search_record(number))
        claim.report(progress(number))
        end_lease(address, job.id)
    assert store.job(job.id).records == 5


def test_a_job_handed_back_goes_on_without_counting_the_attempt(store: Store) -> None:
    job = add(store, most_attempts=1)
    for _ in range(3):
        claim = claim_waiting_job(store)
        assert claim.job.attempts == 1
        claim.hand_back("the machine goes down")
    assert (store.job(job.id).state, store.job(job.id).reason) == (
        "queued",
        "the machine goes down",
    )
    claim = claim_waiting_job(store)
    claim.keep_record(search_record(1))
    claim.hand_back("the machine goes down")
    assert is_same_record(claim_waiting_job(store).evaluation_records()[0], search_record(1))


def test_a_job_whose_worker_is_gone_is_cancelled_at_once_and_can_go_on(store: Store, address: str) -> None:
    job = add(store)
    gone = claim_waiting_job(store)
    gone.keep_record(search_record(1))
    gone.report(progress(1))
    end_lease(address, job.id)
    cancelled = store.cancel(job.id)
    assert (cancelled.state, cancelled.worker, cancelled.records) == ("cancelled", None, 1)
    with pytest.raises(LeaseLost):
        gone.report(progress(2))
    store.resume(job.id)
    assert is_same_record(claim_waiting_job(store, "second").evaluation_records()[0], search_record(1))


@pytest.mark.parametrize("hears", ["look", "renew", "report"])
def test_the_worker_of_a_cancelled_job_hears_of_it_and_the_job_can_go_on(hears: str, store: Store) -> None:
    job = add(store)
    claim = claim_waiting_job(store)
    claim.keep_record(search_record(1))
    claim.report(progress(1))
    assert not claim.cancel_asked
    assert store.cancel(job.id).cancel_asked
    assert store.cancel(job.id).state == "running"
    claim.refresh_cancellation() if hears == "look" else WRITES[hears](claim)
    assert claim.cancel_asked
    claim.finish(result("cancelled"))
    assert (store.job(job.id).state, len(store.result(job.id).designs)) == ("cancelled", len(ROWS))
    assert not store.resume(job.id).cancel_asked
    again = claim_waiting_job(store, "second")
    assert is_same_record(again.evaluation_records()[0], search_record(1))
    again.finish(result("done", ROWS[:1]))
    assert len(store.result(job.id).designs) == 1
    with pytest.raises(InputError, match="only a cancelled or failed job can continue; job 1 is done"):
        store.resume(job.id)
    assert store.cancel(job.id).state == "done"


def test_events_have_no_gaps_whoever_writes_them(store: Store) -> None:
    job = add(store)
    claim = claim_waiting_job(store)

    def tell(number: int) -> None:
        claim.add_message(f"message {number}")
        store.cancel(job.id)

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(tell, range(8)))
    events = store.events(job.id)
    assert [event.number for event in events] == list(range(1, 12))
    texts = [event.data["text"] for event in events if event.kind == "message"]
    assert sorted(texts) == ["asked to stop", *(f"message {number}" for number in range(8))]
    assert [event.number for event in store.events(job.id, after=4, limit=3)] == [5, 6, 7]
    assert store.events(job.id, after=11) == []


def test_a_file_replaces_the_one_of_its_name(store: Store) -> None:
    job = add(store)
    claim = claim_waiting_job(store)
    for content in (b"old", b"new"):
        claim.write_files(Artefact(name="front.csv", media_type="text/csv", content=content))
    assert store.artefact(job.id, "front.csv") == Artefact(name="front.csv", media_type="text/csv", content=b"new")
    with pytest.raises(InputError, match="job 1 has no file"):
        store.artefact(job.id, "back.csv")
