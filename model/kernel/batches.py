"""Batches of designs on all cores, and interruption of long waits.

A polled callback ends the wait for a custom function or a kernel by raising.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from contextvars import ContextVar, copy_context
from dataclasses import dataclass
from functools import lru_cache
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import AssemblyError

Poll = Callable[[], None]
FAREWELL = 0.5
"""Time that an interrupted call may still take, s: a process that responds survives."""


@dataclass
class Interruption:
    """Callback that may end calls by raising an exception.

    between_parts: callback between the parts of work that ends by itself. farewell: time that calls have left after an
    interruption, s. killed: whether a call did not end within that time.
    """

    poll: Poll
    between_parts: Poll | None = None
    farewell: float = FAREWELL
    killed: bool = False


_CURRENT: ContextVar[Interruption | None] = ContextVar("interruption", default=None)


@contextlib.contextmanager
def interrupted_by(
    poll: Poll, *, between_parts: Poll | None = None, farewell: float = FAREWELL
) -> Iterator[Interruption]:
    """Context in which `poll` is called several times a second during every call that this thread waits for.

    between_parts: callback between the parts of long work in this thread.

    A search cannot pass its callback down: a hundred places evaluate quantities without knowing about a search.
    """
    interruption = Interruption(poll, between_parts, farewell)
    token = _CURRENT.set(interruption)
    try:
        yield interruption
    finally:
        _CURRENT.reset(token)


def poll_interruption() -> None:
    """Raise the exception that ends the current call, if there is one."""
    interruption = _CURRENT.get()
    if interruption is not None:
        interruption.poll()


def poll_between_parts() -> None:
    """Raise the exception that ends long work between two of its parts, if there is one."""
    interruption = _CURRENT.get()
    if interruption is not None and interruption.between_parts is not None:
        interruption.between_parts()


def interruption_grace_time() -> float:
    """Return the time that an interrupted call may still take, s."""
    interruption = _CURRENT.get()
    return FAREWELL if interruption is None else interruption.farewell


def record_killed_call() -> None:
    """Record that a call did not end in its remaining time."""
    interruption = _CURRENT.get()
    if interruption is not None:
        interruption.killed = True


_KNOTS = 10_000  # for the loads of designs that are computed together: some tenths of a second


def require_full_rotation(designs: ArrayLike) -> Array:
    """Return fully rotating designs (n, 3 + k) as a contiguous array: crank, rod, offset, m, and more.

    Raises `AssemblyError` where rod > crank + |offset| > 0 does not hold, because a formula might still return a number
    there.
    """
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    turns = (designs[:, 1] > designs[:, 0] + np.abs(designs[:, 2])) & (designs[:, 0] > 0.0)
    if not turns.all():
        row = int(np.flatnonzero(~turns)[0])
        crank, rod, offset = 1e3 * designs[row, :3]
        raise AssemblyError(
            "for full rotation, rod must exceed crank + |offset|, and crank must exceed 0; "
            f"got rod {rod:g} mm, crank {crank:g} mm, offset {offset:g} mm in design {row}; leave such designs out"
        )
    return designs


@lru_cache(maxsize=1)
def kernel_thread_pool() -> ThreadPoolExecutor:
    """Return the thread pool shared by kernels, which release the interpreter lock."""
    return ThreadPoolExecutor(max_workers=os.cpu_count() or 1, thread_name_prefix="slidercrank")


_handing_out = Lock()  # held while chunks are handed to the pool, and while this process forks


def _end_threads() -> None:
    """End the pool once its chunks are done: a fork would copy the pool but none of its threads."""
    _handing_out.acquire()
    if kernel_thread_pool.cache_info().currsize:
        kernel_thread_pool().shutdown()
        kernel_thread_pool.cache_clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_end_threads, after_in_parent=_handing_out.release, after_in_child=_handing_out.release)


def run_in_chunks(count: int, work: Callable[[int, int], Any], *, size: int = 512, knots: int = 0) -> None:
    """Call work(begin, end) for consecutive chunks of range(count), on all cores if there are several.

    Chunks have a fixed size and each design is evaluated by itself, so results do not depend on the number of cores.
    knots: number of knots in the loads of each design. More knots make smaller chunks; interruption is checked between
    chunks.
    """
    part = max(1, min(size, _KNOTS // max(1, knots)))

    def in_parts(begin: int, end: int) -> None:
        for first in range(begin, end, part):
            poll_between_parts()
            work(first, min(first + part, end))

    if count <= size:
        in_parts(0, count)
        return
    bounds = range(0, count, size)
    with _handing_out:
        # Each chunk has its own context, which knows the callbacks that may end the wait for a kernel.
        submitted = [
            kernel_thread_pool().submit(copy_context().run, in_parts, begin, min(begin + size, count))
            for begin in bounds
        ]
    try:
        for chunk in submitted:
            chunk.result()
    except Exception:
        for chunk in submitted:
            chunk.cancel()
        wait(submitted)  # an error that ends one chunk ends the other running ones
        raise
