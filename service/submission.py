"""A job on its way into the store: read and checked before it is queued."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .store import MOST_ATTEMPTS, Job, Store


def submit(
    store: Store,
    tables: Mapping[str, Any],
    *,
    priority: int = 0,
    key: str | None = None,
    most_attempts: int = MOST_ATTEMPTS,
    most_seconds: float | None = None,
) -> Job:
    """Queue a job given as the tables of a job file, and return it; see `Store.submit` for the rest.

    Raises `JobError` for a job that is not valid, or that names functions of its own: workers do not run those of
    others.
    """
    from ..optimise.job import parse_job

    problem = parse_job(tables, allow_user_code=False)
    return store.submit(
        tables,
        name=problem.name,
        priority=priority,
        key=key,
        most_attempts=most_attempts,
        most_seconds=most_seconds,
    )
