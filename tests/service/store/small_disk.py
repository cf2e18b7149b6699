"""The disk of a store, of either kind, which a test fills except for small writes, or completely."""

from __future__ import annotations

import numpy as np
from sqlalchemy import Connection, event, text

from slidercrank.optimise.search.checkpoints import Identity, Record
from slidercrank.service.store import Store

_REFUSAL = """
CREATE FUNCTION refuse() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN RAISE EXCEPTION 'could not extend file' USING ERRCODE = 'disk_full'; END $$
"""


def large_record(number: int) -> Record:
    """Return the record of a round that does not fit where a renewal does."""
    words = np.random.default_rng(number).integers(1 << 60, size=30_000)
    return Record(Identity("0f" * 16, '{"slidercrank": "1"}'), number, number, 0.1 * number, words)


class Disk:
    """The disk of open stores of one database, which can be filled."""

    def __init__(self, *stores: Store) -> None:
        """Take a disk with room."""
        self._store = stores[0]
        self._pages, self._nothing = 1 << 30, False
        for store in stores:
            if store.sqlite:
                event.listen(store.engine, "begin", self._limit)
        if not self._store.sqlite:
            with self._store.writing() as connection:
                connection.execute(text(_REFUSAL))

    def fill(self, *, to_the_last_byte: bool = False) -> None:
        """Leave room for small writes only, or for nothing."""
        with self._store.writing() as connection:
            if self._store.sqlite:
                self._pages = connection.exec_driver_sql("PRAGMA page_count").scalar_one() + 8
                self._nothing = to_the_last_byte
                return
            for table in ("records", *(["jobs"] if to_the_last_byte else [])):
                when = f"CREATE TRIGGER full_disk BEFORE INSERT OR UPDATE ON {table} FOR EACH ROW"
                connection.execute(text(f"{when} EXECUTE FUNCTION refuse()"))

    def empty(self) -> None:
        """Make room."""
        self._pages, self._nothing = 1 << 30, False
        if not self._store.sqlite:
            with self._store.writing() as connection:
                for table in ("records", "jobs"):
                    connection.execute(text(f"DROP TRIGGER IF EXISTS full_disk ON {table}"))

    def _limit(self, connection: Connection) -> None:
        connection.exec_driver_sql(f"PRAGMA max_page_count={self._pages}")
        if self._nothing and not connection.get_execution_options().get("reading", False):
            connection.exec_driver_sql("CREATE TABLE large AS SELECT zeroblob(1000000)")
