"""Jobs through the API: the same as in the store, with the same sentences."""

from __future__ import annotations

import json
import math
import tomllib
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import httpx
import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import parse_job
from slidercrank.service.api.job_requests import EXAMPLE, merge_patch
from slidercrank.service.store import Artefact, Limits, Store
from tests.service import fronts
from tests.service.api.conftest import Serve
from tests.service.api.serving import refusal_sentence
from tests.service.store.contents import add, claim_waiting_job, progress, result

TOML = {"Content-Type": "application/toml"}


def submitted(client: httpx.Client, **more: Any) -> dict[str, Any]:
    """Return a job that was submitted."""
    response = client.post("/jobs", json={"job": EXAMPLE, **more})
    assert response.status_code == 201, response.text
    job: dict[str, Any] = response.json()
    assert response.headers["location"] == f"/api/v1/jobs/{job['id']}"
    return job


def test_a_submitted_job_is_the_one_in_the_store(client: httpx.Client, store: Store) -> None:
    limits = {"seconds": 60, "evaluations": 1000, "memory_bytes": 10**9}
    job = submitted(client, priority=-3, limits=limits)
    assert job == store.job(job["id"]).record()
    assert store.job(job["id"]).limits == Limits(seconds=60, evaluations=1000, memory=10**9)
    assert job["limits"] == limits
    assert job["priority"] == -3
    assert store.job_tables(job["id"]) == EXAMPLE
    assert client.get(f"/jobs/{job['id']}").json() == job
    assert client.get(f"/jobs/{job['id']}/job").json() == EXAMPLE
    assert client.get(f"/jobs/{job['id']}/files").json()["files"] == ["job.json"]


def test_a_job_file_in_toml_is_kept_as_it_was_given(client: httpx.Client, store: Store) -> None:
    text = f"# by hand, ü\n{fronts.JOB}".encode()
    job = client.post("/jobs", content=text, headers=TOML).json()
    assert job["name"] == "Short test [job]"
    assert store.job_tables(job["id"]) == tomllib.loads(text.decode())
    file = client.get(f"/jobs/{job['id']}/files/job.toml")
    assert file.content == text
    assert file.headers["content-type"].startswith("application/toml")


@pytest.mark.parametrize(
    "text",
    [
        b"name = ",
        b"\xff",
        b"",
        b"a = nan",
        b"a = 1979-05-27",
        b"a = " + b"9" * 30,
        b'a = "\\u0000"',
        b"a = " + b"[" * 9000,
        b"a." * 2000 + b"b = 1",
        b"name = 'x'\nname = 'y'",
    ],
)
def test_a_file_that_is_no_job_in_toml_is_refused(shared: httpx.Client, text: bytes) -> None:
    assert "Error" not in refusal_sentence(shared.post("/jobs", content=text, headers=TOML), 422)


def test_a_job_of_another_type_is_refused(shared: httpx.Client) -> None:
    for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""):
        response = shared.post("/jobs", content=b"name = 'x'", headers={"Content-Type": kind} if kind else {})
        assert "application/toml" in refusal_sentence(response, 415)


def test_a_wrong_job_is_refused_with_the_sentence_of_the_command_line(shared: httpx.Client) -> None:
    wrong = {**EXAMPLE, "variables": {**EXAMPLE["variables"], "crank": ["20 kg", "200 mm"]}}  # type: ignore[dict-item]
    with pytest.raises(JobError) as error:
        parse_job(wrong)
    assert refusal_sentence(shared.post("/jobs", json={"job": wrong}), 422) == str(error.value)


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ({}, "body job: is missing, but required"),
        ({"job": EXAMPLE, "jop": 1}, "body jop: unknown; got 1"),
        ({"job": EXAMPLE, "priority": 1001}, "body priority: must be at most 1000; got 1001"),
        ({"job": EXAMPLE, "priority": "1"}, "body priority"),
        ({"job": EXAMPLE, "limits": {"seconds": 0}}, "body limits.seconds"),
        ({"job": EXAMPLE, "limits": {"evaluations": 1.5}}, "body limits.evaluations"),
    ],
)
def test_a_wrong_submission_is_refused_by_its_key(shared: httpx.Client, body: dict[str, Any], sentence: str) -> None:
    assert sentence in refusal_sentence(shared.post("/jobs", json=body), 422)


