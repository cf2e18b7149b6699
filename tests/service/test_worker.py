"""Workers: what they do with the jobs of a store, and with what goes wrong. All searches are made up."""

from __future__ import annotations

import math
import threading
import time
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from slidercrank.model.errors import ForeignRecords, InputError, JobError, StoreError
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.problem import Problem
from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Claim, Store
from slidercrank.service.workers.heartbeat import Heartbeat
from slidercrank.service.workers.worker import solve_claimed, work, worker_name
from tests.service import fronts
from tests.service.made_up_search import Search, made_up_front, search, until
from tests.service.store.contents import end_lease, progress, search_record
from tests.service.store.contents import progress as at_round

TABLES = tomllib.loads(fronts.JOB)


@pytest.fixture
def address(tmp_path: Path) -> Path:
    """Return where the store of a test is."""
    return tmp_path / "store.db"


@pytest.fixture
def store(address: Path) -> Iterator[Store]:
    """Return an empty store."""
    with Store(address) as opened:
        yield opened


@pytest.fixture
def searches(monkeypatch: pytest.MonkeyPatch) -> Callable[[Search], None]:
    """Return a function that puts another search in the place of `solve`."""
    return lambda search: monkeypatch.setattr("slidercrank.optimise.solve.solve", search)


def rounds(store: Store, job: int) -> list[int]:
    """Return the rounds that were told of a job."""
    told = [event.data for event in store.events(job) if event.kind == "progress"]
    return [data["round"] for data in told if not data["steps"]]


def test_a_worker_solves_what_waits_and_writes_what_it_found(store: Store, searches: Any) -> None:
    searches(search)
    jobs = [submit(store, TABLES), submit(store, TABLES, priority=1)]
    assert work(store, name="first", drain=True) == 2
    for job in jobs:
        assert (store.job(job.id).state, store.job(job.id).reason) == ("done", "1 design")
        assert store.result(job.id).designs[0]["crank_mm"] == 140.0
        assert store.result(job.id).knee == 0
        assert store.artefact(job.id, "versions.json").content == b'{\n  "slidercrank": "0"\n}\n'
        kinds = [event.data.get("state") or event.data["stage"] for event in store.events(job.id)]
        assert kinds == ["queued", "running", "loading", "loading", "evolving", "evolving", "evolving", "done"]
    assert store.workers() == []


def test_a_job_that_is_not_valid_is_refused_before_it_is_queued(store: Store) -> None:
    with pytest.raises(JobError, match="objectives"):
        submit(store, {**TABLES, "objectives": {}})
    with pytest.raises(JobError, match="number"):
        submit(store, {**TABLES, "mechanism": {"speed": math.nan}})
    own = {"quantity": {"mine": {"function": "os:getcwd", "unit": "mm"}}}
    with pytest.raises(JobError, match="quantity"):
        submit(store, {**TABLES, **own})
    assert store.jobs() == []


def test_wrong_input_is_not_tried_again(store: Store, searches: Any) -> None:
    def refuse(*_: Any, **_more: Any) -> ParetoFront:
        raise InputError("the method shgo takes one objective")

    searches(refuse)
    job = submit(store, TABLES)
    assert work(store, drain=True) == 1
    assert (store.job(job.id).state, store.job(job.id).reason) == ("failed", "the method shgo takes one objective")


