"""The time, as the database sees it: leases of several machines are compared by one clock only."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Double
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.functions import FunctionElement


class now(FunctionElement[float]):
    """Seconds since 1970 (UTC) at the moment when the statement looks, to a millisecond."""

    inherit_cache = True
    type = Double()


@compiles(now, "sqlite")
def _sqlite(_element: now, _compiler: SQLCompiler, **_options: Any) -> str:
    return "((julianday('now') - 2440587.5) * 86400.0)"


@compiles(now, "postgresql")
def _postgresql(_element: now, _compiler: SQLCompiler, **_options: Any) -> str:
    # now() of PostgreSQL stands still within a transaction, which may have waited for a lock beyond the end of a lease.
    return "CAST(extract(epoch FROM clock_timestamp()) AS double precision)"