def test_a_file_of_the_client_is_not_opened(shared: httpx.Client) -> None:
    job = {**EXAMPLE, "target_motion": {"file": "/etc/passwd"}}
    for path, body in (("/jobs", {"job": job}), ("/check", {"job": job})):
        sentence = refusal_sentence(shared.post(path, json=body), 422)
        assert "target_motion" in sentence
        assert "be sent with the job (API: files)" in sentence
        assert 'got file "/etc/passwd"; send it, or give only the points' in sentence


def test_functions_of_a_job_run_only_if_the_operator_allows_them(serve: Serve) -> None:
    def asking(function: str) -> dict[str, Any]:
        objectives = {**EXAMPLE["objectives"], "own": "minimise"}  # type: ignore[dict-item]
        return {"job": {**EXAMPLE, "quantity": {"own": {"function": function}}, "objectives": objectives}}

    allowed = "tests.service.api.own_quantity:rod_over_crank"
    assert "only functions that the operator allows" in refusal_sentence(
        serve().post("/jobs", json=asking("os:remove")), 422
    )
    permitting = serve(allowed_quantities=frozenset({allowed}))
    sentence = refusal_sentence(permitting.post("/jobs", json=asking("os:remove")), 422)
    assert f'got "os:remove"; choose from {allowed}, have it allowed (serve, worker or mcp with --allow-' in sentence
    assert permitting.post("/jobs", json=asking(allowed)).status_code == 201


def test_formulas_need_no_leave_of_the_operator(serve: Serve) -> None:
    quantity = {"own": {"formula": "rod / crank"}}
    objectives = {**EXAMPLE["objectives"], "own": "minimise"}  # type: ignore[dict-item]
    job = {**EXAMPLE, "quantity": quantity, "objectives": objectives}
    client = serve()
    assert client.post("/jobs", json={"job": job}).status_code == 201
    both = {**job, "quantity": {"own": {"formula": "rod / crank", "function": "os:remove"}}}
    assert "only functions that the operator allows" in refusal_sentence(client.post("/jobs", json={"job": both}), 422)
    wrong = {**job, "quantity": {"own": {"formula": "rod / cranc"}}}
    assert "did you mean crank" in refusal_sentence(client.post("/jobs", json={"job": wrong}), 422)


def test_limits_are_those_of_the_service_unless_lower_ones_are_asked_for(serve: Serve) -> None:
    client = serve(limits=Limits(seconds=100.0, memory=10**9))
    assert submitted(client)["limits"] == {"seconds": 100.0, "evaluations": None, "memory_bytes": 10**9}
    assert submitted(client, limits={"seconds": 10})["limits"]["seconds"] == 10.0
    response = client.post("/jobs", json={"job": EXAMPLE, "limits": {"seconds": 101}})
    assert "limits.seconds: must be at most 100.0 here; got 101.0" in refusal_sentence(response, 422)
    toml = client.post("/jobs", content=fronts.JOB, headers=TOML).json()
    assert toml["limits"]["seconds"] == 100.0
    assert client.post("/jobs/2/clone", json={}).json()["limits"]["seconds"] == 10.0


def test_a_full_queue_is_told_with_when_to_come_again(serve: Serve, store: Store) -> None:
    store.most_queued = 1
    client = serve()
    submitted(client)
    response = client.post("/jobs", json={"job": EXAMPLE})
    assert "at most 1 jobs may wait" in refusal_sentence(response, 503)
    assert int(response.headers["retry-after"]) > 0


