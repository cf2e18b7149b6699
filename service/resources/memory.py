"""Memory of a worker: how much of it the job under way takes, and how much earlier jobs have left."""

from __future__ import annotations

import contextlib

TOLERATED = 0.25
"""Share of a job's limit that earlier jobs may have left; beyond it the job goes to a fresh process, which has none."""


class Memory:
    """Memory that this process and its children take, told apart by jobs.

    What is there when a job begins, beyond what was when the first one did, was left by others: caches, compiled
    kernels, memory that the allocator keeps. It does not count, and less of it once some is given back.
    """

    def __init__(self) -> None:
        self._fresh = self._least = 0

    def begin(self) -> None:
        """Take note that a job begins."""
        self._least = memory_taken()
        self._fresh = min(self._fresh or self._least, self._least)

    @property
    def left(self) -> int:
        """Memory that earlier jobs have left behind, in bytes."""
        return self._least - self._fresh

    def of_the_job(self) -> int:
        """Return the memory that the job takes now, in bytes, including that of a fresh process."""
        taken = memory_taken()
        self._least = min(self._least, taken)
        return taken - self.left


def memory_taken() -> int:
    """Return the memory of this process and its children, in bytes, as far as it is in main memory."""
    import psutil

    own = psutil.Process()
    taken = int(own.memory_info().rss)
    for child in own.children(recursive=True):
        with contextlib.suppress(psutil.Error):  # it has just ended
            taken += int(child.memory_info().rss)
    return taken
