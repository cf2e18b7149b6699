"""The list of jobs is light: short rows, and points of fronts apart from them, for those who show them."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import httpx
import numpy as np
import pytest

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.service.jobs.submission import submit
from slidercrank.service.runs.result import Row, StoredObjective
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service.api.serving import refusal_sentence
from tests.service.store.contents import ROWS, add, claim_waiting_job, progress, result

ROW = 600  # bytes at most
AXES = ("time_ratio", "peak_torque_Nm", "least_transmission_angle_deg", "position_error_mm")


def sizes(client: httpx.Client) -> list[int]:
    """Return the bytes of the rows of the list as they are sent, latest first."""
    answer = client.get("/jobs")
    rows = [json.dumps(row, separators=(",", ":"), ensure_ascii=False).encode() for row in answer.json()["jobs"]]
    besides = 24 + len('"workers":"",') + len(answer.json()["workers"])
    assert sum(map(len, rows)) + len(rows) + besides >= len(answer.content)  # no blanks are sent besides
    return list(map(len, rows))


def front_progress(count: int = 64) -> dict[str, Any]:
    """Return points of a front in four objectives, with all digits."""
    points = np.random.default_rng(3).random((count, len(AXES))).tolist()
    return {"columns": list(AXES), "points": points}


def points(client: httpx.Client, *numbers: int) -> dict[int, list[list[float]]]:
    """Return the points of the fronts of jobs."""
    fronts = client.get("/front-points", params={"job": numbers}).json()["fronts"]
    return {front["job"]: front["points"] for front in fronts}


@pytest.mark.slow
def test_rows_of_the_shipped_jobs_have_600_bytes_at_most(client: httpx.Client, store: Store) -> None:
    quick = {"method": "sobol", "evaluations": 3000, "designs": 100, "seed": 1}
    for preset in client.get("/presets").json()["presets"]:
        submit(store, {**preset["job"], "optimiser": quick})
    work(store, drain=True)
    jobs = store.jobs()
    assert len(jobs) == len(client.get("/presets").json()["presets"]) >= 5
    for job in jobs:
        assert job.summary is not None
        if len(job.summary["best"]) > 2:  # of two objectives fewer designs are as good
            assert job.summary["designs"] == 100
            assert len(json.dumps(job.record())) > 3000  # what a row had
    assert max(sizes(client)) <= ROW


def test_rows_of_random_jobs_have_600_bytes_at_most_whatever_they_are_doing(client: httpx.Client, store: Store) -> None:
    random = np.random.default_rng(5)
    for _ in range(40):
        names = random.choice(sorted(QUANTITIES), size=4, replace=False)
        wanted = tuple(
            StoredObjective(quantity=name, sense="minimise", column=QUANTITIES[name].field, title=name, unit="")
            for name in names
        )
        values = random.choice([-1.0, 1.0], (100, 4)) * 10.0 ** random.uniform(-9, 9, (100, 4))
        rows: list[Row] = [{one.column: float(cell) for one, cell in zip(wanted, row, strict=True)} for row in values]
        extremes = {name: int(random.integers(100)) for name in names}
        add(store, "Machine " + "x" * int(random.integers(24)))
        claim = claim_waiting_job(store, worker="machine-28238-788875")
        claim.report(progress(9), front_progress())
        if random.random() < 0.8:
            state = str(random.choice(["done", "cancelled"]))
            claim.finish(replace(result(state, rows), objectives=wanted, extremes=extremes, evaluations=1_000_000))
            if state == "cancelled" and random.random() < 0.5:  # goes on, with what it has found
                store.resume(claim.job.id)
                claim_waiting_job(store, worker="machine-28238-788875").report(progress(9), front_progress())
    assert min(store.count_by_state()[state] for state in ("running", "done", "cancelled")) > 3
    assert sum(job.summary is not None for job in store.jobs(states=["running"])) > 3
    assert max(sizes(client)) <= ROW


def test_a_row_is_part_of_the_job(client: httpx.Client, store: Store) -> None:
    add(store)
    claim = claim_waiting_job(store)
    claim.report(progress(3), front_progress())

    def row() -> dict[str, Any]:
        found: dict[str, Any] = client.get("/jobs").json()["jobs"][0]
        job = client.get("/jobs/1").json()
        for key in ("progress", "summary"):
            job[key] = job[key] and found[key] and {name: job[key][name] for name in found[key]}
        assert found == {key: job[key] for key in found}
        return found

    assert row()["progress"] == {"stage": "evolving", "round": 3, "rounds": 9, "feasible": 3, "step": 0, "steps": 0}
    claim.finish(replace(result(), extremes={"time_ratio": 0}))
    assert row()["progress"] is None
    assert row()["summary"] == {"designs": 2, "best": {"time_ratio": 1.25}, "seconds": 0.1}
    job = client.get("/jobs/1").json()
    assert (job["summary"]["points"], job["progress"]["front"]) == ([[1.25], [1.0]], front_progress())


def test_points_are_of_the_front_found_or_of_that_so_far(client: httpx.Client, store: Store) -> None:
    """Jobs 1 to 8: done, queued, running with and without a round, failed, infeasible, one design, deleted."""
    for _ in range(8):
        add(store)
    done, failed, infeasible, one, gone, running, fresh = (claim_waiting_job(store) for _ in range(7))
    so_far = front_progress(5)
    told = [point[:2] for point in so_far["points"]]
    for claim in (done, failed, running):
        claim.report(progress(2), so_far)
    done.finish(result())
    failed.fail("its worker was killed", again=False)
    infeasible.finish(result("infeasible", rows=[]))
    one.finish(result(rows=ROWS[:1]))
    gone.finish(result())
    store.delete(gone.job.id)
    assert points(client, *range(1, 12)) == {
        done.job.id: [[1.25], [1.0]],
        failed.job.id: told,
        infeasible.job.id: [],
        one.job.id: [[1.25]],
        running.job.id: told,
        fresh.job.id: [],
        8: [],
    }
    (front,) = client.get("/front-points?job=6").json()["fronts"]
    assert front == {"job": running.job.id, "columns": list(AXES[:2]), "points": told}
    assert points(client, gone.job.id, 2**53 - 1) == {}
    assert points(client, 8, 1, 8) == {1: [[1.25], [1.0]], 8: []}


def test_an_undefined_value_of_a_point_is_null(client: httpx.Client, store: Store) -> None:
    add(store)
    error = StoredObjective(
        quantity="motion_error", sense="minimise", column="motion_error_mm", title="Error", unit="mm"
    )
    claim_waiting_job(store).finish(replace(result(), objectives=(*result().objectives, error), extremes={}))
    assert points(client, 1) == {1: [[1.25, None], [1.0, None]]}


def test_a_browser_keeps_points_until_a_front_changes(client: httpx.Client, store: Store) -> None:
    for _ in range(2):
        add(store)
    claim = claim_waiting_job(store)
    path = "/front-points?job=1&job=2"

    def again(tag: str) -> tuple[int, str]:
        answer = client.get(path, headers={"If-None-Match": tag})
        assert answer.headers["cache-control"] == "private, no-cache"
        assert (answer.content == b"") == (answer.status_code == 304)
        return answer.status_code, answer.headers["etag"]

    tag = client.get(path).headers["etag"]
    assert again(tag) == (304, tag)
    for number in (1, 2):
        claim.report(progress(number), front_progress(4 * number))
        status, changed = again(tag)
        assert (status, again(changed)) == (200, (304, changed))
        assert changed != tag
        tag = changed
    claim.add_message("a message changes no front")
    assert again(tag) == (304, tag)
    claim.finish(result())
    status, tag = again(tag)
    assert (status, again(tag)) == (200, (304, tag))
    store.delete(1)
    assert again(tag)[0] == 200


@pytest.mark.parametrize("query", ["", "job=0", "job=-1", "job=1.0", "job=one", f"job={2**53}", "job=1&job="])
def test_numbers_that_no_job_has_are_refused(shared: httpx.Client, query: str) -> None:
    assert "query job" in refusal_sentence(shared.get(f"/front-points?{query}"), 422)


def test_points_of_a_hundred_jobs_are_asked_for_at_most(shared: httpx.Client) -> None:
    assert points(shared, *range(1, 101)) == {1: []}
    assert "query job" in refusal_sentence(shared.get("/front-points", params={"job": range(1, 102)}), 422)
