"""A Dask cluster on loopback whose processes may be killed: a scheduler at a fixed port, and workers."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from types import TracebackType
from typing import Self

START = 120.0
_LAST = 5.0  # s that a worker takes to end after its scheduler
_HERE = str(Path(__file__).parents[2])  # what is given out may be a function of the harness or of the tests
CALM = {
    "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "false",
    "DASK_DISTRIBUTED__ADMIN__TICK__INTERVAL": "1s",
    "DASK_DISTRIBUTED__ADMIN__SYSTEM_MONITOR__INTERVAL": "5s",
}
"""Variables of Dask's processes: at rest they take a fifth of the processor time, looking at themselves less often."""
_QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


class DaskCluster:
    """While entered, a scheduler and workers of one thread, each in a process of its own and without a dashboard."""

    def __init__(self, workers: int = 2, *, scheme: str = "tcp", options: tuple[str, ...] = ()) -> None:
        """Take how many workers, "tcp" or "tls", and options for scheduler and workers."""
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.count, self.scheme, self.options = workers, scheme, options
        self.address = f"{scheme}://127.0.0.1:{self.port}"
        self.scheduler: subprocess.Popen[bytes] | None = None
        self.workers: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Self:
        self.start_scheduler()
        for _ in range(self.count):
            self.add_worker()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        for process in (*self.workers, self.scheduler):
            if process is not None:
                process.kill()
                process.wait()

    def start_scheduler(self) -> None:
        """Start the scheduler, and wait until it listens."""
        where = ("--host", f"{self.scheme}://127.0.0.1", "--port", str(self.port))
        self.scheduler = self._start("dask_scheduler", *where, "--no-dashboard")
        end = time.monotonic() + START
        while time.monotonic() < end:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.1)
        raise TimeoutError("the scheduler does not listen")

    def kill_scheduler(self) -> None:
        """Kill the scheduler."""
        assert self.scheduler is not None
        self.scheduler.kill()
        self.scheduler.wait()

    def add_worker(self) -> None:
        """Start a worker; it joins when it is ready."""
        where = (self.address, "--host", f"{self.scheme}://127.0.0.1")
        alone = ("--no-nanny", "--nthreads", "1", "--no-dashboard", "--death-timeout", str(START))
        self.workers.append(self._start("dask_worker", *where, *alone))

    def kill_worker(self) -> None:
        """Kill the oldest worker, and start another one."""
        oldest = self.workers.pop(0)
        oldest.kill()
        oldest.wait()
        self.add_worker()

    def revive_workers(self) -> None:
        """Start workers in the place of those that ended: they end with their scheduler."""
        for place, worker in enumerate(self.workers):
            with contextlib.suppress(subprocess.TimeoutExpired):
                worker.wait(_LAST)
                self.add_worker()
                self.workers[place] = self.workers.pop()

    def suspend(self, seconds: float, *, scheduler: bool) -> None:
        """Suspend the scheduler, or else the oldest worker, for a while."""
        process = self.scheduler if scheduler else self.workers[0]
        assert process is not None
        process.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        process.send_signal(signal.SIGCONT)

    def _start(self, command: str, *options: str) -> subprocess.Popen[bytes]:
        program = [sys.executable, "-m", f"distributed.cli.{command}", *options, *self.options]
        return subprocess.Popen(program, env={**os.environ, **CALM, "PYTHONPATH": _HERE}, **_QUIET)  # type: ignore[call-overload,no-any-return]
