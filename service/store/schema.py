"""The tables of the store. Times are seconds since 1970 on the clock of the database; tables of a job are JSON text.

    jobs          one row a job: what is asked, where it stands, who has it until when
    events        what happened to a job, numbered 1, 2, 3, ... without gaps: states, progress, messages
    records       what the search of a job has found out, step by step: it resumes from these
    designs       the front of a finished job, one row a design, as it is shown
    exact         the same designs in SI with their slopes, one file a front; fronts of early stores have none
    artefacts     files of a job
    workers       who solves jobs, and when each was heard of last

Every change of a job, and every row that belongs to it, is written in a transaction that updates its row in `jobs`
first. So the writers of one job take turns, and its events become visible in the order of their numbers.
"""

from __future__ import annotations

from sqlalchemy import (
    BigInteger,
    Boolean,
    Column,
    Double,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
    false,
)

NAMES = {
    "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    "fk": "fk_%(table_name)s_%(column_0_N_name)s",
    "pk": "pk_%(table_name)s",
}
"""Names of constraints, so that migrations can name them on every database."""

metadata = MetaData(naming_convention=NAMES)
_number = BigInteger().with_variant(Integer, "sqlite")  # SQLite counts up keys of this type only


def _of_a_job() -> Column[int]:
    return Column("job", _number, ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)


jobs = Table(
    "jobs",
    metadata,
    Column("id", _number, primary_key=True, autoincrement=True),
    Column("key", String(255)),
    Column("name", Text, nullable=False),
    Column("run", String(255), nullable=False),
    Column("tables", Text, nullable=False),
    Column("state", String(16), nullable=False),
    Column("reason", Text, nullable=False, server_default=""),
    Column("priority", Integer, nullable=False, server_default="0"),
    Column("attempts", Integer, nullable=False, server_default="0"),
    Column("most_attempts", Integer, nullable=False),
    Column("most_seconds", Double),
    Column("most_evaluations", BigInteger),
    Column("most_memory", BigInteger),
    Column("cancel_asked", Boolean, nullable=False, server_default=false()),
    Column("submitted", Double, nullable=False),
    Column("due", Double, nullable=False),
    Column("started", Double),
    Column("finished", Double),
    Column("worker", String(255)),
    Column("lease_until", Double),
    Column("fence", Integer, nullable=False, server_default="0"),
    Column("writes", Integer, nullable=False, server_default="0"),
    Column("records", Integer, nullable=False, server_default="0"),
    Column("events", Integer, nullable=False, server_default="0"),
    Column("progress", Text),
    Column("summary", Text),
    Column("result", Text),
    UniqueConstraint("key"),
    UniqueConstraint("run"),
    Index(None, "state", "priority", "id"),
    sqlite_autoincrement=True,  # the number of a deleted job never comes back
)
"""key: of the submission, to recognise a repeated one. run: the name of the run folder. most_*: `Limits`. due: not
to be claimed before. fence: how often it was claimed. writes: how often the holder of this claim has written.
records, events: how many there are. progress: the latest. summary: for lists. result: `Result.record` without
designs, with the names of their columns."""

events = Table(
    "events",
    metadata,
    _of_a_job(),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("at", Double, nullable=False),
    Column("kind", String(16), nullable=False),
    Column("data", Text, nullable=False),
)

records = Table(
    "records",
    metadata,
    _of_a_job(),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("content", LargeBinary, nullable=False),
)

designs = Table(
    "designs",
    metadata,
    _of_a_job(),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("cells", Text, nullable=False),
)

exact = Table("exact", metadata, _of_a_job(), Column("content", LargeBinary, nullable=False))

artefacts = Table(
    "artefacts",
    metadata,
    _of_a_job(),
    Column("name", String(255), primary_key=True),
    Column("media_type", String(255), nullable=False),
    Column("at", Double, nullable=False),
    Column("content", LargeBinary, nullable=False),
)

workers = Table(
    "workers",
    metadata,
    Column("id", String(255), primary_key=True),
    Column("started", Double, nullable=False),
    Column("seen", Double, nullable=False),
)
