"""Events of jobs for many streams at once: one task looks them up and wakes the streams that wait.

A stream never holds a thread while it waits, and never misses an event: it knows the number of the last one it sent,
takes what follows from those that the task looked up lately, and from the store where it is further behind.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections import deque
from collections.abc import AsyncIterator, Iterator
from functools import partial

from anyio import CapacityLimiter
from anyio.to_thread import run_sync

from ...model.errors import NotFound, StoreError
from ..store import Event, Store

_log = logging.getLogger(__name__)
POLL = 0.1
"""Seconds between two looks."""
_PATIENCE = 2.0  # s until the next look after the store could not be reached
_RECENT = 256  # events of a job that are kept
_PAGE = 500


class Channel:
    """A job that streams follow. last: its last event that is known. over: no more will come."""

    def __init__(self, last: int) -> None:
        """Begin after an event."""
        self.last = last
        self.over = False
        self.followers = 0
        self.recent: deque[Event] = deque(maxlen=_RECENT)
        self._changed = asyncio.Event()

    def tell(self, events: list[Event], *, over: bool) -> None:
        """Take in what is new and wake all streams."""
        self.recent.extend(events)
        if events:
            self.last = events[-1].number
        self.over = self.over or over
        if events or over:
            self._changed.set()
            self._changed = asyncio.Event()

    def since(self, number: int) -> list[Event] | None:
        """Return the events after one, None if they are no longer kept."""
        if number >= self.last:
            return []
        if not self.recent or self.recent[0].number > number + 1:
            return None
        return [event for event in self.recent if event.number > number]

    async def news(self, seconds: float) -> bool:
        """Wait for something new, and return whether something came in that time."""
        changed = self._changed
        try:
            await asyncio.wait_for(changed.wait(), seconds)
        except TimeoutError:
            return False
        return True


class Feed:
    """The streams of one application and the task that serves them, which runs while there are any."""

    def __init__(self, store: Store) -> None:
        """Serve from a store."""
        self.store = store
        self._channels: dict[int, Channel] = {}
        self._task: asyncio.Task[None] | None = None
        self._thread: CapacityLimiter | None = None
        self._closed = False

    def close(self) -> None:
        """End all streams after what is known: the service stops. To be called in the loop that serves them."""
        self._closed = True
        for channel in self._channels.values():
            channel.tell([], over=True)

    async def follow(self, number: int, after: int, *, last: int, heartbeat: float) -> AsyncIterator[Event | None]:
        """Yield the events of a job after a given one as they come, up to its last one.

        last: an event that it has already. Yields None when nothing came for `heartbeat` seconds. Also ends when the
        job is deleted.
        """
        with self._following(number, last) as channel:
            position = after
            while True:
                found = channel.since(position)
                if found is None:
                    try:
                        found = await run_sync(partial(self.store.events, number, after=position, limit=_PAGE))
                    except (StoreError, NotFound) as error:
                        _log.warning("job %d: its stream ends: %s", number, error)
                        return
                for event in found:
                    position = event.number
                    yield event
                if position >= channel.last or not found:
                    if channel.over:
                        return
                    if not await channel.news(heartbeat):
                        yield None

    @contextlib.contextmanager
    def _following(self, number: int, last: int) -> Iterator[Channel]:
        channel = self._channels.get(number)
        if channel is None or channel.over:  # a job that had ended may have been resumed since
            channel = self._channels[number] = Channel(last)
        channel.followers += 1
        if self._closed:
            channel.over = True
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._look())
        try:
            yield channel
        finally:
            channel.followers -= 1
            if not channel.followers and self._channels.get(number) is channel:
                del self._channels[number]

    async def _look(self) -> None:
        """Look up what is new in the jobs that are followed, as long as there are any."""
        # One thread of its own: requests that keep all others busy do not keep streams waiting.
        self._thread = self._thread or CapacityLimiter(1)
        while self._channels:
            after = {number: channel.last for number, channel in self._channels.items() if not channel.over}
            try:
                news = await run_sync(self.store.news, after, limiter=self._thread) if after else {}
            except Exception as error:  # noqa: BLE001 - whatever it is, the streams wait for the next look
                _log.warning("streams wait: %s: %s", type(error).__name__, error)
                await asyncio.sleep(_PATIENCE)
                continue
            for number, last in after.items():
                channel = self._channels.get(number)
                if channel is None or channel.last != last:
                    continue  # it was left meanwhile, and perhaps followed anew
                if number in news:
                    channel.tell(news[number].events, over=news[number].over)
                else:
                    channel.tell([], over=True)
            await asyncio.sleep(POLL)
