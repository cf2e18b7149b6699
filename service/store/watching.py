"""Watch over many jobs at once: news of each, and the waiting time of the queue."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import Connection, and_, func, or_, select

from .clock import now
from .records import ENDED, Event, State, event_of
from .schema import events, jobs

_TOGETHER = 100  # jobs of one query: databases refuse very long ones


@dataclass(frozen=True, kw_only=True)
class News:
    """News of a job. last: the number of its last event, which may come after `events`, as some of them may."""

    state: State
    last: int
    events: list[Event]

    @property
    def over(self) -> bool:
        """Whether the job has ended and these events are all of the rest."""
        return self.state in ENDED and (not self.events or self.events[-1].number == self.last)


def news_of(connection: Connection, after: Mapping[int, int], limit: int) -> dict[int, News]:
    """Return the news of jobs since an event of each; jobs that are gone are left out. See `Store.news`."""
    numbers = list(after)
    news: dict[int, News] = {}
    for start in range(0, len(numbers), _TOGETHER):
        asked = numbers[start : start + _TOGETHER]
        for row in connection.execute(select(jobs.c.id, jobs.c.state, jobs.c.events).where(jobs.c.id.in_(asked))):
            news[row.id] = News(state=row.state, last=row.events, events=[])
        fresh = [
            and_(events.c.job == job, events.c.number > after[job], events.c.number <= after[job] + limit)
            for job in asked
            if job in news and news[job].last > after[job]
        ]
        if fresh:
            query = select(events).where(or_(*fresh)).order_by(events.c.job, events.c.number)
            for row in connection.execute(query):
                news[row.job].events.append(event_of(row))
    return news


def longest_wait(connection: Connection) -> float:
    """Return for how long, in s, the oldest job that may be claimed has been waiting; 0 if none waits."""
    waiting = and_(jobs.c.state == "queued", jobs.c.due <= now())
    return connection.scalar(select(now() - func.min(jobs.c.due)).where(waiting)) or 0.0
