"""Limit on the rate of requests."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from http import HTTPStatus

from fastapi import Request
from starlette.exceptions import HTTPException


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
