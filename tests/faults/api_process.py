"""The API in a process of its own, `slidercrank serve`, that can be killed and restarted at its address."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
import psutil

from .lifeline import die_with_parent

TOKEN = "a-token-of-the-faults"


class Api:
    """A running API. url, where: where it is."""

    def __init__(self, address: str, files: int | None = None) -> None:
        """Start it on a store. files: how many it may open."""
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        self.where = ("127.0.0.1", port)
        self.url = f"http://127.0.0.1:{port}/"
        self._files = files
        self._command = [sys.executable, "-m", "slidercrank", "serve", "--store", address, "--port", str(port)]
        self._command += ["--workers", "0", "--submissions-per-minute", "0"]
        self._process = self._started()

    def answers(self) -> bool:
        """Whether it answers."""
        try:
            return httpx.get(f"{self.url}api/v1/health/live", trust_env=False, verify=False, timeout=0.2).is_success
        except httpx.TransportError:
            return False

    def until_it_answers(self) -> None:
        """Wait until it answers. Raises `TimeoutError` where it does not start within a minute."""
        end = time.monotonic() + 60.0
        while not self.answers():
            if time.monotonic() > end:
                raise TimeoutError("the API did not start within a minute")
            time.sleep(0.1)

    @property
    def process(self) -> psutil.Process:
        """Its process."""
        return psutil.Process(self._process.pid)

    def kill(self) -> None:
        """Kill it by SIGKILL and start it again."""
        self.end()
        self._process = self._started()

    def end(self) -> None:
        """Kill it."""
        self._process.kill()
        self._process.wait()

    def _started(self) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            self._command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "SLIDERCRANK_TOKEN": TOKEN},
            preexec_fn=self._prepare,
        )

    def _prepare(self) -> None:
        die_with_parent()
        if self._files is not None:
            import resource  # not on Windows

            resource.setrlimit(resource.RLIMIT_NOFILE, (self._files, self._files))


@contextmanager
def api(address: str, files: int | None = None) -> Iterator[Api]:
    """Give an API while it is needed."""
    started = Api(address, files)
    try:
        yield started
    finally:
        started.end()
