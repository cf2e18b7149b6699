"""The time, as the database sees it: leases of several machines are compared by one clock only.

That clock may be set, by hours and in either direction, and nothing may hang on it. Whoever holds a job measures its
lease on its own monotonic clock, and renews it when it sees that the database's clock has jumped. Whoever looks for
jobs takes none for a moment after a jump, so that holders come first; nor after the disk of the database was full, so
that leases could not be renewed. What cannot be, a sign of life or a due time too far in the future, is of a clock that
was set back, and holds nothing up. Results hang on fences alone.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from sqlalchemy import ColumnElement, Double, cast, literal
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.functions import FunctionElement

JUMP = 1.0
"""s between this clock and a monotonic one, from one look to the next, that are no delay but a jump."""
SETTLING = 2.0
"""s after a jump or a full disk in which no job is claimed: eight times as long as holders take to see it and to renew
their lease."""


class Jumps:
    """Jumps of the database's clock, seen by comparing it with a monotonic one at every look."""

    def __init__(self, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._monotonic = monotonic
        self._ahead: float | None = None
        self._until = -math.inf

    def is_settled(self, database_time: float, last_full: float = -math.inf) -> bool:
        """Return whether the last clock jump and the last full disk are both some time ago.

        database_time: time of the database, s. last_full: of the monotonic clock, s.
        """
        monotonic_time = self._monotonic()
        if self._ahead is not None and abs(database_time - monotonic_time - self._ahead) > JUMP:
            self._until = monotonic_time + SETTLING
        self._ahead = database_time - monotonic_time
        return monotonic_time >= max(self._until, last_full + SETTLING)


class now(FunctionElement[float]):
    """Seconds since 1970 (UTC) at the moment when the statement looks, to a millisecond."""

    inherit_cache = True
    type = Double()


def later(seconds: float) -> ColumnElement[float]:
    """Return the time in so many seconds from now on."""
    return now() + cast(literal(seconds), Double)


@compiles(now, "sqlite")
def _sqlite(_element: now, _compiler: SQLCompiler, **_options: Any) -> str:
    return "((julianday('now') - 2440587.5) * 86400.0)"


@compiles(now, "postgresql")
def _postgresql(_element: now, _compiler: SQLCompiler, **_options: Any) -> str:
    # now() of PostgreSQL stands still within a transaction, which may have waited for a lock beyond the end of a lease.
    return "CAST(extract(epoch FROM clock_timestamp()) AS double precision)"
