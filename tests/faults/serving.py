"""`slidercrank serve` with workers, watched: it answers within a second throughout, and leaves no process behind."""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, cast

import httpx
import psutil

from .api_process import TOKEN
from .lifeline import die_with_parent
from .verdict import Verdict
from .waits import Stopwatch

_ANSWERS = 1.0  # s, without waits for a processor


class Serving:
    """While entered, a service of its own. slowest: answer of /health/live, s. seen: all processes that it ever had."""

    def __init__(
        self,
        address: str,
        *arguments: str,
        folder: str | None = None,
        environment: Mapping[str, str] | None = None,
        log: str = os.devnull,
    ) -> None:
        """Take a store, further arguments, the folder in which it runs, and the file that gets what it prints."""
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        self.slowest, self.unanswered = 0.0, 0
        self.seen: dict[int, psutil.Process] = {}
        self._command = [sys.executable, "-m", "slidercrank", "serve", "--store", address, "--port", str(port)]
        self._command += ["--workers", "1", "--cores", "1", "--submissions-per-minute", "0", *arguments]
        self._folder, self._environment, self._log = folder, dict(environment or {}), log
        self._client = httpx.Client(
            base_url=f"http://127.0.0.1:{port}/api/v1",
            headers={"Authorization": f"Bearer {TOKEN}"},
            trust_env=False,
            verify=False,
            timeout=60.0,
        )
        self._over = threading.Event()
        self._watch = threading.Thread(target=self._look, daemon=True)

    def __enter__(self) -> Serving:
        with Path(self._log).open("ab") as log:
            self.process = subprocess.Popen(
                self._command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                cwd=self._folder,
                env={**os.environ, "SLIDERCRANK_TOKEN": TOKEN, **self._environment},
                preexec_fn=die_with_parent,
            )
        return self

    def __exit__(self, *_: object) -> None:
        self.stop_watching()
        self.process.terminate()
        self.process.wait(60.0)
        self._client.close()

    def stop_watching(self) -> None:
        """Ask it for nothing more: it is to end."""
        self._over.set()
        if self._watch.is_alive():
            self._watch.join()
        self.look_at_processes()

    def workers(self) -> list[psutil.Process]:
        """Return its workers."""
        return [process for process in self.look_at_processes() if runs_command_with_word(process, "worker_process")]

    def functions(self) -> list[psutil.Process]:
        """Return the processes of own functions, with all that they have started."""
        return [process for process in self.look_at_processes() if runs_command_with_word(process, "own.guard_process")]

    def until_ready(self) -> None:
        """Wait until it answers and has a worker; watch it from then on."""
        self.until(self._has_worker, 120.0)
        self._watch.start()

    def until(self, condition: Callable[[], Any], seconds: float) -> bool:
        """Wait until something is so, and return whether it was so in time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                if condition():
                    return True
            except httpx.TransportError:
                pass
            time.sleep(0.1)
        return False

    def submit(self, tables: Mapping[str, Any], **limits: float) -> int:
        """Submit a job and return its number."""
        answer = self._client.post("/jobs", json={"job": dict(tables), "limits": limits} if limits else {"job": tables})
        answer.raise_for_status()
        return int(answer.json()["id"])

    def ask(self, path: str, body: Mapping[str, Any]) -> None:
        """Ask it for something, whatever comes of it."""
        with contextlib.suppress(httpx.TransportError):
            self._client.post(path, json=dict(body))

    def cancel(self, number: int) -> None:
        """Cancel a job."""
        self._client.post(f"/jobs/{number}/cancel").raise_for_status()

    def job(self, number: int) -> dict[str, Any]:
        """Return where a job stands."""
        return cast(dict[str, Any], self._client.get(f"/jobs/{number}").raise_for_status().json())

    def ready(self) -> httpx.Response:
        """Return the answer of /health/ready."""
        return self._client.get("/health/ready")

    def look_at_processes(self) -> list[psutil.Process]:
        """Return all processes that it has now."""
        try:
            now = psutil.Process(self.process.pid).children(recursive=True)
        except psutil.NoSuchProcess:
            now = []
        self.seen.update({process.pid: process for process in now})
        return now

    def judge(self, verdict: Verdict) -> None:
        """Say whether it answered in time."""
        if self.unanswered or self.slowest > _ANSWERS:
            verdict.violate(
                "late", f"live: {self.unanswered} without an answer, the slowest after {self.slowest:.2f} s"
            )

    def _has_worker(self) -> bool:
        answer = self.ready()
        return answer.is_success and answer.json()["workers"] > 0

    def _look(self) -> None:
        with httpx.Client(base_url=str(self._client.base_url), trust_env=False, verify=False, timeout=60.0) as client:
            while not self._over.wait(0.2):
                watch = Stopwatch(self.process.pid, os.getpid())
                try:
                    self.unanswered += not client.get("/health/live").is_success
                except httpx.TransportError:
                    self.unanswered += 1
                self.slowest = max(self.slowest, watch.seconds())
                self.look_at_processes()


def runs_command_with_word(process: psutil.Process, word: str) -> bool:
    """Return whether a process lives and its command has a word."""
    try:
        return word in " ".join(process.cmdline())
    except psutil.Error:
        return False


def left_over(verdict: Verdict, serving: Serving, within: float = 2.0) -> None:
    """Say which processes are left of a service that has ended."""
    _, left = psutil.wait_procs([process for process in serving.seen.values() if alive(process)], timeout=within)
    for process in left:
        if alive(process):
            verdict.violate("left", f"process {process.pid}: {process}")
            process.kill()


def alive(process: psutil.Process) -> bool:
    """Whether a process goes on; one that nobody has waited for does not."""
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False
