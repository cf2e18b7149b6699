"""Designs that people keep of a front: named, noted, starred, one of them decided for."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, and_, delete, func, insert, select, update

from ...model.errors import InputError, NotFound
from .clock import now
from .database import Database
from .rows import the_job
from .schema import kept
from .serialisation import plain

MOST_KEPT = 500
"""Designs that may be kept of a job."""


@dataclass(frozen=True, kw_only=True)
class Bookmark:
    """A kept design. number: among those of its job, from 1. at: when it was kept, s since 1970.

    design: of the front, by its number, that it is or began as; None for neither. variant: of the job's choices.
    dimensions: crank, rod, offset, m, and each varying number, SI. decided: whether it was chosen, at most one of a
    job. reason: why, or why not.
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
    """Return the kept designs of a job, in the order in which they were kept. Raises `NotFound` without the job."""
    with store.reading() as connection:
        the_job(connection, job)
        rows = connection.execute(select(kept).where(kept.c.job == job).order_by(kept.c.number))
        return [_kept(row) for row in rows]


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
    """Keep a design of a job and return it. Raises `NotFound` without the job, `InputError` for one too many.

    name: "Kept 3" and so on if it is empty.
    """
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        count, last = connection.execute(select(func.count(), func.max(kept.c.number)).where(kept.c.job == job)).one()
        if count >= MOST_KEPT:
            raise InputError(f"at most {MOST_KEPT} designs are kept of a job; job {job} has as many; delete some")
        number = (last or 0) + 1
        values = {"name": plain(name) or f"Kept {number}", "note": plain(note), "star": star, "design": design}
        shown = {"variant": variant, "dimensions": json.dumps(dimensions), "decided": False, "reason": ""}
        connection.execute(insert(kept).values(job=job, number=number, at=now(), **values, **shown))
        return _the_kept(connection, job, number)


def change_kept(store: Database, job: int, number: int, **changes: Any) -> Bookmark:
    """Change name, note, star, decided or reason of a kept design and return it; deciding takes it from the others."""
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        _the_kept(connection, job, number)
        if changes.get("decided"):
            connection.execute(update(kept).where(kept.c.job == job).values(decided=False))
        told = {name: plain(value) if isinstance(value, str) else value for name, value in changes.items()}
        if told:
            connection.execute(update(kept).where(_own(job, number)).values(told))
        return _the_kept(connection, job, number)


def drop_kept(store: Database, job: int, number: int) -> None:
    """Delete a kept design. Raises `NotFound`."""
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        _the_kept(connection, job, number)
        connection.execute(delete(kept).where(_own(job, number)))


def _own(job: int, number: int) -> Any:
    return and_(kept.c.job == job, kept.c.number == number)


def _the_kept(connection: Connection, job: int, number: int) -> Bookmark:
    row = connection.execute(select(kept).where(_own(job, number))).first()
    if row is None:
        raise NotFound(f"job {job} has no kept design {number}; see the kept designs of the job")
    return _kept(row)


def _kept(row: Any) -> Bookmark:
    return Bookmark(**{**row._mapping, "dimensions": tuple(json.loads(row.dimensions))})
