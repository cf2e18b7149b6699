"""Batches of designs on all cores, also in processes that are forked from one that has used them."""

from __future__ import annotations

import os
import subprocess
import sys
from textwrap import dedent

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")

HEAD = """
    import multiprocessing, os, signal, threading
    from concurrent.futures import ProcessPoolExecutor
    import numpy as np

    counted = []
    os.register_at_fork(before=lambda: counted.append(threading.active_count()))
    from slidercrank.model.kernel.batches import in_chunks
    from slidercrank.model.kinematics.closed_forms import ClosedForm, evaluate_closed_form

    rng = np.random.default_rng(1)
    crank, offset = rng.uniform(0.01, 0.1, (2, 5000))
    designs = np.stack([crank, crank + offset + rng.uniform(0.01, 0.1, 5000), offset], axis=1)
    signal.signal(signal.SIGALRM, lambda *_: os.killpg(0, signal.SIGKILL))  # a hang ends by itself, with its children
    signal.alarm(20)

    def strokes(_):
        return float(evaluate_closed_form(ClosedForm.STROKE, designs)[0].sum())
"""


def run(script: str) -> str:
    command = [sys.executable, "-W", "error", "-c", dedent(HEAD) + dedent(script)]
    done = subprocess.run(command, capture_output=True, text=True, start_new_session=True)
    assert done.returncode == 0, f"exit code {done.returncode}: {done.stderr}"
    return done.stdout


def test_processes_forked_after_first_use_compute_the_same() -> None:
    script = """
        here, fork = strokes(0), multiprocessing.get_context("fork")
        with fork.Pool(2) as pool:
            assert pool.map_async(strokes, range(4)).get(15) == [here] * 4
        with ProcessPoolExecutor(2, mp_context=fork) as pool:
            assert list(pool.map(strokes, range(4), timeout=15)) == [here] * 4
        assert strokes(0) == here
        print("done")
    """
    assert run(script) == "done\n"


def test_no_thread_of_the_pool_is_alive_while_a_process_forks() -> None:
    # Python 3.12 and newer warn where one is.
    script = """
        strokes(0)
        assert threading.active_count() > 1
        if not os.fork():
            os._exit(0)
        os.wait()
        print(counted)
    """
    assert run(script) == "[1]\n"


def test_a_fork_waits_for_the_chunks_that_other_threads_have_under_way() -> None:
    script = """
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
        print("done")
    """
    assert run(script) == "done\n"
