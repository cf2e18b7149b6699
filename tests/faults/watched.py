"""An API that is flooded: whether it answers all the time, and what it takes of the machine."""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

import httpx

from .api_process import Api
from .waits import Stopwatch

FILES = 1024
"""Files that the API may open, as by `ulimit -n 1024`."""
PATIENCE = 1.0
"""s until a sign of life, without those in which a thread of the API or of the harness waits for a processor."""
SIGNS = 11
"""Signs of life that are asked for at least."""
MEMORY = 200.0
"""MB that an API may take beyond those at rest."""
_CLOSED = 120.0
"""s within which it has closed all connections of a flood."""
_STORE = 150
"""Files that a store may open beyond those at rest: three for each of its threads, of which a service has 40."""


@dataclass
class Flooded:
    """Results of floods. slowest: of all signs of life, s. violations: what must not be, in words.

    memory, files: of the API at rest, at most (memory) and in the end; MB.
    """

    requests: int = 0
    signs: int = 0
    slowest: float = 0.0
    memory: list[float] = field(default_factory=list)
    files: list[int] = field(default_factory=list)
    violations: list[str] = field(default_factory=list)

    def look(self, served: Api) -> None:
        """Note what an API takes."""
        self.memory.append(served.process.memory_info().rss / 1e6)
        self.files.append(served.process.num_fds())

    def line(self) -> str:
        """Return the figures."""
        return (
            f"{self.requests} requests, {len(self.violations)} violations; "
            f"{self.signs} signs of life, the slowest after {self.slowest:.2f} s; "
            f"API at rest {self.memory[0]:.0f} MB, {self.files[0]} open files; at most {max(self.memory):.0f} MB; "
            f"in the end {self.memory[-1]:.0f} MB, {self.files[-1]} open files"
        )


@contextlib.contextmanager
def many_files() -> Iterator[None]:
    """Let this process open as many files as it may."""
    import resource  # not on Windows

    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (before[1], before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


@contextlib.contextmanager
def watch_flooded_api(served: Api, flooded: Flooded) -> Iterator[None]:
    """Watch an API while it is flooded, and whether it is at rest again afterwards."""
    for _ in range(20):  # what it keeps of its first requests is no matter of floods
        served.answers()
    flooded.look(served)
    over = threading.Event()
    watch = threading.Thread(target=_watch, args=(served, over, flooded))
    watch.start()
    try:
        yield
    finally:
        over.set()
        watch.join()
    end = time.monotonic() + _CLOSED
    while flooded.files[-1] > flooded.files[0] + _STORE and time.monotonic() < end:
        time.sleep(0.2)
        flooded.look(served)
    if time.monotonic() > end:
        flooded.violations.append(f"{flooded.files[-1]} files are open, {flooded.files[0]} at rest")
    if max(flooded.memory) > flooded.memory[0] + MEMORY:
        flooded.violations.append(f"{max(flooded.memory):.0f} MB of memory, {flooded.memory[0]:.0f} at rest")
    if not served.answers():
        flooded.violations.append("the API does not answer after the flood")


def _watch(served: Api, over: threading.Event, flooded: Flooded) -> None:
    """Ask for a sign of life all the time, each on a connection of its own."""
    while not over.wait(0.05):
        watch = Stopwatch(served.process.pid, os.getpid())
        try:
            answer = httpx.get(f"{served.url}api/v1/health/live", trust_env=False, verify=False, timeout=60.0)
        except httpx.TransportError as error:
            flooded.violations.append(f"no sign of life: {type(error).__name__}")
        else:
            if not answer.is_success:
                flooded.violations.append(f"no sign of life: {answer.status_code}")
        took = watch.seconds()
        flooded.signs += 1
        flooded.slowest = max(flooded.slowest, took)
        if took > PATIENCE:
            flooded.violations.append(f"a sign of life took {took:.2f} s")
        flooded.look(served)
