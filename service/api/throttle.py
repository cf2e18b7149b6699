"""Work of which one request does some at a time, so that the service stays quick for all others."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator

from fastapi import HTTPException

_PATIENCE = 30.0  # s
_MOST = 8  # requests that wait or work; each holds a thread, of which a service has 40


class Turns:
    """A kind of work, and who waits to do it."""

    def __init__(self, name: str) -> None:
        """Name it."""
        self.name = name
        self._waiting = threading.BoundedSemaphore(_MOST)
        self._working = threading.Lock()

    @contextlib.contextmanager
    def turn(self) -> Iterator[None]:
        """Wait for a turn; refuse with a 503 that says so where too many wait, or none comes soon."""
        if not self._waiting.acquire(blocking=False):
            raise self._busy(f"{_MOST} others wait")
        try:
            if not self._working.acquire(timeout=_PATIENCE):
                raise self._busy(f"others were first for {_PATIENCE:g} s")
            try:
                yield
            finally:
                self._working.release()
        finally:
            self._waiting.release()

    def _busy(self, why: str) -> HTTPException:
        detail = f"{self.name} is done for one request at a time; {why}; try again"
        return HTTPException(503, detail, headers={"Retry-After": "5"})


DRAWING = Turns("drawing")
"""matplotlib is not made for threads."""
SIMULATING = Turns("simulation")
READING = threading.Lock()
"""Jobs are read one at a time: several at once would not be sooner done, and keep signs of life waiting."""
