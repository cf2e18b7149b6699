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
        """Return the figures: at first, at most, and at last while the most processes ran."""
        if not self._samples:
            return f"no processes; {len(self.left)} left"
        most = max(one.processes for one in self._samples)
        whole = [one for one in self._samples if one.processes == most]
        first = next((one for one in whole if one.at - whole[0].at >= _STARTED), whole[-1])
        last = whole[-2:][0]  # in the very last one some may be about to end
        memory = [first.memory, max(one.memory for one in self._samples), last.memory]
        files = [first.files, max(one.files for one in self._samples), last.files]
        return (
            f"{most} processes, {len(self.left)} left; "
            "{:.0f} MB at first, {:.0f} at most, {:.0f} at last; ".format(*(size / 1e6 for size in memory))
            + "{} open files at first, {} at most, {} at last".format(*files)
        )

    def _watch(self) -> None:
        while not self._over.wait(_LOOK):
            used = []
            for process in psutil.Process().children(recursive=True):
                try:
                    if not _is_helper_process(process):
                        self._seen.add(process)
                        if "python" in process.name():  # not what starts a server, or mounts a disk
                            used.append((process.memory_info().rss, process.num_fds()))
                except psutil.Error:  # it has just ended
                    pass
            if used:
                memory, files = map(sum, zip(*used, strict=True))
                self._samples.append(_Sample(time.monotonic(), len(used), memory, files))


def _is_helper_process(process: psutil.Process) -> bool:
    """Whether a process is one of `multiprocessing`, which the harness keeps to start its workers from."""
    return process.ppid() == os.getpid() and any("multiprocessing." in part for part in process.cmdline())
