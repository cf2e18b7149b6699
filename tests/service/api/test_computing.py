"""Requests that compute: their processes, the limits of these, and that no such request is answered elsewhere."""

from __future__ import annotations

import contextlib
import threading
import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import psutil
import pytest
from starlette.types import Receive, Scope, Send

from slidercrank.model.kernel.kernel import Kernel
from slidercrank.service.api import computing
from slidercrank.service.api.app import MODULES, THREADS, computing_app, create_app
from slidercrank.service.api.computing import MOST as MOST_OF_AN_ANSWER
from slidercrank.service.api.computing import Computing
from slidercrank.service.api.job_requests import EXAMPLE
from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Job, Store
from tests.faults.serving import Serving, alive, runs_command_with_word
from tests.service import fronts as made
from tests.service.api.demanding import MOST, client_of, demanding, noting_application
from tests.service.api.fixed_front import Solved, store_result
from tests.service.api.serving import refusal_sentence, serving

pytestmark = pytest.mark.skipif(not hasattr(psutil.Process, "rlimit"), reason="limits are those of Linux")


@pytest.fixture(scope="module")
def client() -> Iterator[httpx.Client]:
    """Return a client of an application whose requests take what they name, more or less than they may."""
    with client_of(Computing(demanding, limits=MOST, modules=[demanding.__module__])) as client:
        yield client


def _process(client: httpx.Client) -> psutil.Process:
    return psutil.Process(int(client.get("/quick/process").text))


def test_a_request_within_its_limits_is_answered_and_its_process_is_kept(client: httpx.Client) -> None:
    before = _process(client)
    assert client.get("/quick/memory?bytes=100000000").text == "100000000"
    assert client.get("/quick/time?seconds=0.2").text == "done"
    assert client.get("/quick/time?seconds=0.4").text == "done"  # each has its own time
    for _ in range(2):
        assert client.get("/quick/kept?bytes=300000000").text == "kept"  # what others left does not count
    assert _process(client) == before


@pytest.mark.parametrize(
    ("asked", "lacking"), [("memory?bytes=1000000000", "memory"), ("time?seconds=5", "processor time")]
)
def test_a_request_beyond_a_limit_gets_one_sentence_and_the_next_one_its_answer(
    asked: str, lacking: str, client: httpx.Client
) -> None:
    before = _process(client)
    assert refusal_sentence(client.get(f"/long/{asked}"), 422) == (
        f"an answer may use at most 400 MB of memory and 0.5 s of processor time; this one needs more {lacking}; "
        "ask for less, or use a command such as slidercrank analyse, which has no limits"
    )
    assert _process(client) != before
    assert not before.is_running()


def test_a_process_that_is_killed_fails_its_own_request_alone(client: httpx.Client) -> None:
    answer = client.get("/long/killed")
    assert "must not end early; it ended (killed by SIGKILL); try again" in refusal_sentence(answer, 503)
    assert answer.headers["retry-after"] == "5"
    resting = _process(client)
    resting.kill()
    resting.wait(10.0)
    assert _process(client) != resting


def test_a_client_that_goes_ends_what_it_asked_for(client: httpx.Client) -> None:
    with client.stream("GET", "/long/endless") as answer:
        process = psutil.Process(int(next(answer.iter_text())))
        assert process.is_running()
    process.wait(10.0)


