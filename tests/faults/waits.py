"""Time without waits for a processor: what a machine does beside the faults is no fault of the service."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path


class Stopwatch:
    """Time since it was made, s, less the longest wait for a processor of a thread of each process."""

    def __init__(self, *processes: int) -> None:
        """Take the numbers of the processes."""
        self._begin = time.monotonic()
        self._before = {process: _processor_waits(process) for process in processes}

    def seconds(self) -> float:
        """Return the time."""
        took = time.monotonic() - self._begin
        for process, before in self._before.items():
            took -= max(
                (now - before.get(thread, now) for thread, now in _processor_waits(process).items()), default=0.0
            )
        return took


def _processor_waits(process: int) -> dict[str, float]:
    """Return how long each thread of a process has waited for a processor since it began, s."""
    found = {}
    with contextlib.suppress(OSError):  # it has just ended
        for thread in Path(f"/proc/{process}/task").iterdir():
            with contextlib.suppress(OSError):
                found[thread.name] = int((thread / "schedstat").read_text().split()[1]) * 1e-9
    return found
