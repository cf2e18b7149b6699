"""Bookmarked designs of a front: named, annotated and starred; one may be chosen."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, and_, delete, func, insert, select, update

from ...model.errors import InputError, NotFound
from .clock import now
from .database import Database
from .rows import the_job
from .schema import bookmarks
from .serialisation import plain

MOST_BOOKMARKS = 500
"""Most bookmarks of a job."""


@dataclass(frozen=True, kw_only=True)
class Bookmark:
    """A bookmarked design. number: number within its job, from 1. at: time of bookmarking, s since 1970.

    design: number of the design of the front that it is or began as; None for neither. variant: variant of the job's
    choices. dimensions: crank, rod, offset, m, and each extra variable, SI. decided: whether it was chosen, at most one
    per job. reason: reason for or against it.
    """

    job: int
    number: int
    name: str
    note: str
    star: bool
    decided: bool
    reason: str
    design: int | None
    variant: int
    dimensions: tuple[float, ...]
    at: float


def bookmarks_of(store: Database, job: int) -> list[Bookmark]:
    """Return the bookmarks of a job, oldest first. Raises `NotFound` without the job."""
    with store.reading() as connection:
        the_job(connection, job)
        rows = connection.execute(select(bookmarks).where(bookmarks.c.job == job).order_by(bookmarks.c.number))
        return [_bookmark_from(row) for row in rows]


def keep_design(
    store: Database,
    job: int,
    *,
    dimensions: tuple[float, ...],
    variant: int = 0,
    design: int | None = None,
    name: str = "",
    note: str = "",
    star: bool = False,
) -> Bookmark:
    """Bookmark a design of a job and return it. Raises `NotFound` without the job, `InputError` beyond the limit.

    name: "Kept 3" and so on if it is empty.
    """
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        count, last = connection.execute(
            select(func.count(), func.max(bookmarks.c.number)).where(bookmarks.c.job == job)
        ).one()
        if count >= MOST_BOOKMARKS:
            raise InputError(f"at most {MOST_BOOKMARKS} designs are kept of a job; job {job} has as many; delete some")
        number = (last or 0) + 1
        values = {"name": plain(name) or f"Kept {number}", "note": plain(note), "star": star, "design": design}
        fixed = {"variant": variant, "dimensions": json.dumps(dimensions), "decided": False, "reason": ""}
        connection.execute(insert(bookmarks).values(job=job, number=number, at=now(), **values, **fixed))
        return _the_bookmark(connection, job, number)


def change_kept(store: Database, job: int, number: int, **changes: Any) -> Bookmark:
    """Change name, note, star, decided or reason of a bookmark and return it; only one can be decided."""
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        _the_bookmark(connection, job, number)
        if changes.get("decided"):
            connection.execute(update(bookmarks).where(bookmarks.c.job == job).values(decided=False))
        values = {name: plain(value) if isinstance(value, str) else value for name, value in changes.items()}
        if values:
            connection.execute(update(bookmarks).where(_is_bookmark(job, number)).values(values))
        return _the_bookmark(connection, job, number)


def drop_kept(store: Database, job: int, number: int) -> None:
    """Delete a bookmark. Raises `NotFound`."""
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        _the_bookmark(connection, job, number)
        connection.execute(delete(bookmarks).where(_is_bookmark(job, number)))


def _is_bookmark(job: int, number: int) -> Any:
    return and_(bookmarks.c.job == job, bookmarks.c.number == number)


def _the_bookmark(connection: Connection, job: int, number: int) -> Bookmark:
    row = connection.execute(select(bookmarks).where(_is_bookmark(job, number))).first()
    if row is None:
        raise NotFound(f"job {job} has no kept design {number}; see the kept designs of the job")
    return _bookmark_from(row)


def _bookmark_from(row: Any) -> Bookmark:
    return Bookmark(**{**row._mapping, "dimensions": tuple(json.loads(row.dimensions))})
