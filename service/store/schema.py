"""Tables of the store. Times are in seconds since 1970 on the clock of the database; tables of a job are JSON text.

    jobs          one row per job: its content, its state, its worker and lease
    events        what happened to a job, numbered 1, 2, 3, ... without gaps: states, progress, messages
    records       steps of the search of a job, from which it resumes
    designs       the front of a finished job, one row per design, as shown
    exact         the same designs in SI with their slopes, one file per front; fronts of early stores have none
    artefacts     files of a job
    kept          bookmarked designs of a front, with their names, notes and reasons
    kept_history  changes to them: notes, reasons and decisions, with author and time
    workers       workers, and when each was last heard from

Every change to a job, and to any row that belongs to it, is written in a transaction that updates its row in `jobs`
first. So the writers of one job take turns, and its events become visible in order of number.
"""

import sqlalchemy as sa

NAMES = {
    "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    "fk": "fk_%(table_name)s_%(column_0_N_name)s",
    "pk": "pk_%(table_name)s",
}
"""Naming convention for constraints, so that migrations can name them on every database."""

metadata = sa.MetaData(naming_convention=NAMES)
_number = sa.BigInteger().with_variant(sa.Integer, "sqlite")  # SQLite auto-increments only keys of this type


def _job_column() -> sa.Column[int]:
    return sa.Column("job", _number, sa.ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)


jobs = sa.Table(
    "jobs",
    metadata,
    sa.Column("id", _number, primary_key=True, autoincrement=True),
    sa.Column("key", sa.String(255)),
    sa.Column("name", sa.Text, nullable=False),
    sa.Column("run", sa.String(255), nullable=False),
    sa.Column("tables", sa.Text, nullable=False),
    sa.Column("state", sa.String(16), nullable=False),
    sa.Column("reason", sa.Text, nullable=False, server_default=""),
    sa.Column("priority", sa.Integer, nullable=False, server_default="0"),
    sa.Column("attempts", sa.Integer, nullable=False, server_default="0"),
    sa.Column("most_attempts", sa.Integer, nullable=False),
    sa.Column("most_seconds", sa.Double),
    sa.Column("most_evaluations", sa.BigInteger),
    sa.Column("most_memory", sa.BigInteger),
    sa.Column("cancel_asked", sa.Boolean, nullable=False, server_default=sa.false()),
    sa.Column("submitted", sa.Double, nullable=False),
    sa.Column("due", sa.Double, nullable=False),
    sa.Column("started", sa.Double),
    sa.Column("finished", sa.Double),
    sa.Column("worker", sa.String(255)),
    sa.Column("lease_until", sa.Double),
    sa.Column("fence", sa.Integer, nullable=False, server_default="0"),
    sa.Column("writes", sa.Integer, nullable=False, server_default="0"),
    sa.Column("records", sa.Integer, nullable=False, server_default="0"),
    sa.Column("events", sa.Integer, nullable=False, server_default="0"),
    sa.Column("progress", sa.Text),
    sa.Column("summary", sa.Text),
    sa.Column("result", sa.Text),
    sa.Column("origin", _number),
    sa.Column("checksum", sa.String(128)),
    sa.UniqueConstraint("key"),
    sa.UniqueConstraint("run"),
    sa.Index(None, "state", "priority", "id"),
    sqlite_autoincrement=True,  # the number of a deleted job is never reused
)
"""key: key of the submission, to recognise a repeated one. run: name of the run folder. most_*: `Limits`. due: earliest
time of a claim. fence: number of claims so far. writes: number of writes by the holder of the current claim. records,
events: numbers of rows. progress: latest progress. summary: for lists. result: `Result.record` without designs, with
the names of their columns. origin: the job that it was copied from, which may be deleted. checksum: SHA-256 of result
and summary, followed by that of its designs and exact designs; results of early stores have none."""

events = sa.Table(
    "events",
    metadata,
    _job_column(),
    sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
    sa.Column("at", sa.Double, nullable=False),
    sa.Column("kind", sa.String(16), nullable=False),
    sa.Column("data", sa.Text, nullable=False),
)

records = sa.Table(
    "records",
    metadata,
    _job_column(),
    sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
    sa.Column("content", sa.LargeBinary, nullable=False),
)

designs = sa.Table(
    "designs",
    metadata,
    _job_column(),
    sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
    sa.Column("cells", sa.Text, nullable=False),
)

exact = sa.Table("exact", metadata, _job_column(), sa.Column("content", sa.LargeBinary, nullable=False))

artefacts = sa.Table(
    "artefacts",
    metadata,
    _job_column(),
    sa.Column("name", sa.String(255), primary_key=True),
    sa.Column("media_type", sa.String(255), nullable=False),
    sa.Column("at", sa.Double, nullable=False),
    sa.Column("content", sa.LargeBinary, nullable=False),
)

bookmarks = sa.Table(
    "kept",
    metadata,
    _job_column(),
    sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
    sa.Column("name", sa.Text, nullable=False),
    sa.Column("note", sa.Text, nullable=False),
    sa.Column("star", sa.Boolean, nullable=False),
    sa.Column("decided", sa.Boolean, nullable=False),
    sa.Column("reason", sa.Text, nullable=False),
    sa.Column("design", sa.Integer),
    sa.Column("variant", sa.Integer, nullable=False),
    sa.Column("dimensions", sa.Text, nullable=False),
    sa.Column("at", sa.Double, nullable=False),
    sa.Column("allowed", sa.Text, nullable=False, server_default="{}"),
)

history = sa.Table(
    "kept_history",
    metadata,
    _job_column(),
    sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
    sa.Column("bookmark", sa.Integer),
    sa.Column("name", sa.Text, nullable=False),
    sa.Column("action", sa.Text, nullable=False),
    sa.Column("text", sa.Text, nullable=False),
    sa.Column("author", sa.Text, nullable=False),
    sa.Column("at", sa.Double, nullable=False),
)

wishes = sa.Table(
    "wishes",
    metadata,
    _job_column(),
    sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
    sa.Column("wishes", sa.Text, nullable=False),
    sa.Column("design", sa.Integer),
    sa.Column("at", sa.Double, nullable=False),
)

workers = sa.Table(
    "workers",
    metadata,
    sa.Column("id", sa.String(255), primary_key=True),
    sa.Column("started", sa.Double, nullable=False),
    sa.Column("seen", sa.Double, nullable=False),
)
