"""Wishes that people made on the front of a job: the latest ones, each once."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import and_, delete, func, insert, select

from .database import Database
from .database_clock import now
from .job_rows import the_job
from .schema import wishes

MOST_WISHES = 50
"""Wishes that are kept of a job; the oldest go first."""
Wished = Mapping[str, tuple[str, float | None]]
"""Wishes by objective: the kind, and the value of one that has a value, in the metric unit of the objective."""


@dataclass(frozen=True, kw_only=True)
class MadeWish:
    """A recorded wish. number: number within its job. design: design that classes refer to. time: s since 1970, UTC."""

    number: int
    wishes: Wished
    design: int | None
    time: float


def wishes_of(store: Database, job: int) -> list[MadeWish]:
    """Return the wishes made on a job, the latest first. Raises `NotFound` without the job."""
    with store.reading() as connection:
        the_job(connection, job)
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
    """Record a wish on the front of a job as the latest, replacing an identical earlier one."""
    text = json.dumps({name: list(wish) for name, wish in sorted(stated.items())})
    with store.writing() as connection:
        the_job(connection, job, lock=True)
        of_job = wishes.c.job == job
        last = connection.execute(select(func.max(wishes.c.number)).where(of_job)).scalar() or 0
        same = and_(wishes.c.wishes == text, wishes.c.design.is_(None) if design is None else wishes.c.design == design)
        connection.execute(delete(wishes).where(of_job, same))
        newest = select(wishes.c.number).where(of_job).order_by(wishes.c.number.desc()).limit(1).offset(MOST_WISHES - 2)
        oldest = connection.execute(newest).scalar()
        if oldest is not None:
            connection.execute(delete(wishes).where(of_job, wishes.c.number < oldest))
        connection.execute(insert(wishes).values(job=job, number=last + 1, wishes=text, design=design, at=now()))
