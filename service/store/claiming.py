"""Choice of the job that a worker gets next."""

from __future__ import annotations

from sqlalchemy import Connection, and_, exists, func, not_, or_, select, update

from .clock import JUMP, Jumps, now
from .records import SHOWN, Job, job_of
from .rows import add_events, become, state_event
from .schema import jobs, workers
from .submitting import in_hand

MOST_DELAY = 60.0
"""s after which a job is due again at the latest: one that is due later was queued under a clock set back since."""
# Every write of a job is a sign of life of its worker. One in the future was given under a clock set back since, and a
# worker that lives gives another one at once: so the lease, which lies as far in the future, is of one that does not.
_FROM_LATER = exists(select(workers.c.id).where(workers.c.id == jobs.c.worker, workers.c.seen > now() + JUMP))
ENDED_LEASE = or_(jobs.c.lease_until < now(), _FROM_LATER)
"""Whether the lease of a running job has ended."""
_DUE = or_(jobs.c.due <= now(), jobs.c.due > now() + MOST_DELAY)

# Of PostgreSQL's sessions each skips what another has locked; SQLite has one writer at a time and needs no locks.
_CLAIMABLE = (
    select(*SHOWN)
    .where(
        or_(
            and_(jobs.c.state == "queued", _DUE),
            and_(jobs.c.state == "running", ENDED_LEASE),
        )
    )
    .order_by(jobs.c.priority.desc(), jobs.c.id)
    .limit(1)
)


def any_claimable(connection: Connection, jumps: Jumps) -> bool:
    """Whether some job waits for a worker; asked before claiming, so that idle workers do not write.

    jumps: of the database's clock; none is to be claimed soon after one.
    """
    settled = jumps.settled(connection.execute(select(now())).scalar_one())
    return settled and connection.execute(_CLAIMABLE).first() is not None


def running(connection: Connection) -> int:
    """Return how many jobs are in the hands of workers whose lease has not ended."""
    held = and_(jobs.c.state == "running", not_(ENDED_LEASE))
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
            _set_aside(connection, job_of(found))
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


def _set_aside(connection: Connection, job: Job) -> None:
    times = "once" if job.attempts == 1 else f"{job.attempts} times in a row"
    end = f"its worker stopped without a word {times}, the last one was {job.worker}"
    left = {"worker": None, "lease_until": None, "finished": now()}
    become(connection, job, "failed", f"set aside: {end}; resume it to try again", **left)
