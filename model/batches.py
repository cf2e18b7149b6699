"""Batches of designs on all cores."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from os import cpu_count
from typing import Any


@lru_cache(maxsize=1)
def threads() -> ThreadPoolExecutor:
    """Return the pool that kernels (which release the interpreter lock) share."""
    return ThreadPoolExecutor(max_workers=cpu_count() or 1, thread_name_prefix="slidercrank")


def in_chunks(count: int, work: Callable[[int, int], Any], *, size: int = 512) -> None:
    """Call work(begin, end) for consecutive chunks of range(count), on all cores when there are several.

    Chunks have a fixed size and each design is evaluated by itself, so results do not depend on the number of cores.
    """
    if count <= size:
        if count:
            work(0, count)
        return
    bounds = range(0, count, size)
    for _ in threads().map(lambda begin: work(begin, min(begin + size, count)), bounds):
        pass
