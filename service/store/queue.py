"""Queue of a store: adding jobs, and selecting the next job for a worker."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import astuple
from typing import Any

from sqlalchemy import Connection, and_, delete, exists, func, insert, not_, or_, select, text, update

from ...model.errors import InputError, QueueFull
from .database_clock import JUMP, ClockJumps, later, now
from .job_rows import add_events, change_state, state_event
from .records import JOB_COLUMNS, LIMITS, Artefact, Job, Limits
from .schema import artefacts, jobs, workers
from .schema_version import LOCK
from .serialisation import compact_json, database_text

MOST_DELAY = 60.0
"""s after which a job is due again at the latest: a later due time comes from a clock that was set back since."""
# Every write to a job is a heartbeat of its worker. A heartbeat in the future dates from before the clock was set
# back, and a live worker soon sends another: so a lease that far in the future belongs to a dead worker.
_FROM_LATER = exists(select(workers.c.id).where(workers.c.id == jobs.c.worker, workers.c.seen > now() + JUMP))
ENDED_LEASE = or_(jobs.c.lease_until < now(), _FROM_LATER)
"""Whether the lease of a running job has ended."""
LEFT = and_(jobs.c.state == "running", ENDED_LEASE)
"""Whether a job was abandoned by its worker."""
_DUE = or_(jobs.c.due <= now(), jobs.c.due > now() + MOST_DELAY)

# Each PostgreSQL session skips rows that another has locked; SQLite has one writer at a time and needs no locks.
_CLAIMABLE = (
    select(*JOB_COLUMNS)
    .where(or_(and_(jobs.c.state == "queued", _DUE), LEFT))
    .order_by(jobs.c.priority.desc(), jobs.c.id)
    .limit(1)
)


def require_valid_submission(priority: int, key: str | None, most_attempts: int) -> None:
    """Raise `InputError` for values that no job can have."""
    if not (abs(priority) <= 1000 and 1 <= most_attempts <= 1000):
        raise InputError(
            f"a job must have a priority from -1000 to 1000 and 1 to 1000 attempts; got {priority} and "
            f"{most_attempts}; "
            "choose within these"
        )
    if key is not None and not (0 < len(key) <= 255 and key.isprintable()):
        raise InputError(f"a key must have 1 to 255 printable characters; got {key[:300]!r}; choose another one")


def lock_submissions(connection: Connection) -> None:
    """Wait until no other PostgreSQL session is submitting; SQLite sessions take turns anyway."""
    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK + 1})


def submitted_before(connection: Connection, key: str, tables: Mapping[str, Any]) -> Job | None:
    """Return the job submitted with a key, or None. Raises `InputError` if it differs."""
    row = connection.execute(select(*JOB_COLUMNS, jobs.c.tables).where(jobs.c.key == key)).first()
    if row is None:
        return None
    if json.loads(row.tables) != json.loads(compact_json(tables)):
        raise InputError(
            f"a key may only be used for one job; {key!r} is that of job {row.id}, which differs; use another key"
        )
    return Job.from_row(row, left_out=("tables",))


def require_place_in_queue(connection: Connection, most_queued: int) -> None:
    """Raise `QueueFull` if the maximum number of jobs is waiting."""
    waiting = connection.scalar(select(func.count()).where(jobs.c.state == "queued")) or 0
    if waiting >= most_queued:
        raise QueueFull(f"at most {most_queued} jobs may wait; {waiting} do; wait, or cancel some")


def add_job(
    connection: Connection,
    tables: Mapping[str, Any],
    files: Sequence[Artefact],
    limits: Limits,
    *,
    name: str,
    run: str,
    **values: Any,
) -> int:
    """Insert a queued job and return its number. run: name of its folder, changed if already used."""
    row = {
        "name": database_text(name),
        "run": _free_run_name(connection, run),
        "tables": compact_json(tables),
        "state": "queued",
        "submitted": now(),
        "due": now(),
        "events": 1,
        **dict(zip(LIMITS, astuple(limits), strict=True)),
        **values,
    }
    number = connection.execute(insert(jobs).values(row).returning(jobs.c.id)).scalar_one()
    write_files(connection, number, files)
    add_events(connection, number, 1, [state_event("queued")])
    return int(number)


def claim_changes(worker: str, lease: float) -> dict[str, Any]:
    """Return the changes, apart from the state, to a job that a worker claims for `lease` s."""
    return {
        "attempts": jobs.c.attempts + 1,
        "started": func.coalesce(jobs.c.started, now()),
        "worker": worker,
        "lease_until": later(lease),
        "fence": jobs.c.fence + 1,
        "writes": 0,
    }


def any_claimable(connection: Connection, jumps: ClockJumps, last_full: float) -> bool:
    """Whether any job may be claimed; checked before claiming, so that idle workers do not write.

    jumps: jumps of the database clock. last_full: time when its disk was full, s. No job is claimed shortly after
    either.
    """
    clock_steady = jumps.is_steady(connection.execute(select(now())).scalar_one(), last_full)
    return clock_steady and connection.execute(_CLAIMABLE).first() is not None


def count_running(connection: Connection) -> int:
    """Return the number of jobs held by workers whose lease has not ended."""
    in_hands = and_(jobs.c.state == "running", not_(ENDED_LEASE))
    return connection.scalar(select(func.count()).where(in_hands)) or 0


def claim_next(connection: Connection, worker: str, lease: float) -> Job | None:
    """Give the first job to a worker, highest priority first, then oldest first; None if there is none.

    The job is queued and due, or its lease has expired. Jobs with an expired lease and no attempts left are set aside:
    whatever stopped their workers would stop the next one too.
    """
    while True:
        foremost = connection.execute(_CLAIMABLE.with_for_update(skip_locked=True)).first()
        if foremost is None:
            return None
        if foremost.state == "running" and foremost.attempts >= foremost.most_attempts:
            _fail_abandoned(connection, Job.from_row(foremost))
            continue
        new_events = [state_event("running", f"claimed by {worker}")]
        if foremost.state == "running":
            new_events.insert(0, ("message", {"text": f"the lease of {foremost.worker} ended without a report"}))
        row = connection.execute(
            update(jobs)
            .where(jobs.c.id == foremost.id)
            .values(
                {
                    "state": "running",
                    "reason": "",
                    **claim_changes(worker, lease),
                    "events": jobs.c.events + len(new_events),
                }
            )
            .returning(*JOB_COLUMNS)
        ).one()
        add_events(connection, row.id, row.events, new_events)
        return Job.from_row(row)


def _fail_abandoned(connection: Connection, job: Job) -> None:
    times = "once" if job.attempts == 1 else f"{job.attempts} times in a row"
    end = f"its worker stopped without a report {times}, the last one was {job.worker}"
    left = {"worker": None, "lease_until": None, "finished": now()}
    change_state(connection, job, "failed", f"set aside: {end}; resume it to try again", **left)


def write_files(connection: Connection, job: int, files: Sequence[Artefact]) -> None:
    """Write files of a job, replacing those with the same names."""
    for file in files:
        connection.execute(delete(artefacts).where(artefacts.c.job == job, artefacts.c.name == file.name))
        row = {"name": file.name, "media_type": file.media_type, "content": file.content}
        connection.execute(insert(artefacts).values(job=job, at=now(), **row))


def _free_run_name(connection: Connection, run: str) -> str:
    start = jobs.c.run.startswith(run, autoescape=True)
    used_names = set(connection.execute(select(jobs.c.run).where(start)).scalars())
    return next(
        name for name in (run, *(f"{run}-{i}" for i in range(2, len(used_names) + 3))) if name not in used_names
    )
