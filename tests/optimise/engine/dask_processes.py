"""A Dask cluster on loopback whose processes the tests may kill: a scheduler at a fixed port, and workers."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from types import TracebackType
from typing import Self

START = 60.0
_ROOT = str(Path(__file__).parents[3])  # the tests' own functions are called there


class DaskProcesses:
    """While entered, a scheduler and workers of one thread, each in a process of its own and without a dashboard."""

    def __init__(self, workers: int = 2, *, security: tuple[str, ...] = (), scheme: str = "tcp") -> None:
        """Take how many workers, and options for both commands."""
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.count, self.security = workers, security
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
        self.scheduler = self._start(
            "dask_scheduler", "--host", self.address.rpartition(":")[0], "--port", str(self.port), "--no-dashboard"
        )
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
        self.scheduler.send_signal(signal.SIGKILL)
        self.scheduler.wait()

    def add_worker(self) -> None:
        """Start a worker; it joins when it is ready."""
        options = ("--no-nanny", "--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1", "--death-timeout", "60")
        self.workers.append(self._start("dask_worker", self.address, *options))

    def kill_worker(self) -> None:
        """Kill the oldest worker, and start another one."""
        oldest = self.workers.pop(0)
        oldest.send_signal(signal.SIGKILL)
        oldest.wait()
        self.add_worker()

    def _start(self, command: str, *options: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.{command}", *options, *self.security],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": _ROOT, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "10s"},
        )