def test_an_error_is_tried_again_from_where_the_job_was(
    store: Store, searches: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slidercrank.service.workers.worker._DELAY", 0.0)
    resumed: list[int] = []

    def stumble(problem: Problem, *, resume: Any, progress: Any, **more: Any) -> ParetoFront:
        resumed.append(len(resume))

        def tell(at: Any) -> None:
            progress(at)
            if at.round == 2:
                raise MemoryError

        return search(problem, resume=resume, progress=tell, **more)

    searches(stumble)
    job = submit(store, TABLES, most_attempts=1)
    assert work(store, drain=True) == 2
    assert resumed == [0, 2]
    assert store.job(job.id).state == "done"
    reasons = [event.data["reason"] for event in store.events(job.id) if event.data.get("state") == "queued"]
    assert reasons == ["", "MemoryError"]
    assert b"raise MemoryError" in store.artefact(job.id, "error.txt").content


def test_an_error_that_stays_sets_the_job_aside(store: Store, searches: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slidercrank.service.workers.worker._DELAY", 0.0)

    def fall(*_: Any, **_more: Any) -> ParetoFront:
        raise RuntimeError("no way")

    searches(fall)
    job = submit(store, TABLES)
    assert work(store, drain=True) == 3
    assert (store.job(job.id).state, store.job(job.id).reason) == ("failed", "RuntimeError: no way (attempt 3 of 3)")


def test_a_job_that_goes_on_tells_at_once_that_it_loads_beside_what_it_had(store: Store, searches: Any) -> None:
    job = submit(store, TABLES)
    first = store.claim("first")
    assert first is not None
    first.keep_record(search_record(0))
    first.report(at_round(1), {"columns": ["time_ratio"], "points": [[1.5]]})
    first.hand_back("")
    shown: list[Any] = []

    def loaded(problem: Problem, **more: Any) -> ParetoFront:
        shown.append(store.job(job.id).progress)
        return search(problem, **more)

    searches(loaded)
    work(store, drain=True)
    (standing,) = shown
    assert (standing["stage"], standing["round"], standing["evaluations"]) == ("loading", 1, at_round(1).evaluations)
    assert 0 < standing["step"] < standing["steps"]
    assert standing["front"]["points"] == [[1.5]]
    events = store.events(job.id)
    again = max(index for index, event in enumerate(events) if event.data.get("state") == "running")
    assert (events[again + 1].data["stage"], events[again + 1].data["step"]) == ("loading", 0)


def test_a_job_with_records_of_another_release_begins_anew(
    store: Store, searches: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slidercrank.service.workers.worker._DELAY", 0.0)

    def first(_: Problem, *, keep: Any, progress: Any, **_more: Any) -> ParetoFront:
        keep(search_record(0))
        progress(at_round(1))
        raise MemoryError

    def second(problem: Problem, *, resume: Any, **more: Any) -> ParetoFront:
        if resume:
            raise ForeignRecords(
                "a run can only continue with its original versions; it has it began with; run its job anew"
            )
        return search(problem, resume=resume, **more)

    searches(first)
    job = submit(store, TABLES, most_attempts=2)
    claim = store.claim("first")
    assert claim is not None
    solve_claimed(store, claim, lambda: False)
    assert store.job(job.id).records == 1
    searches(second)
    work(store, drain=True)
    assert store.job(job.id).state == "done"
    told = [event.data["text"] for event in store.events(job.id) if event.kind == "message"]
    assert any(
        text.startswith("starts again: a run can only continue with its original versions; it has") for text in told
    )
    assert rounds(store, job.id) == [1, 1, 2, 3]


def test_a_stopped_worker_hands_its_job_back(store: Store, searches: Any) -> None:
    searches(search)
    job = submit(store, TABLES, most_attempts=1)
    asked: list[bool] = []

    def stop() -> bool:
        asked.append(True)
        return len(asked) > 3  # once before the job, then before each of its rounds

    assert work(store, stop=stop) == 1
    waiting = store.job(job.id)
    assert (waiting.state, waiting.reason, waiting.records, waiting.attempts) == (
        *("queued", "its worker stopped; another one continues", 2),
        0,
    )
    assert work(store, drain=True) == 1
    assert store.job(job.id).state == "done"


def test_an_interrupted_worker_hands_its_job_back(store: Store, searches: Any) -> None:
    def interrupt(*_: Any, keep: Any, **_more: Any) -> ParetoFront:
        keep(search_record(0))
        raise KeyboardInterrupt

    searches(interrupt)
    job = submit(store, TABLES)
    with pytest.raises(KeyboardInterrupt):
        work(store, drain=True)
    assert (store.job(job.id).state, store.job(job.id).records) == ("queued", 1)


def test_a_cancelled_job_keeps_what_was_found(store: Store, searches: Any) -> None:
    job = submit(store, TABLES)

    def long(problem: Problem, *, cancelled: Any, keep: Any, **_: Any) -> ParetoFront:
        keep(search_record(0))
        store.cancel(job.id)
        until(cancelled)
        return made_up_front(problem, "cancelled")

    searches(long)
    assert work(store, lease=1.0, drain=True) == 1
    ended = store.job(job.id)
    assert (ended.state, ended.reason, ended.records) == ("cancelled", "1 design", 1)
    assert len(store.result(job.id).designs) == 1


def test_a_job_is_cancelled_soon_though_its_search_still_loads(store: Store, searches: Any) -> None:
    job = submit(store, TABLES)
    heard: list[float] = []

    def loading(*_: Any, cancelled: Any, **_more: Any) -> ParetoFront:
        store.cancel(job.id)
        begin = time.monotonic()
        until(lambda: store.job(job.id).state == "cancelled")
        heard.append(time.monotonic() - begin)
        cancelled()
        raise AssertionError("a search goes on that was cancelled")

    searches(loading)
    assert work(store, drain=True) == 1
    assert 1.0 <= heard[0] < 2.0
    ended = store.job(job.id)
    assert (ended.reason, ended.worker, ended.summary) == ("cancelled before it was done", None, None)
    store.resume(job.id)
    searches(search)
    assert work(store, drain=True) == 1
    assert store.job(job.id).state == "done"


def test_a_lease_is_renewed_while_a_round_takes_longer_than_it(store: Store) -> None:
    submit(store, TABLES)
    claim = store.claim("first", lease=1.0)
    assert claim is not None
    with Heartbeat(claim) as heartbeat:
        first = until_after = store.job(claim.job.id).lease_until
        assert first is not None

        def renewed() -> bool:
            nonlocal until_after
            until_after = store.job(claim.job.id).lease_until
            return until_after is not None and until_after > first + 1.5

        until(renewed)
        assert not heartbeat.lost
    claim.report(progress(1))


def test_a_worker_that_wakes_after_its_lease_leaves_the_job_to_the_next(
    store: Store, address: Path, searches: Any
) -> None:
    job = submit(store, TABLES)
    second: list[Claim] = []

    def paused(problem: Problem, *, cancelled: Any, keep: Any, progress: Any, **more: Any) -> ParetoFront:
        def tell(at: Any) -> None:
            if at.round == 2:
                end_lease(str(address), job.id)
                claim = store.claim("second", lease=60.0)
                assert claim is not None
                second.append(claim)
            progress(at)

        return search(problem, cancelled=cancelled, keep=keep, progress=tell, **more)

    searches(paused)
    assert work(store, name="first", drain=True) == 1
    assert (store.job(job.id).worker, store.job(job.id).records) == ("second", 1)
    searches(search)
    solve_claimed(store, second[0], lambda: False)
    assert store.job(job.id).state == "done"
    assert rounds(store, job.id) == [1, 2, 3]


def test_a_paused_search_learns_between_its_writes_that_its_lease_was_lost(
    store: Store, address: Path, searches: Any
) -> None:
    job = submit(store, TABLES)

    def paused(*_: Any, cancelled: Any, **_more: Any) -> ParetoFront:
        end_lease(str(address), job.id)
        assert store.claim("second", lease=60.0) is not None
        until(cancelled)
        raise AssertionError("a search of which the lease is lost has nothing to find")

    searches(paused)
    claim = store.claim("first", lease=1.0)
    assert claim is not None
    solve_claimed(store, claim, lambda: False)
    assert (store.job(job.id).state, store.job(job.id).worker) == ("running", "second")


def test_a_worker_waits_for_a_database_that_is_away_and_tells_it_once(
    store: Store, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("slidercrank.service.workers.worker._AWAY", 0.0)
    asked: list[bool] = []

    def away(*_: Any, **_more: Any) -> None:
        asked.append(True)
        raise StoreError("the server restarts")

    monkeypatch.setattr(store, "claim", away)
    assert work(store, stop=lambda: len(asked) >= 3) == 0
    assert caplog.messages == ["the server restarts; trying again until it is available"]
    with pytest.raises(StoreError, match="the server restarts"):
        work(store, drain=True)


def test_names_of_workers_differ() -> None:
    assert worker_name() != worker_name()
    assert threading.active_count() < 50  # the pulses of ended jobs are gone