def test_submissions_at_once_with_one_key_make_one_job(serve: Serve, store: Store) -> None:
    client, body = serve(submissions_per_minute=0), json.dumps({"job": EXAMPLE})
    headers = {"Idempotency-Key": "0", "Content-Type": "application/json"}

    def again(number: int) -> tuple[str, int, int]:
        key = str(number // 16)  # each key is new to all 16 threads, which is when they can collide
        response = client.post("/jobs", content=body, headers={**headers, "Idempotency-Key": key})
        return key, response.status_code, response.json()["id"]

    with ThreadPoolExecutor(16) as threads:
        made = set(threads.map(again, range(160)))
    assert {(key, status) for key, status, _ in made} == {(str(key), 201) for key in range(10)}
    assert sorted(number for _, _, number in made) == list(range(1, 11))
    assert store.count_by_state() == {"queued": 10}
    other = client.post("/jobs", json={"job": {**EXAMPLE, "name": "Other"}}, headers=headers)
    assert "a key may only be used for one job" in refusal_sentence(other, 422)


@pytest.mark.parametrize("key", ["", "x" * 256, "a b", "\x80"])
def test_a_key_that_is_none_is_refused(shared: httpx.Client, key: str) -> None:
    headers = [(b"Idempotency-Key", key.encode("latin-1"))]
    refusal_sentence(shared.post("/jobs", json={"job": EXAMPLE}, headers=headers), 422)


def test_jobs_are_listed_by_pages_states_and_names(client: httpx.Client, store: Store) -> None:
    numbers = [add(store, name).id for name in ("Feeder", "Press", "feeder 2", "Pump", "FEEDER 3")]
    store.cancel(numbers[0])

    def listed(**asked: Any) -> tuple[list[int], int | None]:
        page = client.get("/jobs", params=asked).json()
        return [job["id"] for job in page["jobs"]], page["next"]

    assert listed() == ([5, 4, 3, 2, 1], None)
    assert listed(limit=2) == ([5, 4], 4)
    assert listed(limit=2, before=4) == ([3, 2], 2)
    assert listed(limit=2, before=2) == ([1], None)
    assert listed(limit=5) == ([5, 4, 3, 2, 1], None)
    assert listed(limit=2, sort="name") == ([1, 3], 3)
    assert listed(limit=3, sort="name", before=3) == ([5, 2, 4], None)
    assert "query sort" in refusal_sentence(client.get("/jobs", params={"sort": "size"}), 422)
    assert client.get("/jobs").json()["workers"] == "no worker, 4 waiting: start one with slidercrank worker"
    assert listed(name="feeder") == ([5, 3, 1], None)
    assert listed(name="feeder", state="queued") == ([5, 3], None)
    assert listed(state=["queued", "cancelled"], limit=4) == ([5, 4, 3, 2], 2)
    assert "query state" in refusal_sentence(client.get("/jobs", params={"state": "lost"}), 422)
    for limit in (0, 1001, "x"):
        refusal_sentence(client.get("/jobs", params={"limit": limit}), 422)


def test_a_job_goes_through_its_states(client: httpx.Client, store: Store) -> None:
    submitted(client)
    assert "cancel it first" in refusal_sentence(client.delete("/jobs/1"), 409)
    assert "only a cancelled or failed job can continue" in refusal_sentence(client.post("/jobs/1/resume"), 409)
    cancelled = client.post("/jobs/1/cancel")
    assert (cancelled.status_code, cancelled.json()["state"]) == (200, "cancelled")
    assert client.post("/jobs/1/cancel").json() == cancelled.json()
    assert client.post("/jobs/1/resume").json()["state"] == "queued"
    claim = claim_waiting_job(store)
    claim.report(progress(1))
    running = client.get("/jobs/1").json()
    assert running == store.job(1).record()
    assert running["progress"]["round"] == 1
    assert running["worker"] == "first"
    assert client.post("/jobs/1/cancel").json()["cancel_asked"]
    claim.finish(result())
    done = client.get("/jobs/1").json()
    assert done == store.job(1).record()
    assert done["state"] == "done"
    assert done["summary"]["designs"] == 2
    assert client.delete("/jobs/1").status_code == 204
    for method, path in (("GET", ""), ("DELETE", ""), ("POST", "/cancel"), ("POST", "/resume"), ("GET", "/job"),
                         ("GET", "/files"), ("GET", "/files/job.json"), ("GET", "/events")):  # fmt: skip
        assert "there is no job 1" in refusal_sentence(client.request(method, f"/jobs/1{path}"), 404) or "files" in path
    refusal_sentence(client.post("/jobs/1/clone", json={}), 404)


def test_a_copy_has_the_changes_and_the_rest_of_the_job(client: httpx.Client, store: Store) -> None:
    submitted(client, priority=7, limits={"seconds": 5})
    changes = {"name": "Heavier", "mechanism": {"slider": {"mass": "3 kg"}}, "optimiser": None}
    copy = client.post("/jobs/1/clone", json={"changes": changes}).json()
    assert (copy["name"], copy["priority"], copy["limits"]["seconds"]) == ("Heavier", 7, 5.0)
    tables = store.job_tables(2)
    assert tables["mechanism"]["slider"] == {"mass": "3 kg"}
    assert tables["mechanism"]["speed"] == "60 rpm"
    assert "optimiser" not in tables
    assert store.job_tables(1) == EXAMPLE
    other = client.post("/jobs/1/clone", json={"priority": -1, "limits": {}}).json()
    assert (other["priority"], other["limits"]["seconds"]) == (-1, None)
    wrong = client.post("/jobs/1/clone", json={"changes": {"variables": None}})
    assert "variables: is missing" in refusal_sentence(wrong, 422)
    headers = {"Idempotency-Key": "a-copy"}
    copies = [client.post("/jobs/1/clone", json={}, headers=headers).json()["id"] for _ in range(2)]
    assert copies == [4, 4]


@pytest.mark.parametrize(
    ("value", "changes", "becomes"),
    [  # RFC 7396, appendix A
        ({"a": "b"}, {"a": "c"}, {"a": "c"}),
        ({"a": "b"}, {"b": "c"}, {"a": "b", "b": "c"}),
        ({"a": "b"}, {"a": None}, {}),
        ({"a": "b", "b": "c"}, {"a": None}, {"b": "c"}),
        ({"a": ["b"]}, {"a": "c"}, {"a": "c"}),
        ({"a": "c"}, {"a": ["b"]}, {"a": ["b"]}),
        ({"a": {"b": "c"}}, {"a": {"b": "d", "c": None}}, {"a": {"b": "d"}}),
        ({"a": [{"b": "c"}]}, {"a": [1]}, {"a": [1]}),
        (["a", "b"], ["c", "d"], ["c", "d"]),
        ({"a": "b"}, ["c"], ["c"]),
        ({"a": "foo"}, None, None),
        ({"a": "foo"}, "bar", "bar"),
        ({"e": None}, {"a": 1}, {"e": None, "a": 1}),
        ([1, 2], {"a": "b", "c": None}, {"a": "b"}),
        ({}, {"a": {"bb": {"ccc": None}}}, {"a": {"bb": {}}}),
    ],
)
def test_a_merge_patch_does_what_its_standard_says(value: Any, changes: Any, becomes: Any) -> None:
    assert merge_patch(value, changes) == becomes


def test_a_place_that_is_not_there_and_a_method_it_does_not_know_are_told(shared: httpx.Client) -> None:
    assert "nothing exists at this address" in refusal_sentence(shared.get("/job"), 404)
    response = shared.put("/jobs/1")
    assert response.headers["allow"] == "GET, DELETE"
    assert "got PUT; use GET, DELETE" in refusal_sentence(response, 405)


@pytest.mark.parametrize("number", ["6%0C", "%206", "1_0", "6.0", "06", "+6", "six"])
def test_a_number_in_an_address_is_written_in_digits(shared: httpx.Client, number: str) -> None:
    assert "path number: must be a whole number; got" in refusal_sentence(shared.get(f"/jobs/{number}"), 422)
    query = number.replace("+", "%2B")
    assert "query before: must be a whole number" in refusal_sentence(shared.get(f"/jobs?before={query}"), 422)


def test_files_keep_their_bytes_and_type(client: httpx.Client, store: Store) -> None:
    content = bytes(range(256))
    add(store, files=[Artefact(name="figure.png", media_type="image/png", content=content)])
    response = client.get("/jobs/1/files/figure.png")
    assert (response.content, response.headers["content-type"]) == (content, "image/png")
    refusal_sentence(client.get("/jobs/1/files/nothing.png"), 404)


def test_a_running_job_shows_its_front_so_far_and_its_events_do_not(store: Store, client: httpx.Client) -> None:
    add(store)
    front = {"columns": ["time_ratio", "crank_mm"], "points": [[1.25, 40.0], [1.5, math.inf]]}
    claim_waiting_job(store).report(progress(1), front)
    found = client.get("/jobs/1").json()["progress"]
    assert found["front"] == {"columns": ["time_ratio", "crank_mm"], "points": [[1.25, 40.0], [1.5, None]]}
    events = client.get("/jobs/1/events").json()["events"]
    assert [event["data"] for event in events if event["kind"] == "progress"] == [
        {key: value for key, value in found.items() if key != "front"}
    ]
