"""Processes of own functions in a worker. They end with their job, and one that did not answer is not asked again."""

from __future__ import annotations

import gc
import os
import threading
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from slidercrank.objectives.own.function_process_client import Worker
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import Terms, work
from tests.faults.serving import Serving, alive, runs_command_with_word

pytestmark = pytest.mark.skipif(os.name != "posix", reason="groups of processes are those of POSIX")
BUSY = 1.0  # s that a busy machine may add
MODULE = """
import pathlib, time

calls = 0

def fine(designs):
    return designs.crank

def stays(designs):
    while True:
        pathlib.Path("looping").touch()
        time.sleep(0.1)

def loops(designs):
    global calls
    calls += 1
    while calls > 6:
        pathlib.Path("looping").touch()
        time.sleep(0.1)
    return designs.crank
"""
JOB = """
name = "own"
[mechanism]
speed = "300 rpm"
[variables]
crank = ["20 mm", "60 mm"]
rod = ["80 mm", "300 mm"]
offset = ["5 mm", "60 mm"]
[objectives]
mine = "minimise"
time_ratio = "maximise"
[optimiser]
method = "nsga2"
samples = 20
evaluations = 200
designs = 4
[quantity.mine]
function = "FUNCTION"
unit = "mm"
gradient = "none"
"""


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Store]:
    """Return an empty store in the folder of the functions; nothing is collected that refers to itself."""
    (tmp_path / "own_functions.py").write_text(MODULE)
    monkeypatch.chdir(tmp_path)
    gc.disable()
    try:
        with Store(tmp_path / "store.db") as opened:
            yield opened
    finally:
        gc.enable()


def submit(store: Store, function: str) -> int:
    """Return the number of a job with one of the functions."""
    return store.submit(tomllib.loads(JOB.replace("FUNCTION", function)), name="own").id


def functions() -> set[int]:
    """Return the processes of own functions that this one has; other tests leave some."""
    return {
        child.pid
        for child in psutil.Process().children(recursive=True)
        if runs_command_with_word(child, "own.guard_process")
    }


def test_the_process_of_a_function_ends_with_its_job(store: Store) -> None:
    before = functions()
    job = submit(store, "own_functions:fine")
    work(store, drain=True, terms=Terms(allowed_quantities=("own_functions:fine",)))
    assert store.job(job).state == "done"
    assert functions() <= before


def test_a_function_that_did_not_answer_is_not_asked_again(
    store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = Worker._start
    starts: list[str] = []

    def counted(worker: Worker) -> None:
        starts.append(worker.function)
        start(worker)

    monkeypatch.setattr(Worker, "_start", counted)
    before = functions()
    job = submit(store, "own_functions:loops")
    looping = tmp_path / "looping"
    begin: list[float] = []

    def stop_watch() -> bool:
        if looping.exists() and not begin:
            begin.append(time.monotonic())
            store.cancel(job)
        return False

    work(store, drain=True, terms=Terms(allowed_quantities=("own_functions:loops",)), stop=stop_watch)
    assert time.monotonic() - begin[0] < 2.0 + BUSY
    ended = store.job(job)
    assert (ended.state, len(starts)) == ("cancelled", 1)
    assert ended.records > 0
    assert ended.reason.startswith("cancelled; custom functions were too slow to report the designs found so far")
    assert functions() <= before


@pytest.mark.slow
def test_a_service_ends_soon_though_a_request_is_at_a_function_that_loops(tmp_path: Path) -> None:
    (tmp_path / "own_functions.py").write_text(MODULE)
    arguments = ("--workers", "0", "--allow-quantity", "own_functions:stays")
    with Serving(str(tmp_path / "store.db"), *arguments, folder=str(tmp_path)) as serving:
        assert serving.until(serving.ready, 60.0)
        job = tomllib.loads(JOB.replace("FUNCTION", "own_functions:stays"))
        asked = {"job": job, "crank": "40 mm", "rod": "100 mm", "offset": "10 mm"}
        asking = threading.Thread(target=serving.ask, args=("/analyse", asked))
        asking.start()
        assert serving.until((tmp_path / "looping").exists, 60.0)
        at_work = serving.functions()
        begin = time.monotonic()
        serving.process.terminate()
        assert serving.process.wait(30.0) == 0
        assert time.monotonic() - begin < 5.0
        asking.join()
        assert at_work
        assert serving.until(lambda: not any(map(alive, at_work)), 5.0)
