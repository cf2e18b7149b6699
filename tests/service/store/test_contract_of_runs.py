"""Contract of every store on runs of the command line, names of run folders, limits and summaries."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest
from sqlalchemy import update

from slidercrank.model.errors import InputError, LeaseLost, NotFound, RunError
from slidercrank.service.store import Artefact, Claim, Limits, Store
from slidercrank.service.store.schema import jobs
from tests.service.store.contents import ROWS, TABLES, add, claim_waiting_job, progress, result, search_record

FILE = Artefact(name="job.toml", media_type="application/toml", content=b"name = 'Feeder'\n")


def claim_of_own_job(store: Store, run: str = "20260131-142501-feeder") -> Claim:
    """Return the claim of a job that its submitter solves itself."""
    return store.begin(TABLES, name="Feeder", run=run, worker="desk", lease=60.0, files=[FILE])


def test_a_job_begun_by_its_submitter_is_running_in_its_hands(store: Store) -> None:
    claim = claim_of_own_job(store)
    job = store.job(claim.job.id)
    assert (job.state, job.worker, job.attempts, job.most_attempts, job.fence) == ("running", "desk", 1, 1, 1)
    assert store.claim("other") is None
    assert store.artefact(job.id, "job.toml") == FILE
    claim.keep_record(search_record(1))
    claim.report(progress(1))
    claim.finish(result())
    assert store.job(job.id).state == "done"
    assert [event.kind for event in store.events(job.id)] == ["state", "state", "progress", "state"]


def test_the_name_of_a_run_belongs_to_one_job(store: Store) -> None:
    first, second, third = (claim_of_own_job(store).job.run for _ in range(3))
    assert (first, second, third) == (
        "20260131-142501-feeder",
        "20260131-142501-feeder-2",
        "20260131-142501-feeder-3",
    )
    found = store.find_by_run(second)
    assert found is not None
    assert found.run == second
    assert store.find_by_run("20260131") is None


def test_jobs_submitted_in_the_same_second_have_runs_of_their_own(store: Store) -> None:
    with ThreadPoolExecutor(8) as threads:
        runs = list(threads.map(lambda _: add(store, "Press feed").run, range(24)))
    assert len(set(runs)) == 24
    assert all("-press-feed" in run for run in runs)


def test_a_cancelled_job_can_be_taken_up_at_once(store: Store) -> None:
    first = claim_of_own_job(store)
    first.keep_record(search_record(1))
    first.finish(result("cancelled"))
    again = store.reclaim(first.job.id, worker="desk", lease=60.0)
    assert len(again.evaluation_records()) == 1
    assert (again.job.state, again.job.fence) == ("running", 2)
    again.finish(result())
    with pytest.raises(LeaseLost):
        first.add_message("stale")
    with pytest.raises(InputError, match="only a cancelled or failed job can continue; job 1 is done"):
        store.reclaim(first.job.id, worker="desk", lease=60.0)


def test_a_running_job_is_taken_from_its_worker_only_where_that_is_known_to_be_gone(store: Store) -> None:
    lost = claim_of_own_job(store)
    lost.keep_record(search_record(1))
    lost.report(progress(1))
    with pytest.raises(InputError, match="job 1 is running"):
        store.reclaim(lost.job.id, worker="second", lease=60.0)
    again = store.reclaim(lost.job.id, worker="second", lease=60.0, alone=True)
    assert len(again.evaluation_records()) == 1
    with pytest.raises(LeaseLost):
        lost.report(progress(2))


def test_no_more_jobs_are_claimed_than_may_run(store: Store) -> None:
    for _ in range(3):
        add(store)
    first = store.claim("first", most_running=1)
    assert first is not None
    assert store.claim("second", most_running=1) is None
    assert store.claim("second", most_running=2) is not None
    first.finish(result())
    assert store.claim("first", most_running=2) is not None


def test_limits_are_kept(store: Store) -> None:
    limits = Limits(seconds=2.5, evaluations=10**12, memory=2**40)
    assert add(store, limits=limits).limits == limits
    assert claim_waiting_job(store).job.limits == limits
    assert add(store).limits == Limits()


@pytest.mark.parametrize("limit", [0, -1, math.nan, math.inf, 2**60])
@pytest.mark.parametrize("name", ["seconds", "evaluations", "memory"])
def test_a_limit_that_is_none_is_refused(name: str, limit: float) -> None:
    with pytest.raises(InputError, match=f"a limit on {name} must be a positive number"):
        Limits(**{name: limit})  # type: ignore[arg-type]


def test_a_list_shows_what_a_job_found(store: Store) -> None:
    add(store)
    claim_waiting_job(store).finish(replace(result(), extremes={"time_ratio": 0}))
    assert store.jobs()[0].summary == {
        "designs": 2,
        "hypervolume": 0.5,
        "evaluations": 400,
        "seconds": 0.1,
        "best": {"time_ratio": 1.25},
        "axes": ["time_ratio"],
        "points": [[1.25], [1.0]],
    }


def test_a_summary_has_few_points_with_the_first_and_the_last(store: Store) -> None:
    rows = [{**ROWS[0], "time_ratio": float(number)} for number in range(1000)]
    add(store)
    claim_waiting_job(store).finish(result(rows=rows))
    summary = store.jobs()[0].summary
    assert summary is not None
    points = [point[0] for point in summary["points"]]
    assert len(points) == 64
    assert (points[0], points[-1]) == (0.0, 999.0)
    assert points == sorted(set(points))


def test_the_record_of_a_result_has_columns_in_place_of_designs(store: Store) -> None:
    add(store)
    claim = claim_waiting_job(store)
    with pytest.raises(RunError, match="job 1 has no result: it is running"):
        store.result_record(1)
    claim.finish(result())
    record = store.result_record(1)
    assert record["columns"] == list(ROWS[0])
    assert record["count"] == len(ROWS)
    assert "designs" not in record
    with store.writing() as connection:
        connection.execute(update(jobs).values(summary=None, checksum=None))  # as the first stores left it
    assert store.result_record(1) == record
    assert record["message"] == "2 designs"
    with pytest.raises(NotFound, match="there is no job 2"):
        store.result_record(2)
