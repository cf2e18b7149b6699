"""History of the bookmarks of a job: notes, reasons, decisions and deletions, each with author and time."""

from collections.abc import Iterator, Mapping
from typing import Any

from sqlalchemy import Connection, and_, delete, func, insert, select, update

from .bookmark import Action, Bookmark, HistoryEntry
from .database import Database
from .database_clock import now
from .job_rows import job_by_number
from .schema import history
from .serialisation import database_text

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
