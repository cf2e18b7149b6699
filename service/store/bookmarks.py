"""Bookmarked designs of a front: named, annotated and starred; one may be chosen."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypedDict, Unpack

from sqlalchemy import Connection, and_, delete, insert, select, update

from ...model.errors import InputError, NotFound
from .database import Database
from .database_clock import now
from .job_rows import the_job
from .schema import bookmarks
from .serialisation import plain

MOST_BOOKMARKS = 500
"""Most bookmarks of a job."""
_SAME = 1e-9  # of a dimension: addresses and forms give it with fewer digits


class Remarks(TypedDict, total=False):
    """Words of people about a bookmarked design. decided: revokes the earlier decision of its job."""

    name: str
    note: str
    star: bool
    decided: bool
    reason: str


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

    def is_of(self, variant: int, dimensions: Sequence[float]) -> bool:
        """Whether it is the bookmark of the design with these dimensions, apart from rounding."""
        pairs = zip(self.dimensions, dimensions, strict=True) if variant == self.variant else [(0.0, 1.0)]
        return all(math.isclose(own, other, rel_tol=_SAME, abs_tol=_SAME**2) for own, other in pairs)

    @property
    def decision(self) -> str:
        """The decision for this design in words, with the reason if there is one; empty without a decision."""
        return (f"Decided for {self.name}" + (f": {self.reason}" if self.reason else "")) * self.decided


def bookmarks_of(store: Database, job: int) -> list[Bookmark]:
    """Return the bookmarks of a job, oldest first. Raises `NotFound` without the job."""
    with store.reading() as connection:
        the_job(connection, job)
        return _all_bookmarks(connection, job)


def keep_design(
    store: Database,
    job: int,
    *,
    dimensions: tuple[float, ...],
    variant: int = 0,
    design: int | None = None,
    **remarks: Unpack[Remarks],
) -> Bookmark:
    """Bookmark a design of a job and return it. Raises `NotFound` without the job, `InputError` beyond the limit.

    A design that is bookmarked already keeps its one bookmark, which takes over the remarks that are not empty. A new
    bookmark without a name is "Kept 3" and so on.
    """
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        stored = _all_bookmarks(connection, job)
        known = next((bookmark for bookmark in stored if bookmark.is_of(variant, dimensions)), None)
        number = known.number if known else max((bookmark.number for bookmark in stored), default=0) + 1
        if known is None:
            if len(stored) >= MOST_BOOKMARKS:
                raise InputError(
                    f"at most {MOST_BOOKMARKS} designs can be kept for a job; job {job} has as many; delete some"
                )
            fixed = {"design": design, "variant": variant, "dimensions": json.dumps(dimensions), "at": now()}
            empty = {"name": f"Kept {number}", "note": "", "star": False, "decided": False, "reason": ""}
            connection.execute(insert(bookmarks).values(job=job, number=number, **fixed, **empty))
        return _changed(connection, job, number, {name: value for name, value in remarks.items() if value})


def update_bookmark(store: Database, job: int, number: int, **remarks: Unpack[Remarks]) -> Bookmark:
    """Change name, note, star, decided or reason of a bookmark and return it; only one can be decided."""
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        _the_bookmark(connection, job, number)
        return _changed(connection, job, number, dict(remarks))


def remove_bookmark(store: Database, job: int, number: int) -> None:
    """Delete a bookmark. Raises `NotFound`."""
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        _the_bookmark(connection, job, number)
        connection.execute(delete(bookmarks).where(_is_bookmark(job, number)))


def _changed(connection: Connection, job: int, number: int, remarks: Mapping[str, Any]) -> Bookmark:
    if remarks.get("decided"):
        connection.execute(update(bookmarks).where(bookmarks.c.job == job).values(decided=False))
    values = {name: plain(value) if isinstance(value, str) else value for name, value in remarks.items()}
    if values:
        connection.execute(update(bookmarks).where(_is_bookmark(job, number)).values(values))
    return _the_bookmark(connection, job, number)


def _all_bookmarks(connection: Connection, job: int) -> list[Bookmark]:
    rows = connection.execute(select(bookmarks).where(bookmarks.c.job == job).order_by(bookmarks.c.number))
    return [_bookmark_from(row) for row in rows]


def _is_bookmark(job: int, number: int) -> Any:
    return and_(bookmarks.c.job == job, bookmarks.c.number == number)


def _the_bookmark(connection: Connection, job: int, number: int) -> Bookmark:
    row = connection.execute(select(bookmarks).where(_is_bookmark(job, number))).first()
    if row is None:
        raise NotFound(f"job {job} has no kept design {number}; see the kept designs of the job")
    return _bookmark_from(row)


def _bookmark_from(row: Any) -> Bookmark:
    return Bookmark(**{**row._mapping, "dimensions": tuple(json.loads(row.dimensions))})
