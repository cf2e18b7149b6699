"""Which job a worker gets next."""

from __future__ import annotations

from sqlalchemy import Connection, and_, func, or_, select, update

from .clock import now
from .events_log import add_events, state_event
from .records import SHOWN, Job, job_of
from .schema import jobs
from .submitting import in_hand

# Of PostgreSQL's sessions each skips what another has locked; SQLite has one writer at a time and needs no locks.
_CLAIMABLE = (
    select(jobs.c.id, jobs.c.state, jobs.c.attempts, jobs.c.most_attempts, jobs.c.worker)
    .where(
        or_(
            and_(jobs.c.state == "queued", jobs.c.due <= now()),
            and_(jobs.c.state == "running", jobs.c.lease_until < now()),
        )
    )
    .order_by(jobs.c.priority.desc(), jobs.c.id)
    .limit(1)
)


def any_claimable(connection: Connection) -> bool:
    """Whether some job waits for a worker; asked before claiming, so that idle workers do not write."""
    return connection.execute(_CLAIMABLE).first() is not None


def running(connection: Connection) -> int:
    """Return how many jobs are in the hands of workers whose lease has not ended."""
    held = and_(jobs.c.state == "running", jobs.c.lease_until >= now())
    return connection.scalar(select(func.count()).where(held)) or 0


def claim_next(connection: Connection, worker: str, lease: float) -> Job | None:
    """Give the foremost job to a worker, highest priority first, then oldest first; None if there is none.

    It is queued and due, or its lease has ended without a word. Of the latter those without an attempt left are set
    aside: whatever stopped their workers would stop the next one too.
    """
    while True:
        found = connection.execute(_CLAIMABLE.with_for_update(skip_locked=True)).first()
        if found is None:
            return None
        if found.state == "running" and found.attempts >= found.most_attempts:
            _set_aside(connection, found.id, found.attempts, found.worker)
            continue
        told = [state_event("running", f"claimed by {worker}")]
        if found.state == "running":
            told.insert(0, ("message", {"text": f"the lease of {found.worker} ended without a word"}))
        row = connection.execute(
            update(jobs)
            .where(jobs.c.id == found.id)
            .values({"state": "running", "reason": "", **in_hand(worker, lease), "events": jobs.c.events + len(told)})
            .returning(*SHOWN)
        ).one()
        add_events(connection, row.id, row.events, told)
        return job_of(row)


def _set_aside(connection: Connection, job: int, attempts: int, worker: str) -> None:
    times = "once" if attempts == 1 else f"{attempts} times in a row"
    reason = f"set aside: its worker stopped without a word {times}, the last one was {worker}; resume it to try again"
    last = connection.execute(
        update(jobs)
        .where(jobs.c.id == job)
        .values(
            state="failed",
            reason=reason,
            worker=None,
            lease_until=None,
            finished=now(),
            events=jobs.c.events + 1,
        )
        .returning(jobs.c.events)
    ).scalar_one()
    add_events(connection, job, last, [state_event("failed", reason)])
