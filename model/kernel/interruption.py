"""Interruption of waits for a custom function or a kernel: a polled callback ends the wait by raising."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from dataclasses import dataclass

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
