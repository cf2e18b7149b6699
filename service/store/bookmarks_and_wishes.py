"""Remarks of people on the front of a job: bookmarked designs with their decisions and history, and wishes."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, TypedDict, Unpack

from sqlalchemy import Connection, and_, delete, func, insert, select, update

from ...model.errors import InputError, NotFound
from .bookmark import Action, Bookmark, HistoryEntry
from .database import Database
from .database_clock import now
from .job_rows import job_by_number
from .schema import bookmarks, history, wishes
from .serialisation import database_text

MOST_BOOKMARKS = 500
"""Maximum number of bookmarks per job."""
MOST_WISHES = 50
"""Maximum number of wishes kept per job; the oldest are dropped."""
Wished = Mapping[str, tuple[str, float | None]]
"""Wishes by objective: kind, and value if the kind has one, in the metric unit of the objective."""


class Remarks(TypedDict, total=False):
    """Remarks on a bookmarked design. decided: revokes the earlier decision of its job. author: who makes them."""

    name: str
    note: str
    star: bool
    decided: bool
    reason: str
    author: str


def bookmarks_of(store: Database, job: int) -> list[Bookmark]:
    """Return the bookmarks of a job, oldest first. Raises `NotFound` for a missing job."""
    with store.reading() as connection:
        job_by_number(connection, job)
        history = entries_of(connection, job)
        return [
            replace(bookmark, history=tuple(entry for entry in history if entry.bookmark == bookmark.number))
            for bookmark in _all_bookmarks(connection, job)
        ]


def bookmark_design(
    store: Database,
    job: int,
    *,
    dimensions: tuple[float, ...],
    variant: int = 0,
    design: int | None = None,
    allowed: Mapping[str, float] = MappingProxyType({}),
    **remarks: Unpack[Remarks],
) -> Bookmark:
    """Bookmark a design of a job and return it, without its history. Raises `NotFound`, `InputError` beyond the limit.

    A design has at most one bookmark: if it exists, it takes over the remarks that are not empty. A new bookmark
    without a name is called "Kept 3" and so on. allowed: allowed deviations from requirements, by column.
    """
    with store.writing() as connection:
        job_by_number(connection, job, lock=True)
        stored = _all_bookmarks(connection, job)
        known = next((bookmark for bookmark in stored if bookmark.is_of(variant, dimensions)), None)
        number = known.number if known else max((bookmark.number for bookmark in stored), default=0) + 1
        if known is None:
            if len(stored) >= MOST_BOOKMARKS:
                raise InputError(
                    f"a job may have at most {MOST_BOOKMARKS} bookmarks; job {job} has that many; delete some"
                )
            fixed = {"design": design, "variant": variant, "dimensions": json.dumps(dimensions), "at": now()}
            empty = {"name": f"Kept {number}", "note": "", "star": False, "decided": False, "reason": ""}
            connection.execute(insert(bookmarks).values(job=job, number=number, **fixed, **empty))
        given = {**remarks, "allowed": json.dumps({**allowed}) if allowed else ""}
        return _change_bookmark(connection, job, number, {name: value for name, value in given.items() if value})


def update_bookmark(store: Database, job: int, number: int, **remarks: Unpack[Remarks]) -> Bookmark:
    """Change a bookmark and return it, without its history; only one can be decided."""
    with store.writing() as connection:
        job_by_number(connection, job, lock=True)
        return _change_bookmark(connection, job, number, dict(remarks))


def remove_bookmark(store: Database, job: int, number: int, author: str = "") -> None:
    """Delete a bookmark. Raises `NotFound`."""
    with store.writing() as connection:
        job_by_number(connection, job, lock=True)
        record_deletion(connection, _bookmark_by_number(connection, job, number), author)
        connection.execute(delete(bookmarks).where(_is_row_of_bookmark(job, number)))


def _change_bookmark(connection: Connection, job: int, number: int, remarks: Mapping[str, Any]) -> Bookmark:
    before = _bookmark_by_number(connection, job, number)
    if remarks.get("decided"):
        connection.execute(update(bookmarks).where(bookmarks.c.job == job).values(decided=False))
    values = {name: database_text(value) if isinstance(value, str) else value for name, value in remarks.items()}
    author = values.pop("author", "")
    if values:
        connection.execute(update(bookmarks).where(_is_row_of_bookmark(job, number)).values(values))
    after = _bookmark_by_number(connection, job, number)
    record_changes(connection, before, after, author)
    return after


def _all_bookmarks(connection: Connection, job: int) -> list[Bookmark]:
    rows = connection.execute(select(bookmarks).where(bookmarks.c.job == job).order_by(bookmarks.c.number))
    return [_bookmark_from(row) for row in rows]


def _is_row_of_bookmark(job: int, number: int) -> Any:
    return and_(bookmarks.c.job == job, bookmarks.c.number == number)


def _bookmark_by_number(connection: Connection, job: int, number: int) -> Bookmark:
    row = connection.execute(select(bookmarks).where(_is_row_of_bookmark(job, number))).first()
    if row is None:
        raise NotFound(f"job {job} has no bookmark {number}; see the bookmarks of the job")
    return _bookmark_from(row)


def _bookmark_from(row: Any) -> Bookmark:
    dimensions, allowed = tuple(json.loads(row.dimensions)), json.loads(row.allowed)
    return Bookmark(**{**row._mapping, "dimensions": dimensions, "allowed": allowed})


@dataclass(frozen=True, kw_only=True)
class MadeWish:
    """Recorded wish.

    number: number within its job. design: reference design of the classes. time: s since 1970, UTC.
    """

    number: int
    wishes: Wished
    design: int | None
    time: float


def wishes_of(store: Database, job: int) -> list[MadeWish]:
    """Return the wishes recorded for a job, newest first. Raises `NotFound` for a missing job."""
    with store.reading() as connection:
        job_by_number(connection, job)
        rows = connection.execute(select(wishes).where(wishes.c.job == job).order_by(wishes.c.number.desc()))
        return [
            MadeWish(
                number=row.number,
                wishes={name: (str(kind), value) for name, (kind, value) in json.loads(row.wishes).items()},
                design=row.design,
                time=row.at,
            )
            for row in rows
        ]


def note_wish(store: Database, job: int, stated: Wished, design: int | None) -> None:
    """Record a wish for the front of a job as the latest, replacing an identical earlier one."""
    text = json.dumps({name: list(wish) for name, wish in sorted(stated.items())})
    with store.writing() as connection:
        job_by_number(connection, job, lock=True)
        of_job = wishes.c.job == job
        last = connection.execute(select(func.max(wishes.c.number)).where(of_job)).scalar() or 0
        same = and_(wishes.c.wishes == text, wishes.c.design.is_(None) if design is None else wishes.c.design == design)
        connection.execute(delete(wishes).where(of_job, same))
        newest = select(wishes.c.number).where(of_job).order_by(wishes.c.number.desc()).limit(1).offset(MOST_WISHES - 2)
        oldest = connection.execute(newest).scalar()
        if oldest is not None:
            connection.execute(delete(wishes).where(of_job, wishes.c.number < oldest))
        connection.execute(insert(wishes).values(job=job, number=last + 1, wishes=text, design=design, at=now()))


MOST_ENTRIES = 1000
"""Maximum number of entries kept per job; the oldest are dropped."""


def history_of(store: Database, job: int) -> list[HistoryEntry]:
    """Return the history of the bookmarks of a job, oldest first. Raises `NotFound` for a missing job."""
    with store.reading() as connection:
        job_by_number(connection, job)
        return entries_of(connection, job)


def entries_of(connection: Connection, job: int) -> list[HistoryEntry]:
    """Return the entries of a job, oldest first."""
    columns = [column for column in history.c if column is not history.c.job]
    rows = connection.execute(select(*columns).where(history.c.job == job).order_by(history.c.number))
    return [HistoryEntry(**row._mapping) for row in rows]


def record_changes(connection: Connection, before: Bookmark, after: Bookmark, author: str) -> None:
    """Record the differences between two versions of a bookmark."""
    for action, text in _actions(before, after):
        _record(connection, after, action, text, author)


def record_deletion(connection: Connection, bookmark: Bookmark, author: str) -> None:
    """Record that a bookmark was deleted, and detach its entries: a later bookmark may get its number."""
    _record(connection, bookmark, "deleted", "", author)
    of_bookmark = and_(history.c.job == bookmark.job, history.c.bookmark == bookmark.number)
    connection.execute(update(history).where(of_bookmark).values(bookmark=None))


def _actions(before: Bookmark, after: Bookmark) -> Iterator[tuple[Action, str]]:
    if after.note != before.note:
        yield "note", after.note
    if after.decided and (not before.decided or after.reason != before.reason):
        yield "decided", after.reason
    elif after.reason != before.reason:
        yield "reason", after.reason
    if before.decided and not after.decided:
        yield "withdrawn", ""


def _record(connection: Connection, bookmark: Bookmark, action: Action, text: str, author: str) -> None:
    of_job = history.c.job == bookmark.job
    number = (connection.execute(select(func.max(history.c.number)).where(of_job)).scalar() or 0) + 1
    values: Mapping[str, Any] = {"job": bookmark.job, "number": number, "bookmark": bookmark.number, "at": now()}
    words = {"name": bookmark.name, "action": action, "text": text, "author": database_text(author)}
    connection.execute(insert(history).values({**values, **words}))
    connection.execute(delete(history).where(of_job, history.c.number <= number - MOST_ENTRIES))
