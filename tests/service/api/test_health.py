"""Answers to the operators of a service: health, readiness and figures."""

from __future__ import annotations

from types import SimpleNamespace

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from slidercrank.service.store import Store
from tests.service.store.contents import add, claim_waiting_job


def figures(client: httpx.Client) -> dict[tuple[str, tuple[str, ...]], float]:
    """Return the value of every figure by its name and labels."""
    response = client.get("/metrics")
    assert response.status_code == 200
    assert response.headers["content-type"].startswith("text/plain; version=")
    families = text_string_to_metric_families(response.text)
    return {(one.name, tuple(one.labels.values())): one.value for family in families for one in family.samples}


def test_the_service_tells_whether_it_can_work(client: httpx.Client, store: Store) -> None:
    assert client.get("/health/live").json() == {"status": "live"}
    idle = {"status": "ready", "takes_jobs": False, "workers": 0, "busy": 0, "waiting": 0}
    assert client.get("/health/ready").json() == idle
    store.register("one")
    add(store)
    ready = {"status": "ready", "takes_jobs": True, "workers": 1, "busy": 0, "waiting": 1}
    assert client.get("/health/ready").json() == ready


def test_no_worker_a_free_one_and_busy_ones_are_told_apart(client: httpx.Client, store: Store) -> None:
    def told() -> tuple[int, int, int, str]:
        ready, row = client.get("/health/ready").json(), client.get("/jobs").json()["jobs"][0]
        assert client.get("/jobs/3").json()["reason"] == row["reason"]
        return ready["workers"], ready["busy"], ready["waiting"], row["reason"]

    for _ in range(3):
        add(store)
    assert told() == (0, 0, 3, "no worker is running")
    store.register("one")
    assert told() == (1, 0, 3, "")
    claim_waiting_job(store, "one")
    assert told() == (1, 1, 2, "every worker is busy (1)")
    store.register("two")
    assert told() == (2, 1, 2, "")
    held = claim_waiting_job(store, "two")
    assert told() == (2, 2, 1, "every worker is busy (2)")
    held.hand_back("stopped")
    assert client.get("/jobs/2").json()["reason"] == "stopped"


def test_a_disk_without_room_keeps_the_service_from_being_ready_and_is_the_reason_of_jobs_that_wait(
    client: httpx.Client, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    add(store)
    monkeypatch.setattr("slidercrank.service.resources.disk.shutil.disk_usage", lambda _: SimpleNamespace(free=4096))
    refused = client.get("/health/ready")
    assert refused.status_code == 503
    reason = client.get("/jobs/1").json()["reason"]
    for said in (refused.json()["detail"], reason, client.get("/jobs").json()["jobs"][0]["reason"]):
        assert "the store needs free space on its disk" in said
        assert "has 4.1 kB free; free some space" in said
    assert client.get("/health/live").is_success
    monkeypatch.undo()
    assert client.get("/health/ready").is_success
    assert client.get("/jobs/1").json()["reason"] == "no worker is running"


def test_figures_tell_of_jobs_workers_and_requests(client: httpx.Client, store: Store) -> None:
    assert figures(client)["slidercrank_queue_seconds", ()] == 0.0
    for _ in range(3):
        add(store)
    claim_waiting_job(store)
    store.register("one")
    for _ in range(5):
        client.get("/jobs/1")
    client.get("/jobs/99")
    client.get("/made/up")
    found = figures(client)
    assert found["slidercrank_jobs", ("queued",)] == 2.0
    assert found["slidercrank_jobs", ("running",)] == 1.0
    assert found["slidercrank_jobs", ("failed",)] == 0.0
    assert found["slidercrank_workers", ()] == 1.0
    assert 0.0 < found["slidercrank_queue_seconds", ()] < 60.0
    assert found["slidercrank_request_seconds_count", ("GET", "show_job", "200")] == 5.0
    assert found["slidercrank_request_seconds_count", ("GET", "show_job", "404")] == 1.0
    assert found["slidercrank_request_seconds_count", ("any", "none", "404")] == 1.0
