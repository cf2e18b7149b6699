"""A log of every change of a job, kept by a database trigger: no worker can write past it."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import text

from slidercrank.service.store.database import Database

_TABLE = "CREATE TABLE audit (number {key}, job BIGINT, fence INTEGER, writes INTEGER, was TEXT, state TEXT)"
_CHANGE = (
    "INSERT INTO audit (job, fence, writes, was, state) VALUES (NEW.id, NEW.fence, NEW.writes, OLD.state, NEW.state);"
)
_SQLITE = [
    _TABLE.format(key="INTEGER PRIMARY KEY AUTOINCREMENT"),
    f"CREATE TRIGGER audited AFTER UPDATE ON jobs BEGIN {_CHANGE} END",
]
_POSTGRESQL = [
    _TABLE.format(key="BIGSERIAL PRIMARY KEY"),
    f"CREATE FUNCTION audited() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN {_CHANGE} RETURN NULL; END $$",
    "CREATE TRIGGER audited AFTER UPDATE ON jobs FOR EACH ROW EXECUTE FUNCTION audited()",
]


@dataclass(frozen=True)
class Change:
    """State of a job after a change, and the state before it."""

    fence: int
    writes: int
    was: str
    state: str


def keep_audit(address: str) -> None:
    """Begin the log of a store."""
    database = Database(address)
    with database.writing() as connection:
        for statement in _SQLITE if database.sqlite else _POSTGRESQL:
            connection.exec_driver_sql(statement)
    database.close()


def changes(address: str) -> dict[int, list[Change]]:
    """Return all changes of each job, in the order in which they took effect."""
    database = Database(address)
    found: dict[int, list[Change]] = {}
    with database.reading() as connection:
        query = text("SELECT job, fence, writes, was, state FROM audit ORDER BY number")
        for job, *change in connection.execute(query):
            found.setdefault(job, []).append(Change(*change))
    database.close()
    return found
