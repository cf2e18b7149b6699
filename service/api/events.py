"""Events of a job: as server-sent events while they happen, or as a page of JSON."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from typing import Annotated, Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Header, Query, Request, Response
from fastapi.responses import JSONResponse, StreamingResponse
from fastapi.sse import format_sse_event

from ..store import Event, Store
from ..store.records import ENDED
from .event_feed import Feed
from .models import LARGEST, EventPage, JobNumber, Whole
from .settings import StoreDep

router = APIRouter(tags=["jobs"])
HEARTBEAT = 15.0
"""Seconds without an event after which a comment is sent, so that nothing on the way takes the stream for dead."""
STREAM = "text/event-stream"
_FIRST = b"retry: 2000\n\n"
_EXAMPLE = (
    'event: state\ndata: {"number":1,"at":1795375800.0,"kind":"state","data":{"state":"queued","reason":""}}\nid: 1\n\n'
)
_STREAMED: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "Events, to the end of the job where they are streamed",
        "content": {STREAM: {"schema": {"type": "string"}, "example": _EXAMPLE}},
    },
    204: {"description": "The job has ended, and nothing came after the event of Last-Event-ID: no need to come back"},
}


@router.get("/jobs/{number}/events", response_model=EventPage, responses=_STREAMED)
async def list_events(
    request: Request,
    number: JobNumber,
    store: StoreDep,
    after: Annotated[Whole, Query(ge=0, le=LARGEST, description="events after the one of this number")] = 0,
    limit: Annotated[Whole, Query(ge=1, le=1000, description="at most so many, in a page of JSON")] = 1000,
    last_event_id: Annotated[
        Whole | None,
        Header(ge=0, le=LARGEST, description="the same as `after`, as browsers send it to reconnect"),
    ] = None,
) -> Response:
    """Return the events of a job: a page of JSON, or a stream of events with `Accept: text/event-stream`."""
    begin = after if last_event_id is None else last_event_id
    if STREAM not in request.headers.get("accept", ""):
        return JSONResponse(await run_sync(_page, store, number, begin, limit))
    job = await run_sync(store.job, number)
    position = min(begin, job.events)
    if job.state in ENDED and last_event_id is not None and position == job.events:
        return Response(status_code=204)
    feed: Feed = request.app.state.feed
    followed = feed.follow(number, position, last=job.events, heartbeat=HEARTBEAT)
    headers = {"Cache-Control": "no-cache", "X-Accel-Buffering": "no"}
    return StreamingResponse(_lines(followed), headers=headers, media_type=STREAM)


def _page(store: Store, number: int, after: int, limit: int) -> dict[str, Any]:
    position = min(after, store.job(number).events)
    found = store.events(number, after=position, limit=limit)
    return {"events": [_shown(event) for event in found], "last": found[-1].number if found else position}


async def _lines(events: AsyncIterator[Event | None]) -> AsyncIterator[bytes]:
    yield _FIRST
    async for event in events:
        if event is None:
            yield b": still there\n\n"
        else:
            data = json.dumps(_shown(event), separators=(",", ":"))
            yield format_sse_event(data_str=data, event=event.kind, id=str(event.number))


def _shown(event: Event) -> dict[str, Any]:
    """Return an event as `EventShown` has it."""
    return {"number": event.number, "at": event.at, "kind": event.kind, "data": event.data}
