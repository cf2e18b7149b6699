"""What is read from the store."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Literal

from sqlalchemy import Row as Found

from .schema import jobs

State = Literal["queued", "running", "done", "infeasible", "cancelled", "failed"]
ENDED: tuple[State, ...] = ("done", "infeasible", "cancelled", "failed")
RESUMABLE: tuple[State, ...] = ("cancelled", "failed")
SHOWN = tuple(column for column in jobs.c if column.name not in ("tables", "result"))
"""Columns of a list of jobs: all but the long ones."""


@dataclass(frozen=True, kw_only=True)
class Job:
    """Where a job stands. Times are seconds since 1970 on the clock of the database.

    state: queued, running, done, infeasible (nothing can meet its rules), cancelled, or failed: set aside, not tried
    again unless someone resumes it. reason: why it is in this state, in a sentence, or empty. attempts: since it last
    went forward by a generation. most_seconds: how long its search may take, if there is a limit. due: it is not
    claimed before. worker, lease_until: of a running one. generations: how many it can go on from. events: how many
    there are. progress: fields of the latest `Progress`, or None.
    """

    id: int
    key: str | None
    name: str
    state: State
    reason: str
    priority: int
    attempts: int
    most_attempts: int
    most_seconds: float | None
    cancel_asked: bool
    submitted: float
    due: float
    started: float | None
    finished: float | None
    worker: str | None
    lease_until: float | None
    fence: int
    generations: int
    events: int
    progress: dict[str, Any] | None


@dataclass(frozen=True, kw_only=True)
class Event:
    """Something that happened to a job. kind: "state", "progress" or "message"; data: what, as JSON has it."""

    job: int
    number: int
    at: float
    kind: str
    data: dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Artefact:
    """A file of a job."""

    name: str
    media_type: str
    content: bytes


@dataclass(frozen=True, kw_only=True)
class Worker:
    """Who solves jobs. started, seen: when it began, and when it was heard of last. silent: seconds since then."""

    id: str
    started: float
    seen: float
    silent: float


def job_of(row: Found[Any]) -> Job:
    """Return a job from a row of the columns `SHOWN`."""
    found = dict(row._mapping)
    del found["writes"]
    found["progress"] = None if found["progress"] is None else json.loads(found["progress"])
    return Job(**found)
