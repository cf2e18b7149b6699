"""Records read from the store: jobs, limits, events, files and workers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import astuple, dataclass
from typing import Any, Literal, TypedDict

from sqlalchemy import Row as Found
from sqlalchemy import select

from ...model.errors import InputError
from ...objectives.kinds import count_with_noun
from .schema import bookmarks, jobs

State = Literal["queued", "running", "done", "infeasible", "cancelled", "failed"]
ENDED: tuple[State, ...] = ("done", "infeasible", "cancelled", "failed")
RESUMABLE: tuple[State, ...] = ("cancelled", "failed")
LIMITS = ("most_seconds", "most_evaluations", "most_memory")
NOT_DONE = "cancelled before it was done"
_DECISIONS = select(bookmarks.c.name).where(bookmarks.c.job == jobs.c.id, bookmarks.c.decided).limit(1)
DECISION = _DECISIONS.correlate(jobs).scalar_subquery()
"""Name of the chosen design of a job."""
JOB_COLUMNS = (
    *(column for column in jobs.c if column.name not in ("tables", "result", "checksum")),
    DECISION.label("decision"),
)
"""Columns for a list of jobs: all but the long ones, and the name of the chosen design."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits of a job on time, evaluations and memory; None means no limit.

    seconds, evaluations: limits of its search, which then ends with its result so far, as if cancelled. memory: limit
    of its worker, bytes; if exceeded, the job fails.
    """

    seconds: float | None = None
    evaluations: int | None = None
    memory: int | None = None

    def __post_init__(self) -> None:
        for (name, value), unit in zip(vars(self).items(), ("s", "designs", "bytes"), strict=True):
            if value is not None and not 0.0 < value < 2.0**53:
                raise InputError(
                    f"a limit on {name} must be a positive number of {unit}; got {value}; leave it out for no limit"
                )

    def stricter(self, ceiling: Limits) -> Limits:
        """Return the stricter of each pair of limits."""
        pairs = zip(astuple(self), astuple(ceiling), strict=True)
        seconds, evaluations, memory = (
            min((limit for limit in pair if limit is not None), default=None) for pair in pairs
        )
        return Limits(seconds=seconds, evaluations=evaluations, memory=memory)


NO_LIMITS = Limits()


class Queueing(TypedDict, total=False):
    """Queue settings of a job.

    priority: higher ones are claimed first, default 0. key: key of this submission; repeating an earlier key queues
    nothing and returns the earlier job. most_attempts: number of attempts without progress before it is set aside,
    default `store.MOST_ATTEMPTS`.
    """

    priority: int
    key: str | None
    most_attempts: int


@dataclass(frozen=True, kw_only=True)
class Job:
    """State of a job. Times are in seconds since 1970 on the clock of the database.

    run: name of its run folder, wherever it is exported. state: queued, running, done, infeasible (no design meets its
    requirements), cancelled, or failed: set aside and not retried until someone resumes it. reason: why it is in this
    state, in a sentence, or empty. attempts: attempts since its last new record. due: earliest time of a claim. worker,
    lease_until: worker and end of lease of a running job. records: number of records to continue from. events: number
    of events. progress: fields of the latest `Progress`, or None; includes `front` if the search reported one, see
    `Claim.report`. summary: summary of its result, see `result_summary`, or None. origin: number of the job
    from which it was copied, or None. decision: name of the chosen design, or None.
    """

    id: int
    key: str | None
    name: str
    run: str
    state: State
    reason: str
    priority: int
    attempts: int
    most_attempts: int
    limits: Limits
    cancel_asked: bool
    submitted: float
    due: float
    started: float | None
    finished: float | None
    worker: str | None
    lease_until: float | None
    fence: int
    records: int
    events: int
    progress: dict[str, Any] | None
    summary: dict[str, Any] | None
    origin: int | None = None
    decision: str | None = None

    @classmethod
    def from_row(cls, row: Found[*tuple[Any, ...]], *, left_out: Sequence[str] = ()) -> Job:
        """Return a job from a row with the columns `JOB_COLUMNS`; other columns are ignored."""
        from pydantic_core import from_json  # takes a quarter of the time of the `json` module

        values = dict(row._mapping)
        for name in ("writes", *left_out):
            del values[name]
        for name in ("progress", "summary"):
            values[name] = None if values[name] is None else from_json(values[name])
        seconds, evaluations, memory = (values.pop(name) for name in LIMITS)
        return cls(**values, limits=Limits(seconds=seconds, evaluations=evaluations, memory=memory))

    def record(self) -> dict[str, Any]:
        """Return the job as JSON, the same in all interfaces: times in seconds since 1970, memory in bytes."""
        # `asdict` is not used: its copies would take most of the time needed for a list.
        record = {name: value for name, value in vars(self).items() if name not in ("fence", "limits")}
        seconds, evaluations, memory = self.limits.seconds, self.limits.evaluations, self.limits.memory
        record["limits"] = {"seconds": seconds, "evaluations": evaluations, "memory_bytes": memory}
        if self.progress is not None:
            record["progress"] = {"step": 0, "steps": 0, **self.progress, "front": self.progress.get("front")}
        return record

    def front_points(self) -> dict[str, Any]:
        """Return the columns of at most two objectives, and the points of at most 64 designs of its front.

        Both are empty if no front is known.
        """
        if self.summary is not None and self.summary["points"]:
            return {"columns": self.summary["axes"], "points": self.summary["points"]}
        front = (self.progress or {}).get("front") or {"columns": [], "points": []}
        return {"columns": front["columns"][:2], "points": [point[:2] for point in front["points"]]}


@dataclass(frozen=True, kw_only=True)
class Event:
    """Event in the life of a job. kind: "state", "progress" or "message"; data: its content as JSON."""

    job: int
    number: int
    at: float
    kind: str
    data: dict[str, Any]

    @classmethod
    def from_row(cls, row: Found[*tuple[Any, ...]]) -> Event:
        """Return an event from its row."""
        return cls(**{**row._mapping, "data": json.loads(row.data)})

    def record(self) -> dict[str, Any]:
        """Return the event as JSON."""
        return {"number": self.number, "at": self.at, "kind": self.kind, "data": self.data}


@dataclass(frozen=True, kw_only=True)
class News:
    """News of a job. last_number: number of its last event, which may come after `events` if these are truncated."""

    state: State
    last_number: int
    events: list[Event]

    @property
    def is_over(self) -> bool:
        """Whether the job has ended and these are all its remaining events."""
        return self.state in ENDED and (not self.events or self.events[-1].number == self.last_number)


@dataclass(frozen=True, kw_only=True)
class Artefact:
    """File of a job."""

    name: str
    media_type: str
    content: bytes


SILENT = 120.0
"""s; a worker with the default lease sends a heartbeat every 10 s."""


@dataclass(frozen=True, kw_only=True)
class Worker:
    """Worker that solves jobs.

    started, seen: times of its start and of its last heartbeat. silent: time since `seen`, s. busy: whether it has a
    job.
    """

    id: str
    started: float
    seen: float
    silent: float
    busy: bool

    @property
    def at_work(self) -> bool:
        """Whether it sent a recent heartbeat."""
        return self.silent <= SILENT


@dataclass(frozen=True, kw_only=True)
class Crew:
    """Workers of a store and the jobs that wait for them.

    workers: number of workers with a recent heartbeat. busy: number of those with a job. waiting: number of jobs
    without a worker.
    """

    workers: int
    busy: int
    waiting: int

    def __str__(self) -> str:
        """Summary in one line."""
        left = f"{self.waiting} waiting"
        if not self.workers:
            return f"no worker, {left}: start one with slidercrank worker"
        return f"{count_with_noun(self.workers, 'worker')}, {self.busy} busy, {left}"
