"""Limits on simultaneous requests and on requests per minute, to keep the service responsive."""

import contextlib
import math
import time
from collections.abc import AsyncIterator, Callable
from http import HTTPStatus
from typing import Any

from anyio import CapacityLimiter, fail_after
from starlette.exceptions import HTTPException

_PATIENCE = 30.0  # s
_MOST = 200  # requests that wait


@contextlib.asynccontextmanager
async def turn(limiter: CapacityLimiter, name: str) -> AsyncIterator[None]:
    """Wait for a turn; refuse with status 503 and a reason if too many wait or no turn comes soon.

    name: name of the requests that share the limiter, in the plural.
    """
    too_many = limiter.statistics().tasks_waiting >= _MOST
    try:
        with fail_after(0.0 if too_many else _PATIENCE):
            await limiter.acquire()
    except TimeoutError:
        why = f"{_MOST} others wait" if too_many else f"all were busy for {_PATIENCE:g} s"
        detail = f"at most {limiter.total_tokens} {name} can be made at a time; {why}; try again"
        raise HTTPException(HTTPStatus.SERVICE_UNAVAILABLE, detail, {"Retry-After": "5"}) from None
    try:
        yield
    finally:
        limiter.release()


class RateLimit:
    """Rate limiter: admits a burst of a given number, and as many again over every minute. For one thread."""

    def __init__(self, per_minute: int, clock: Callable[[], float] = time.monotonic) -> None:
        """Create a limiter. per_minute: number per minute; 0 means no limit. clock: clock in s."""
        self.per_minute = per_minute
        self._clock = clock
        self._left = float(per_minute)
        self._at = clock()

    def seconds_until_admitted(self) -> float:
        """Return 0 for an admitted request, or else the time until one can be admitted, s."""
        if not self.per_minute:
            return 0.0
        now, rate = self._clock(), self.per_minute / 60.0
        self._left = min(self._left + (now - self._at) * rate, float(self.per_minute))
        self._at = now
        if self._left < 1.0:
            return (1.0 - self._left) / rate
        self._left -= 1.0
        return 0.0


def limit_submissions(app: Any) -> None:
    """Refuse a submission above the rate limit per minute."""
    limit: RateLimit = app.state.submissions
    wait = limit.seconds_until_admitted()
    if wait:
        seconds = math.ceil(wait)
        raise HTTPException(
            HTTPStatus.TOO_MANY_REQUESTS,
            f"at most {limit.per_minute} jobs may be submitted in a minute; got more; try again in {seconds} s",
            {"Retry-After": str(seconds)},
        )
