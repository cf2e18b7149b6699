"""Memory, processes and open files of the services and workers of a round, at its beginning and at its end."""

from __future__ import annotations

import os
import threading
import time
from dataclasses import dataclass

import psutil

from .serving import alive

_LOOK = 0.5  # s
_STARTED = 5.0  # s that the first processes have to load what they need
_ENDS = 5.0  # s that a process has to end after its round


@dataclass(frozen=True)
class _Sample:
    """Use of all processes at a moment, s. memory: resident, bytes. files: open ones."""

    at: float
    processes: int
    memory: int
    files: int


class Usage:
    """While entered, watches the processes that this one starts. left: those that outlive it, in words; they are ended.

    Servers of PostgreSQL are not among them, nor are processes of the harness that it keeps for its next round.
    """

    def __init__(self) -> None:
        """Prepare; nothing is watched yet."""
        self.left: list[str] = []
        self._seen: set[psutil.Process] = set()
        self._samples: list[_Sample] = []
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Usage:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()
        left = psutil.wait_procs(list(filter(alive, self._seen)), timeout=_ENDS)[1]
        for process in filter(alive, left):
            self.left.append(str(process))
            process.kill()

    def line(self) -> str:
        """Return the figures: once the first processes have started, the greatest, and the last before the end."""
        samples = self._samples or [_Sample(0.0, 0, 0, 0)]
        first = next((one for one in samples if one.at - samples[0].at >= _STARTED), samples[-1])
        parts = [
            f"{name} {first_} at first, {most} at most, {last} at last"
            for name, first_, most, last in (
                ("processes", first.processes, max(one.processes for one in samples), samples[-1].processes),
                (
                    "MB",
                    *(
                        f"{value / 1e6:.0f}"
                        for value in (first.memory, max(one.memory for one in samples), samples[-1].memory)
                    ),
                ),
                ("open files", first.files, max(one.files for one in samples), samples[-1].files),
            )
        ]
        return f"{'; '.join(parts)}; {len(self.left)} processes left"

    def _watch(self) -> None:
        while not self._over.wait(_LOOK):
            used = []
            for process in psutil.Process().children(recursive=True):
                try:
                    if not _kept(process):
                        used.append((process.memory_info().rss, process.num_fds()))
                        self._seen.add(process)
                except psutil.Error:  # it has just ended
                    pass
            if used:
                memory, files = map(sum, zip(*used, strict=True))
                self._samples.append(_Sample(time.monotonic(), len(used), memory, files))


def _kept(process: psutil.Process) -> bool:
    """Whether a process is one of `multiprocessing`, which the harness keeps to start its workers from."""
    return process.ppid() == os.getpid() and any("multiprocessing." in part for part in process.cmdline())
