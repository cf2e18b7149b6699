"""A clock of databases that the tests own: their statements see it in the place of the true time."""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, event

_SQLITE = "((julianday('now') - 2440587.5) * 86400.0)"
_POSTGRESQL = "CAST(extract(epoch FROM clock_timestamp()) AS"


class Clock:
    """A clock in a file, which several processes share. ahead: of the true time, s."""

    def __init__(self, file: Path) -> None:
        """Take the clock of a file; a new one shows the true time."""
        self._descriptor = os.open(file, os.O_CREAT | os.O_RDWR, 0o600)

    @property
    def ahead(self) -> float:
        """Time by which it is ahead, s."""
        return float(struct.unpack("d", os.pread(self._descriptor, 8, 0) or bytes(8))[0])

    @ahead.setter
    def ahead(self, seconds: float) -> None:
        os.pwrite(self._descriptor, struct.pack("d", seconds), 0)

    def _show(self, _connection: Any, _cursor: Any, statement: str, parameters: Any, *_: Any) -> tuple[str, Any]:
        """Return a statement that sees the time of this clock."""
        statement = statement.replace(_SQLITE, f"({_SQLITE} + {self.ahead!r})")
        return statement.replace(_POSTGRESQL, _POSTGRESQL.replace(" AS", f" + {self.ahead!r} AS")), parameters

    @contextmanager
    def shown(self) -> Iterator[Clock]:
        """Let all databases of this process have this clock."""
        event.listen(Engine, "before_cursor_execute", self._show, retval=True)
        try:
            yield self
        finally:
            event.remove(Engine, "before_cursor_execute", self._show)
            os.close(self._descriptor)
