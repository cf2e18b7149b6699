"""Place of a store while faults are injected: a file, or a PostgreSQL server, both gone afterwards."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tests.service.store import postgresql

Kind = Literal["sqlite", "postgresql"]


@dataclass(frozen=True)
class Place:
    """A new store's address, a folder beside it, and the server where there is one."""

    address: str
    folder: Path
    server: postgresql.Cluster | None = None


@contextmanager
def place(kind: Kind) -> Iterator[Place]:
    """Give a place while it is needed. Raises `SystemExit` where PostgreSQL is not installed."""
    with tempfile.TemporaryDirectory(prefix="faults-") as name:
        folder = Path(name)
        if kind == "sqlite":
            yield Place(str(folder / "store.db"), folder)
            return
        reason, programs = postgresql.why_not(), postgresql.programs()
        if reason or programs is None:
            raise SystemExit(reason)
        with postgresql.cluster(programs) as server:
            yield Place(server.new_address(), folder, server)