def test_quick_requests_do_not_wait_for_long_ones(client: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    with client.stream("GET", "/long/endless") as one, client.stream("GET", "/long/endless") as other:
        processes = {next(answer.iter_text()) for answer in (one, other)}
        assert len(processes) == 2
        assert client.get("/quick/process").text not in processes
        monkeypatch.setattr(computing, "_PATIENCE", 0.05)
        answer = client.get("/long/process")
        assert "at most 2 long analyses can be made at a time; all were busy for 0.05 s; try again" in refusal_sentence(
            answer, 503
        )
        assert answer.headers["retry-after"] == "5"


def test_opening_the_page_starts_one_process_ahead(store: Store, tmp_path: Path) -> None:
    started = tmp_path / "started"
    started.mkdir()
    computing = Computing(partial(noting_application, started), limits=MOST, modules=[demanding.__module__])
    with (
        contextlib.closing(computing),
        serving(create_app(store, computing=computing)) as address,
        httpx.Client(base_url=address, timeout=30.0, trust_env=False) as client,
    ):
        for _ in range(3):
            assert client.get("/").is_success
        while not list(started.iterdir()):
            assert client.get("/api/v1/health/live").is_success
        assert len(list(started.iterdir())) == 1


def test_closing_ends_every_process() -> None:
    with client_of(Computing(demanding, limits=MOST, modules=[demanding.__module__])) as client:
        process = _process(client)
    process.wait(10.0)


@pytest.mark.slow
def test_an_analysis_has_no_more_time_than_its_limit(store: Store, tmp_path: Path) -> None:
    settings = Settings()
    make = partial(computing_app, str(tmp_path / "store.db"), settings, most_queued=1, log_format="text")
    computing = Computing(make, limits=replace(MOST_OF_AN_ANSWER, seconds=1.5), modules=MODULES)
    job = EXAMPLE | {"friction": {"guide": 0.1}}  # its flywheel takes seconds
    design = {"job": job, "crank": "120 mm", "rod": "400 mm", "offset": "30 mm"}
    with (
        contextlib.closing(computing),
        serving(create_app(store, settings, computing)) as address,
        httpx.Client(base_url=f"{address}/api/v1", timeout=60.0, trust_env=False) as client,
    ):
        assert client.post("/analyse", json=design).status_code == 200
        long = client.post("/analyse", json=design | {"show": ["flywheel"]})
        assert "1.5 s of processor time; this one needs more processor time" in refusal_sentence(long, 422)
        assert client.post("/analyse", json=design).status_code == 200
        assert client.get("/jobs").status_code == 200


@pytest.mark.slow
def test_a_service_that_is_killed_leaves_no_process_that_computes(tmp_path: Path) -> None:
    with Serving(f"sqlite:///{tmp_path}/store.db") as serving:
        serving.until_ready()
        serving.ask("/check", {"job": EXAMPLE})
        computing = [
            process for process in serving.look_at_processes() if runs_command_with_word(process, "forkserver")
        ]
        serving.stop_watching()
        serving.process.kill()
        assert len(computing) > 1
        assert psutil.wait_procs(computing, timeout=10.0)[1] == []


@pytest.mark.slow
def test_a_service_that_ends_leaves_no_fork_server_for_any_time(tmp_path: Path) -> None:
    with Serving(f"sqlite:///{tmp_path}/store.db") as serving:
        serving.until_ready()
        serving.ask("/check", {"job": EXAMPLE})
        computing = [
            process for process in serving.look_at_processes() if runs_command_with_word(process, "forkserver")
        ]
        assert len(computing) > 1
        serving.stop_watching()
        serving.process.terminate()
        assert serving.process.wait(30.0) == 0
        _, left = psutil.wait_procs(computing, timeout=0.1)  # by itself it takes half a second
        assert not any(map(alive, left))


class _Elsewhere:
    """Takes requests that compute, and answers none."""

    def __init__(self) -> None:
        self.asked = 0

    async def handle_in_idle_process(self, _turns: str, _scope: Scope, _receive: Receive, send: Send) -> None:
        """Answer with 204."""
        self.asked += 1
        await send({"type": "http.response.start", "status": 204, "headers": []})
        await send({"type": "http.response.body"})


def test_every_endpoint_that_computes_has_a_process_for_it(
    solved: Solved, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ask everything of the description, by its own examples; here nothing may compute, or read what a job states."""

    def computed(*_: Any, **__: Any) -> None:
        raise AssertionError("computed in the process that takes requests")

    number = store_result(store, solved.result, tomllib.loads(made.JOB))
    elsewhere: Any = _Elsewhere()
    monkeypatch.setattr(Kernel, "__call__", computed)
    monkeypatch.setattr("slidercrank.optimise.job.parse_job", computed)
    answers = dict[str, int]()
    app = create_app(store, computing=elsewhere)
    with serving(app) as address, httpx.Client(base_url=address, timeout=30.0, trust_env=False) as client:
        paths = client.get("/api/v1/openapi.json").json()["paths"]
        operations = [(path, method, of) for path, methods in paths.items() for method, of in methods.items()]
        for path, method, operation in sorted(operations, key=lambda one: one[1] == "delete"):
            asked = {of["name"]: of["schema"].get("examples", [1])[0] for of in operation.get("parameters", [])}
            query = {"knee": "true", "job": str(number), "columns": "crank"}
            status = client.request(method, path.format(**asked | {"number": number}), params=query).status_code
            answers[f"{method} {path}"] = status
    assert {what: status for what, status in answers.items() if status >= 400} == {
        "post /api/v1/jobs/{number}/resume": 409,
        "get /api/v1/jobs/{number}/files/{name}": 404,
    }
    assert sum(status == 204 for status in answers.values()) == elsewhere.asked + 1  # a job is deleted, too


def test_few_threads_read_for_many_clients(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    reading = most = 0
    enough = threading.Event()
    all_there = threading.Semaphore(0)

    def jobs(**_: Any) -> list[Job]:
        nonlocal reading, most
        reading += 1
        most = max(most, reading)
        all_there.release()
        enough.wait(10.0)
        reading -= 1
        return []

    monkeypatch.setattr(store, "jobs", jobs)
    with serving(create_app(store)) as address, ThreadPoolExecutor(20) as clients:
        answers = [clients.submit(httpx.get, f"{address}/api/v1/jobs", trust_env=False) for _ in range(20)]
        for _ in range(THREADS):
            assert all_there.acquire(timeout=10.0)
        assert httpx.get(f"{address}/api/v1/health/live", trust_env=False).is_success
        enough.set()
        assert {answer.result().status_code for answer in answers} == {200}
    assert most == THREADS
