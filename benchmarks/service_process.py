"""A service in a process of its own, on loopback, for as long as it is needed."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx
import psutil

from tests.faults.lifeline import die_with_parent

TOKEN = "a-token-of-the-benchmarks"
_PATIENCE = 120.0  # s to start


@dataclass(frozen=True)
class Service:
    """A running service. url: of its API. process: that of the API; the workers have their own."""

    url: str
    process: psutil.Process

    def processor_time(self) -> float:
        """Return how much time of the processor the API has taken, s."""
        times = self.process.cpu_times()
        return float(times.user + times.system)

    def address_of(self, view: str) -> str:
        """Return the address of a view, such as "jobs/1", for a browser that has not been there yet."""
        return f"{self.url.removesuffix('api/v1/')}?token={TOKEN}#/{view}"


@contextmanager
def service(address: str, folder: Path, *, workers: int) -> Iterator[Service]:
    """Give a service on a store, its workers as busy as jobs let them be. folder: for its log."""
    log = folder / "service.log"
    command = [sys.executable, "-m", "slidercrank", "serve", "--store", address, "--port", "0"]
    options = ["--workers", str(workers), "--submissions-per-minute", "0", "--lease", "30", "--grace", "1"]
    with log.open("wb") as out:
        environment = {**os.environ, "SLIDERCRANK_TOKEN": TOKEN, "PYTHONUNBUFFERED": "1"}
        process = subprocess.Popen(
            [*command, *options], stdout=out, stderr=out, env=environment, preexec_fn=die_with_parent
        )
    try:
        yield Service(f"{_url(process, log)}api/v1/", psutil.Process(process.pid))
    finally:
        process.terminate()
        try:
            process.wait(20.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def headers() -> dict[str, str]:
    """Return the headers of every request."""
    return {"Authorization": f"Bearer {TOKEN}"}


def _url(process: subprocess.Popen[bytes], log: Path) -> str:
    end = time.monotonic() + _PATIENCE
    while time.monotonic() < end and process.poll() is None:
        found = [word for word in log.read_text().split() if word.startswith("http://")]
        if found and _answers(found[0]):
            return found[0]
        time.sleep(0.1)
    raise SystemExit(f"the service did not start: {log.read_text()[-2000:]}")


def _answers(url: str) -> bool:
    try:
        return httpx.get(f"{url}api/v1/health/live", trust_env=False).is_success
    except httpx.TransportError:
        return False
