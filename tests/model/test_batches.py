"""Batches of designs on all cores, also in processes that are forked from one that has used them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from textwrap import dedent

import pytest

from slidercrank.model.kernel.batches import interrupted_by, poll_interruption, run_in_chunks

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")

HEAD = """
    import json, multiprocessing, os, signal, sys, threading, traceback
    from concurrent.futures import ProcessPoolExecutor
    import numpy as np

    counted = []
    os.register_at_fork(before=lambda: counted.append(threading.active_count()))
    from slidercrank.model.kernel.batches import run_in_chunks
    from slidercrank.model.kinematics.closed_forms import ClosedForm, evaluate_closed_form

    rng = np.random.default_rng(1)
    crank, offset = rng.uniform(0.01, 0.1, (2, 5000))
    designs = np.stack([crank, crank + offset + rng.uniform(0.01, 0.1, 5000), offset], axis=1)
    signal.signal(signal.SIGALRM, lambda *_: os.killpg(0, signal.SIGKILL))  # a hang ends by itself, with its children

    def strokes(_):
        return float(evaluate_closed_form(ClosedForm.STROKE, designs)[0].sum())

    told = {}
    for name, script in json.loads(sys.argv[1]).items():
        signal.alarm(20)
        try:
            exec(script)
        except Exception:
            told[name] = traceback.format_exc()
        else:
            told[name] = ""
    print(json.dumps(told))
"""
# Python 3.12 and newer warn where a thread is alive while a process forks.
ALIVE = """
    strokes(0)
    assert threading.active_count() > 1
    if not os.fork():
        os._exit(0)
    os.wait()
    assert counted == [1]
"""
POOLS = """
    here, fork = strokes(0), multiprocessing.get_context("fork")
    with fork.Pool(2) as pool:
        assert pool.map_async(strokes, range(4)).get(15) == [here] * 4
    with ProcessPoolExecutor(2, mp_context=fork) as pool:
        assert list(pool.map(strokes, range(4), timeout=15)) == [here] * 4
    assert strokes(0) == here
"""
THREADS = """
    here, found = strokes(0), []
    def work():
        for _ in range(100):
            found.append(strokes(0))
    others = [threading.Thread(target=work) for _ in range(3)]
    for thread in others:
        thread.start()
    for _ in range(10):
        child = os.fork()
        if not child:
            os._exit(strokes(0) != here)
        assert os.waitpid(child, 0)[1] == 0
    for thread in others:
        thread.join()
    assert found == [here] * 300
"""


@pytest.fixture(scope="module")
def told() -> dict[str, str]:
    """Return the error of each script, nothing where there is none; one process runs them one after another."""
    scripts = {name: dedent(script) for name, script in (("alive", ALIVE), ("pools", POOLS), ("threads", THREADS))}
    command = [sys.executable, "-W", "error", "-c", dedent(HEAD), json.dumps(scripts)]
    done = subprocess.run(command, capture_output=True, text=True, start_new_session=True)
    assert done.returncode == 0, f"exit code {done.returncode}: {done.stderr}"
    found: dict[str, str] = json.loads(done.stdout)
    return found


def test_no_thread_of_the_pool_is_alive_while_a_process_forks(told: dict[str, str]) -> None:
    assert told["alive"] == ""


def test_processes_forked_after_first_use_compute_the_same(told: dict[str, str]) -> None:
    assert told["pools"] == ""


def test_a_fork_waits_for_the_chunks_that_other_threads_have_under_way(told: dict[str, str]) -> None:
    assert told["threads"] == ""


def test_what_ends_one_chunk_ends_those_under_way_too() -> None:
    begun, ended = [], []

    def stop() -> None:
        raise TimeoutError

    def work(begin: int, _: int) -> None:
        begun.append(begin)
        try:
            poll_interruption()
        finally:
            time.sleep(0.01)
            ended.append(begin)

    with interrupted_by(stop), pytest.raises(TimeoutError):
        run_in_chunks(100_000, work)
    assert begun
    assert sorted(begun) == sorted(ended)
    assert len(begun) < 100_000 // 512
