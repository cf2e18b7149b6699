"""Events of a job: live as server-sent events, or as a page of JSON.

A waiting stream holds no thread and misses no event: one task looks up the events of all followed jobs and wakes their
streams. A stream remembers the number of the last event that it sent. It takes the next events from the task's recent
ones, or from the store if it is further behind.
"""

import asyncio
import contextlib
import json
import logging
from collections import deque
from collections.abc import AsyncIterator, Iterator
from functools import partial
from typing import Annotated, Any

from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from fastapi import APIRouter, Header, Query, Request, Response
from fastapi.responses import JSONResponse, StreamingResponse
from fastapi.sse import format_sse_event

from ...model.errors import NotFound, StoreError
from ..store import Event, Store
from ..store.records import ENDED
from .models import EventPage
from .settings import LARGEST, PLAIN_DIGITS, JobNumber, StoreDep

router = APIRouter(tags=["jobs"])
HEARTBEAT = 15.0
"""Seconds without an event until a comment is sent, so that no proxy considers the stream dead."""
STREAM = "text/event-stream"
STREAM_HEADERS = {"Cache-Control": "no-cache", "X-Accel-Buffering": "no"}
"""Headers that stop proxies from buffering a stream."""
_FIRST = b"retry: 2000\n\n"
_EXAMPLE = (
    'event: state\ndata: {"number":1,"at":1795375800.0,"kind":"state","data":{"state":"queued","reason":""}}\nid: 1\n\n'
)
_STREAMED: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "Events; as a stream, up to the end of the job",
        "content": {STREAM: {"schema": {"type": "string"}, "example": _EXAMPLE}},
    },
    204: {"description": "The job has ended, and no event follows Last-Event-ID: do not reconnect"},
}
_log = logging.getLogger(__name__)
POLL = 0.1
"""Seconds between two look-ups."""
_PATIENCE = 2.0  # s until the next attempt while the store is unreachable
_RECENT = 256  # recent events kept per job
_PAGE = 500


class Channel:
    """Job that streams follow. last: number of its last known event. over: whether no more events will come."""

    def __init__(self, last: int) -> None:
        self.last = last
        self.over = False
        self.followers = 0
        self.recent: deque[Event] = deque(maxlen=_RECENT)
        self._changed = asyncio.Event()

    def publish(self, events: list[Event], *, ended: bool) -> None:
        """Accept new events and wake all streams."""
        self.recent.extend(events)
        if events:
            self.last = events[-1].number
        self.over = self.over or ended
        if events or ended:
            self._changed.set()
            self._changed = asyncio.Event()

    def events_since(self, number: int) -> list[Event] | None:
        """Return the events after a given one, or None if they are no longer in memory."""
        if number >= self.last:
            return []
        if not self.recent or self.recent[0].number > number + 1:
            return None
        return [event for event in self.recent if event.number > number]

    async def wait_for_events(self, seconds: float) -> bool:
        """Wait for new events; return whether any arrived in time."""
        changed = self._changed
        try:
            await asyncio.wait_for(changed.wait(), seconds)
        except TimeoutError:
            return False
        return True


class Feed:
    """Streams of one application, and the task that serves them while there are any."""

    def __init__(self, store: Store) -> None:
        self.store = store
        self._channels: dict[int, Channel] = {}
        self._task: asyncio.Task[None] | None = None
        self._thread: CapacityLimiter | None = None
        self._closed = False

    def close(self) -> None:
        """End all streams after their known events when the service stops. Call it in the event loop of the streams."""
        self._closed = True
        for channel in self._channels.values():
            channel.publish([], ended=True)

    async def stream(self, number: int, after: int, *, last: int, heartbeat: float) -> AsyncIterator[Event | None]:
        """Yield the events of a job after a given one as they happen, up to its last one.

        last: number of the last event already received. Yields None after `heartbeat` seconds without an event. Also
        ends when the job is deleted.
        """
        with self._watch_channel(number, last) as channel:
            position = after
            while True:
                events = channel.events_since(position)
                if events is None:
                    try:
                        events = await run_sync(partial(self.store.events, number, after=position, limit=_PAGE))
                    except (StoreError, NotFound) as error:
                        _log.warning("job %d: its stream ends: %s", number, error)
                        return
                for event in events:
                    position = event.number
                    yield event
                if position >= channel.last or not events:
                    if channel.over:
                        return
                    if not await channel.wait_for_events(heartbeat):
                        yield None

    @contextlib.contextmanager
    def _watch_channel(self, number: int, last: int) -> Iterator[Channel]:
        channel = self._channels.get(number)
        if channel is None or channel.over:  # an ended job may have been resumed since
            channel = self._channels[number] = Channel(last)
        channel.followers += 1
        if self._closed:
            channel.over = True
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._poll_store())
        try:
            yield channel
        finally:
            channel.followers -= 1
            if not channel.followers and self._channels.get(number) is channel:
                del self._channels[number]

    async def _poll_store(self) -> None:
        """Look up new events of followed jobs while there are any."""
        # A separate thread, so that requests that occupy all others do not delay streams.
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
                    continue  # its streams may have left, and perhaps returned, meanwhile
                if number in news:
                    channel.publish(news[number].events, ended=news[number].is_over)
                else:
                    channel.publish([], ended=True)
            await asyncio.sleep(POLL)


@router.get("/jobs/{number}/events", response_model=EventPage, responses=_STREAMED)
async def list_events(
    request: Request,
    number: JobNumber,
    store: StoreDep,
    after: Annotated[
        int, Query(ge=0, le=LARGEST, description="number of an event; only later ones are returned"), PLAIN_DIGITS
    ] = 0,
    limit: Annotated[
        int, Query(ge=1, le=1000, description="maximum number of events per page of JSON"), PLAIN_DIGITS
    ] = 1000,
    last_event_id: Annotated[
        int | None,
        Header(ge=0, le=LARGEST, description="same as `after`, as browsers send it to reconnect"),
        PLAIN_DIGITS,
    ] = None,
) -> Response:
    """Return the events of a job: a page of JSON, or a stream of events with `Accept: text/event-stream`."""
    begin = after if last_event_id is None else last_event_id
    if STREAM not in request.headers.get("accept", ""):
        return JSONResponse(await run_sync(_event_page, store, number, begin, limit))
    job = await run_sync(store.job, number)
    position = min(begin, job.events)
    if job.state in ENDED and last_event_id is not None and position == job.events:
        return Response(status_code=204)
    feed: Feed = request.app.state.feed
    stream = feed.stream(number, position, last=job.events, heartbeat=HEARTBEAT)
    return StreamingResponse(_event_stream(stream), headers=STREAM_HEADERS, media_type=STREAM)


def _event_page(store: Store, number: int, after: int, limit: int) -> dict[str, Any]:
    position = min(after, store.job(number).events)
    events = store.events(number, after=position, limit=limit)
    return {"events": [event.record() for event in events], "last": events[-1].number if events else position}


async def _event_stream(events: AsyncIterator[Event | None]) -> AsyncIterator[bytes]:
    yield _FIRST
    async for event in events:
        if event is None:
            yield b": still there\n\n"
        else:
            data = json.dumps(event.record(), separators=(",", ":"))
            yield format_sse_event(data_str=data, event=event.kind, id=str(event.number))
