"""Limits on requests at a time and within a minute, so that the service stays quick."""

from __future__ import annotations

import contextlib
import math
import threading
import time
from collections.abc import Callable, Iterator
from http import HTTPStatus

from fastapi import Request
from starlette.exceptions import HTTPException

_PATIENCE = 30.0  # s
_MOST = 8  # requests that wait or work; each holds a thread, of which a service has 40


class Turns:
    """A kind of work, and who waits to do it."""

    def __init__(self, name: str) -> None:
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


class RateLimit:
    """Lets a number through at once, and as many again over every minute. For one thread."""

    def __init__(self, per_minute: int, clock: Callable[[], float] = time.monotonic) -> None:
        """Begin. per_minute: 0 is no limit. clock: in s."""
        self.per_minute = per_minute
        self._clock = clock
        self._left = float(per_minute)
        self._at = clock()

    def wait(self) -> float:
        """Return 0 for one that is let through; else the time, in s, until there is room for it."""
        if not self.per_minute:
            return 0.0
        now, rate = self._clock(), self.per_minute / 60.0
        self._left = min(self._left + (now - self._at) * rate, float(self.per_minute))
        self._at = now
        if self._left < 1.0:
            return (1.0 - self._left) / rate
        self._left -= 1.0
        return 0.0


async def limit_submissions(request: Request) -> None:
    """Refuse a submission when too many came within a minute: a dependency of the endpoints that submit."""
    limit: RateLimit = request.app.state.submissions
    wait = limit.wait()
    if wait:
        seconds = math.ceil(wait)
        raise HTTPException(
            HTTPStatus.TOO_MANY_REQUESTS,
            f"at most {limit.per_minute} jobs may be submitted in a minute; got more; try again in {seconds} s",
            {"Retry-After": str(seconds)},
        )
