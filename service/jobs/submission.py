"""A job on its way into the store: read and checked before it is queued."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from ..runs.result import json_text
from ..store import MOST_ATTEMPTS, NO_LIMITS, Artefact, Job, Limits, Store
from .allowed_quantities import parse_allowed


def submit(
    store: Store,
    tables: Mapping[str, Any],
    *,
    priority: int = 0,
    key: str | None = None,
    most_attempts: int = MOST_ATTEMPTS,
    limits: Limits = NO_LIMITS,
    source: Artefact | None = None,
    allowed_quantities: Collection[str] = (),
    checked: str | None = None,
) -> Job:
    """Queue a job given as the tables of a job file, and return it; see `Store.submit` for the rest.

    source: the job file as it was given, "job.toml" or "job.json"; without one it is made from the tables.
    allowed_quantities: functions, "module:function", that the job may name as quantities. checked: the name of a job
    that was checked already.

    Raises `JobError` for a job that is not valid, or that names other functions.
    """
    return store.submit(
        tables,
        name=checked or parse_allowed(tables, allowed_quantities).name,
        priority=priority,
        key=key,
        most_attempts=most_attempts,
        limits=limits,
        files=[source or job_json(tables)],
    )


def job_json(tables: Mapping[str, Any]) -> Artefact:
    """Return the file "job.json" of a job given by its tables."""
    return Artefact(name="job.json", media_type="application/json", content=json_text(tables).encode())
