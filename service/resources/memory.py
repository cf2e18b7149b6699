"""Memory: amounts as people write them, what jobs of a worker use, and pauses of garbage collection."""

import contextlib
import gc
import re
from collections.abc import Iterator
from contextlib import contextmanager

from ...model.errors import InputError

TOLERATED = 0.25
"""Fraction of a job's limit that earlier jobs may occupy; beyond it the job goes to a fresh process."""
_UNITS = {"": 1, "B": 1, "KB": 10**3, "MB": 10**6, "GB": 10**9, "TB": 10**12}
_UNITS |= {"KIB": 2**10, "MIB": 2**20, "GIB": 2**30, "TIB": 2**40}
_FORM = re.compile(r"\s*(\d+(?:\.\d+)?)\s*([A-Za-z]*)\s*", re.ASCII)


class Memory:
    """Memory used by this process and its children, accounted per job.

    Memory in use at the start of a job, beyond that at the start of the first job, was left by earlier jobs: caches,
    compiled kernels, memory kept by the allocator. It does not count towards the job, and shrinks when some of it is
    freed.
    """

    def __init__(self) -> None:
        self._fresh = self._least = 0

    def begin_job(self) -> None:
        """Record the start of a job."""
        self._least = memory_taken()
        self._fresh = min(self._fresh or self._least, self._least)

    @property
    def left_by_earlier_jobs(self) -> int:
        """Memory left behind by earlier jobs, bytes."""
        return self._least - self._fresh

    def used_by_job(self) -> int:
        """Return the memory that the job uses now, bytes, including that of a fresh process."""
        total = memory_taken()
        self._least = min(self._least, total)
        return total - self.left_by_earlier_jobs


def memory_taken() -> int:
    """Return the resident memory of this process and its children, bytes."""
    import psutil

    process = psutil.Process()
    total = int(process.memory_info().rss)
    for child in process.children(recursive=True):
        with contextlib.suppress(psutil.Error):  # the process has just ended
            total += int(child.memory_info().rss)
    return total


def parse_size(text: str, option: str) -> int:
    """Return an amount in bytes. Raises `InputError`, which names the option, for invalid text."""
    match = _FORM.fullmatch(text)
    factor = _UNITS.get(match[2].upper()) if match else None
    size = int(float(match[1]) * factor) if match and factor else 0
    if not 0 < size < 2**63:
        raise InputError(
            f'{option} must be an amount of memory with its unit; got {text[:40]!r}; write it like "500 MB" or "2 GB"'
        )
    return size


def size_text(size: float) -> str:
    """Return an amount with three significant digits and its unit."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 999.5:
            return f"{size:.3g} {unit}"
        size /= 1000.0
    return f"{size:.3g} TB"


@contextmanager
def without_garbage_collection() -> Iterator[None]:
    """Suspend garbage collection, which takes a fifth of the time to load matplotlib or to draw a figure."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()
