"""Time on the database clock, the only one that can compare leases across machines.

That clock may be set by hours in either direction, and nothing may depend on it. A worker with a job measures its lease
on its own monotonic clock, and renews it when the database clock has jumped. A worker that looks for jobs claims none
for a moment after a jump, so that holders come first. It also waits after the disk of the database was full, when
leases could not be renewed. A heartbeat or a due time impossibly far in the future comes from a clock that was set
back, and delays nothing. Results depend only on fences.
"""

import math
import time
from collections.abc import Callable
from typing import Any

from sqlalchemy import ColumnElement, Double, cast, literal
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.functions import FunctionElement

JUMP = 1.0
"""Difference in s between this clock and a monotonic one, since the last check, that means a jump and not a delay."""
SETTLING = 2.0
"""s without claims after a jump or a full disk: eight times as long as holders take to notice it and renew their
lease."""


class ClockJumps:
    """Jumps of the database clock, detected by comparing it with a monotonic clock at every check."""

    def __init__(self, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._monotonic = monotonic
        self._ahead: float | None = None
        self._until = -math.inf

    def is_steady(self, database_time: float, last_full: float = -math.inf) -> bool:
        """Return whether the last clock jump and the last full disk are both long enough ago.

        database_time: time of the database, s. last_full: time of the last full disk on the monotonic clock, s.
        """
        monotonic_time = self._monotonic()
        if self._ahead is not None and abs(database_time - monotonic_time - self._ahead) > JUMP:
            self._until = monotonic_time + SETTLING
        self._ahead = database_time - monotonic_time
        return monotonic_time >= max(self._until, last_full + SETTLING)


class now(FunctionElement[float]):
    """Seconds since 1970 (UTC) when the statement runs, to a millisecond."""

    inherit_cache = True
    type = Double()


def later(seconds: float) -> ColumnElement[float]:
    """Return the time a number of seconds from now."""
    return now() + cast(literal(seconds), Double)


@compiles(now, "sqlite")
def _sqlite(_element: now, _compiler: SQLCompiler, **_options: Any) -> str:
    return "((julianday('now') - 2440587.5) * 86400.0)"


@compiles(now, "postgresql")
def _postgresql(_element: now, _compiler: SQLCompiler, **_options: Any) -> str:
    # now() in PostgreSQL is constant within a transaction, which may have waited for a lock beyond the end of a lease.
    return "CAST(extract(epoch FROM clock_timestamp()) AS double precision)"
