"""Processes, workers and schedulers that end in the middle."""

import contextlib
import os
import random
import subprocess
import sys
import threading
import time
from pathlib import Path

import psutil
import pytest

from slidercrank.model.errors import EngineError, InputError
from slidercrank.optimise.engine.cluster import Cluster, Tls
from slidercrank.optimise.engine.processes import Processes
from tests.faults.dask_cluster import DaskCluster
from tests.optimise.engine import work


@pytest.mark.slow
def test_what_a_killed_process_was_at_is_done_again(processes: Processes, tmp_path: Path) -> None:
    items = [(number, str(tmp_path / "killed")) for number in range(6)]
    assert processes.map(work.end_once, items) == list(range(6))
    assert (tmp_path / "killed").exists()


def test_designs_under_which_processes_end_again_and_again_are_named(processes: Processes) -> None:
    with pytest.raises(EngineError, match=r"; 3 did at the same designs \(chunk 3 of 5\); check for too little"):
        processes.map(work.end_always, range(5))
    assert processes.map(work.square, range(3)) == [0, 1, 4]


def test_processes_killed_at_random_lose_nothing(processes: Processes) -> None:
    processes.close()
    begin = time.monotonic()
    processes.map(work.process, range(4))
    start = time.monotonic() - begin  # a killed one needs as long again, on a machine under load many seconds
    over, chance = threading.Event(), random.Random(1)

    def kill() -> None:
        while not over.wait(max(1.0, 2.0 * start) + chance.random()):
            with contextlib.suppress(psutil.NoSuchProcess):  # ended since it was listed
                children = [child for child in psutil.Process().children() if "spawn_main" in " ".join(child.cmdline())]
                if children:
                    children[-1].kill()

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        assert processes.map(work.slow, range(30)) == list(range(30))
    finally:
        over.set()
        killer.join()


def test_processes_end_with_the_one_that_started_them(tmp_path: Path) -> None:
    code = (
        "import sys, time\n"
        "from slidercrank.optimise.engine.processes import Processes\n"
        "from tests.optimise.engine import work\n"
        "if __name__ == '__main__':\n"
        "    print(*set(Processes(2).map(work.process, range(8))), flush=True)\n"
        "    time.sleep(60)\n"
    )
    script = tmp_path / "started.py"
    script.write_text(code)
    root = str(Path(__file__).parents[3])
    parent = subprocess.Popen(
        [sys.executable, str(script)], stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": root}
    )
    assert parent.stdout is not None
    with parent, parent.stdout:
        children = [int(text) for text in parent.stdout.readline().split()]
        parent.kill()
        parent.wait()
    assert children
    end = time.monotonic() + 10.0
    while any(psutil.pid_exists(pid) for pid in children) and time.monotonic() < end:
        time.sleep(0.1)
    assert not [pid for pid in children if psutil.pid_exists(pid)]


@pytest.mark.skipif(os.name == "nt", reason="groups of processes are those of POSIX")
def test_ctrl_c_is_heard_by_nobody_but_the_one_who_asked(tmp_path: Path) -> None:
    code = (
        "import sys, os, signal, threading\n"
        "from slidercrank.optimise.engine.processes import Processes\n"
        "from tests.optimise.engine import work\n"
        "if __name__ == '__main__':\n"
        "    for delay in (0.05, 0.5, 1.5):\n"
        "        threading.Timer(delay, lambda: os.killpg(0, signal.SIGINT)).start()\n"
        "    heard, engine = [], Processes(2)\n"
        "    signal.signal(signal.SIGINT, lambda *_: heard.append(1))\n"
        "    assert engine.map(work.slow, range(20)) == list(range(20))\n"
        "    engine.close()\n"
        "    print(len(heard))\n"
    )
    script = tmp_path / "interrupted.py"
    script.write_text(code)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])}
    found = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, env=environment, start_new_session=True
    )
    assert (found.stdout, found.stderr) == ("3\n", "")


@pytest.mark.slow
def test_what_a_killed_dask_worker_was_at_is_done_again_and_a_lost_scheduler_is_found_again() -> None:
    with DaskCluster(2) as dask:
        engine = Cluster(dask.address, patience=60.0)
        assert engine.map(work.square, range(3)) == [0, 1, 4]

        def harm() -> None:
            for _ in range(2):
                time.sleep(0.5)
                dask.kill_worker()
            dask.kill_scheduler()
            time.sleep(1.0)
            dask.start_scheduler()

        harmer = threading.Thread(target=harm)
        harmer.start()
        try:
            assert engine.map(work.slow, range(40)) == list(range(40))
        finally:
            harmer.join()
            engine.close()


def test_a_scheduler_that_stays_away_is_given_up() -> None:
    engine = Cluster("tcp://127.0.0.1:9", patience=0.5)
    with pytest.raises(EngineError, match=r"within 0.5 s; tcp://127.0.0.1:9 did not .*; start it"):
        engine.map(work.square, range(3))


def test_a_cluster_without_workers_says_that_it_waits_for_one_and_is_given_up(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with DaskCluster(0) as dask:
        engine = Cluster(dask.address, patience=3.0)
        with pytest.raises(EngineError, match="a cluster needs workers"):
            engine.map(work.square, range(3))
        engine.close()
    (said,) = [record.getMessage() for record in caplog.records if record.name.startswith("slidercrank")]
    assert said.startswith(f"waiting for a worker: the scheduler at {dask.address} has none; giving up")
    assert said.endswith(f"start some: dask worker {dask.address}")


@pytest.mark.parametrize(
    ("address", "tls", "words"),
    [
        ("127.0.0.1:8786", False, "must look like tcp://host:8786"),
        ("tcp://127.0.0.1", False, "must look like tcp://host:8786"),
        ("tls://127.0.0.1:8786", False, "got tls://127.0.0.1:8786 without"),
        ("tcp://127.0.0.1:8786", True, "got tcp://127.0.0.1:8786 with;"),
    ],
)
def test_an_address_that_cannot_be_one_is_refused(address: str, tls: bool, words: str) -> None:
    files = Tls(Path("ca.pem"), Path("own.pem"), Path("own.key")) if tls else None
    with pytest.raises(InputError, match=words):
        Cluster(address, tls=files)


def test_fewer_than_one_process_is_refused() -> None:
    with pytest.raises(InputError, match="at least one; got 0"):
        Processes(0)


@pytest.mark.parametrize("address", ["tcp://me:geheim@there:8786", "postgresql://me:gehe@geheim@there/jobs"])
def test_an_address_that_is_no_schedulers_is_refused_without_a_password(address: str) -> None:
    with pytest.raises(InputError, match=r"without a user; got '\*\*\*@there") as refused:
        Cluster(address)
    assert "gehe" not in str(refused.value)
