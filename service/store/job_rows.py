"""Jobs within a transaction: reading rows and news, sorting lists, changing states, adding events."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, get_args

from sqlalchemy import Connection, Select, and_, case, func, insert, or_, select, update

from ...model.errors import InputError, NotFound, RunError
from .database_clock import now
from .records import DECISION, JOB_COLUMNS, RESUMABLE, Event, Job, News, State
from .schema import events, jobs, records
from .serialisation import checksum, compact_json, unpacked_record

if TYPE_CHECKING:
    from ...optimise.search.checkpoints import Record

NewEvent = tuple[str, Mapping[str, Any]]
"""Kind and data of an event."""
_TOGETHER = 100  # jobs per query: databases reject very long ones


def job_by_number(connection: Connection, number: int, *, lock: bool = False) -> Job:
    """Return a job, locked for the transaction on request. Raises `NotFound` if it does not exist."""
    query = select(*JOB_COLUMNS).where(jobs.c.id == number)
    row = connection.execute(query.with_for_update() if lock else query).first() if 0 < number < 2**63 else None
    if row is None:
        raise NotFound(f"there is no job {number}; list the jobs")
    return Job.from_row(row)


def change_state(connection: Connection, job: Job, state: State, reason: str, **changes: Any) -> Job:
    """Change the state of a job, add the event, and return the job."""
    values = {"state": state, "reason": reason, "events": job.events + 1, **changes}
    connection.execute(update(jobs).where(jobs.c.id == job.id).values(values))
    add_events(connection, job.id, job.events + 1, [state_event(state, reason)])
    return job_by_number(connection, job.id)


def require_resumable(job: Job) -> None:
    """Raise `InputError` for a job that cannot be resumed."""
    if job.state not in RESUMABLE:
        raise InputError(f"only a cancelled or failed job can continue; job {job.id} is {job.state}; submit it again")


def result_record(connection: Connection, job: Job) -> tuple[dict[str, Any], str]:
    """Return the record of a job's result, and the checksum of its designs, empty if there is none.

    Raises `RunError` if the result is missing or damaged.
    """
    query = select(jobs.c.tables, jobs.c.result, jobs.c.summary, jobs.c.checksum).where(jobs.c.id == job.id)
    tables, text, summary, sums = connection.execute(query).one()
    if text is None:
        raise RunError(f"job {job.id} has no result: it is {job.state}; wait for it, or see its events")
    try:
        require_checksum((sums or "")[:64], tables, text, summary)
        record = json.loads(text)
    except ValueError as error:
        raise damaged_result_error(job.id, error) from error
    if not isinstance(record, dict):
        raise damaged_result_error(job.id, TypeError("no record"))
    return record, (sums or "")[64:]


def require_checksum(expected: str, *parts: str | bytes | None) -> None:
    """Raise ValueError if parts of a result do not match their checksum; an empty checksum is not checked."""
    if expected and checksum(*parts) != expected:
        raise ValueError("it differs from its checksum, so its numbers may be wrong")


def evaluation_records(connection: Connection, number: int) -> list[Record]:
    """Return the records of a job's evaluations so far, in order."""
    query = select(records.c.content).where(records.c.job == number).order_by(records.c.number)
    return [unpacked_record(content) for content in connection.execute(query).scalars()]


def damaged_result_error(number: int, error: Exception) -> RunError:
    """Return the error for an unreadable result."""
    return RunError(f"the result of job {number} is damaged: {type(error).__name__}: {error}; submit the job again")


def add_events(connection: Connection, job: int, last: int, new_events: Sequence[NewEvent]) -> None:
    """Add events to a job whose row was updated in this transaction; the last event gets the number `last`."""
    for number, (kind, data) in enumerate(new_events, last - len(new_events) + 1):
        row = {"job": job, "number": number, "at": now(), "kind": kind, "data": compact_json(data)}
        connection.execute(insert(events).values(row))


def state_event(state: str, reason: str = "") -> NewEvent:
    """Return the event for a new state of a job."""
    return "state", {"state": state, "reason": reason}


def news_of(connection: Connection, after: Mapping[int, int], limit: int) -> dict[int, News]:
    """Return the news of jobs since a given event of each; deleted jobs are omitted. See `Store.news`."""
    numbers = list(after)
    news: dict[int, News] = {}
    for start in range(0, len(numbers), _TOGETHER):
        batch = numbers[start : start + _TOGETHER]
        for row in connection.execute(select(jobs.c.id, jobs.c.state, jobs.c.events).where(jobs.c.id.in_(batch))):
            news[row.id] = News(state=row.state, last_number=row.events, events=[])
        fresh = [
            and_(events.c.job == job, events.c.number > after[job], events.c.number <= after[job] + limit)
            for job in batch
            if job in news and news[job].last_number > after[job]
        ]
        if fresh:
            query = select(events).where(or_(*fresh)).order_by(events.c.job, events.c.number)
            for row in connection.execute(query):
                news[row.job].events.append(Event.from_row(row))
    return news


Order = Literal["newest", "oldest", "name", "state", "decided"]
"""Order of a list of jobs. state: waiting and running jobs first. decided: jobs with a decision first."""

_KEYS: dict[Order, Any] = {
    "oldest": jobs.c.id,
    "name": func.lower(jobs.c.name),
    "state": case({state: place for place, state in enumerate(get_args(State))}, value=jobs.c.state),
    "decided": case((DECISION.is_(None), 1), else_=0),
}


def ordered_jobs(query: Select[Any], order: Order, before: int | None) -> Select[Any]:
    """Return a query for jobs in an order; jobs with equal keys are sorted newest first.

    before: number of a job; only jobs after it in this order, for paging. None for all.
    """
    key = _KEYS.get(order)
    if key is None:
        ordered = query.order_by(jobs.c.id.desc())
        return ordered if before is None else ordered.where(jobs.c.id < before)
    ordered = query.order_by(key, jobs.c.id.desc())
    if before is None:
        return ordered
    last = select(key).where(jobs.c.id == before).correlate(None).scalar_subquery()
    return ordered.where(or_(key > last, and_(key == last, jobs.c.id < before)))
