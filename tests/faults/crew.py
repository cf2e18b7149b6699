"""Workers to be killed and paused: each a process, replaced when it dies, all gone at the end."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from multiprocessing import get_context
from multiprocessing.process import BaseProcess
from pathlib import Path

from .worker_process import main


class Crew:
    """Workers of one store. deaths: when each one that was killed died, s since 1970."""

    def __init__(
        self, address: str, journal: Path, *, size: int, lease: float, pause: float, clock: Path | None = None
    ) -> None:
        """Start `size` workers; lease and pause, in s, and clock as for `worker_process.main`."""
        self.size = size
        self.lease = lease
        self.deaths: dict[str, float] = {}
        self._options = (address, lease, journal, pause, clock)
        self._context = get_context("forkserver")
        self._context.set_forkserver_preload(["tests.faults.warm", main.__module__])
        self._names = (f"w{number}" for number in count(1))
        self._workers: dict[str, BaseProcess] = {}
        self.fill()

    def fill(self) -> None:
        """Start workers in the place of those that are gone."""
        address, *options = self._options
        while len(self._workers) < self.size:
            name = next(self._names)
            worker = self._context.Process(target=main, args=(address, name, *options), daemon=True)
            worker.start()
            self._workers[name] = worker

    def names(self) -> list[str]:
        """Return the workers that are there."""
        return list(self._workers)

    def pids(self) -> list[int]:
        """Return the numbers of the processes."""
        return [worker.pid for worker in self._workers.values() if worker.pid is not None]

    def kill(self, *names: str) -> None:
        """Kill workers by SIGKILL, all at about the same moment, and start others in their place."""
        for name in names:
            self._send(name, signal.SIGKILL)
            self.deaths[name] = time.time()
        for name in names:
            self._workers.pop(name).join()
        self.fill()

    def stop(self, name: str) -> None:
        """Stop a worker wherever it is, by SIGSTOP."""
        self._send(name, signal.SIGSTOP)

    def wake(self, name: str) -> None:
        """Let a stopped worker go on."""
        self._send(name, signal.SIGCONT)

    def fallen(self) -> list[str]:
        """Return the workers that ended without having been killed."""
        return [name for name, worker in self._workers.items() if not worker.is_alive()]

    def drained(self) -> bool:
        """Whether all workers have ended by themselves, as they do with a clock once no job waits."""
        return len(self.fallen()) == self.size

    def end(self) -> None:
        """Kill all workers."""
        for worker in self._workers.values():
            worker.kill()
        for worker in self._workers.values():
            worker.join()
        self._workers = {}

    def _send(self, name: str, blow: signal.Signals) -> None:
        pid = self._workers[name].pid
        assert pid is not None
        os.kill(pid, blow)


@contextmanager
def crew(
    address: str,
    journal: Path,
    *,
    size: int = 3,
    lease: float = 1.0,
    pause: float = 0.08,
    clock: Path | None = None,
) -> Iterator[Crew]:
    """Give a crew while it is needed."""
    started = Crew(address, journal, size=size, lease=lease, pause=pause, clock=clock)
    try:
        yield started
    finally:
        started.end()
