"""A question asked while a function of your own is at work: by raising, it ends the call and the function's process."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar

Poll = Callable[[], None]
_POLL: ContextVar[Poll | None] = ContextVar("poll", default=None)


@contextlib.contextmanager
def interrupted_by(poll: Poll) -> Iterator[None]:
    """While entered, let `poll` be called several times a second during every call that this thread waits for.

    A search cannot hand its own question down: quantities are evaluated in a hundred places that know of no search.
    """
    token = _POLL.set(poll)
    try:
        yield
    finally:
        _POLL.reset(token)


def ask() -> None:
    """Raise whatever ends the call under way, if anything does."""
    poll = _POLL.get()
    if poll is not None:
        poll()
