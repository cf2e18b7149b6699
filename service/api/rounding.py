"""Rounded neighbours of a design of a front: the answer of `slidercrank round --json`, with progress if streamed."""

from __future__ import annotations

import contextlib
import itertools
import json
from collections.abc import AsyncIterator, Generator
from typing import Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Request, Response
from fastapi.responses import StreamingResponse
from fastapi.sse import format_sse_event
from pydantic import Field

from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..questions.front_or_job_question import Answer
from ..runs.result import json_ready
from .computing import LongRoute
from .events import STREAM, STREAM_HEADERS
from .fronts import OfDesign
from .input_parameters import body_of
from .models import UnitsParameter
from .problem_documents import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(route_class=LongRoute, tags=["designs"], responses=problem_responses(409))

QUESTION = FRONT_OR_JOB_QUESTIONS["round"]
_ROUNDED_EXAMPLE = {
    "met": True,
    "message": "311 of 2016 rounded designs within 16 steps keep every requirement within 0.1 mm of stroke",
    "steps": {"crank_mm": 0.5},
    "allowed": {"stroke_mm": 0.1},
    "within_steps": 16,
    "judged": 2016,
    "kept": 311,
    "given": {"crank_mm": 73.33253, "peak_torque_Nm": 12.1},
    "designs": [
        {
            "crank_mm": 73.5,
            "peak_torque_Nm": 12.12,
            "change_peak_torque_Nm": 0.02,
            "change_peak_torque_percent": 0.17,
            "loss_percent": 0.2,
            "tightest": "transmission_angle",
            "missed": ["stroke"],
            "misses": [
                {
                    "quantity": "stroke",
                    "title": "stroke",
                    "kind": "length",
                    "amount": 0.03,
                    "unit": "mm",
                    "side": "below",
                    "allowed": 0.1,
                }
            ],
        }
    ],
    "notes": ["rod has no step and stays as it is"],
}


_ROUNDED_STREAM = (
    'event: progress\ndata: {"stage":"screening combinations","step":32768,"steps":262144}\n\n'
    'event: rounded\ndata: {"job":7,"number":3,"rounded":{"met":true}}\n\n'
)
_Event = tuple[str, str]
"""Kind and data of an event."""
_Events = Generator[_Event, None, None]


class RoundedModel(OfDesign):
    """Rounded neighbours of a design of a front. rounded: what `slidercrank round --json` prints."""

    rounded: dict[str, Any] = Field(examples=[_ROUNDED_EXAMPLE])


_ROUNDED_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The answer; streamed, events of its progress before it",
        "content": {STREAM: {"schema": {"type": "string"}, "example": _ROUNDED_STREAM}},
    }
}


def round_design(
    request: Request, stored_front: FrontDep, design: DesignNumber, given: Any, units: UnitsParameter = "metric"
) -> Response:
    """Find the best designs of round numbers near a design that meet every requirement, and what each costs.

    Where none meets all within what is allowed, the nearest are listed, with each miss as a number; `met` is then
    false. With `Accept: text/event-stream` the progress is streamed; closing the connection then ends the search.
    """
    stored_front.row(design)

    def search() -> _Events:
        """Yield kind and data of the events."""
        from ..questions.round.analysis import search

        words = {item.name: item.name for item in QUESTION.inputs}
        for at in search(stored_front.front, design - 1, words, **QUESTION.read(given.model_dump(), design)):
            if isinstance(at, Answer):
                record = json_ready(at.record(units))
            else:
                yield "progress", json.dumps(vars(at))
        yield "rounded", RoundedModel(job=stored_front.job.id, number=design, rounded=record).model_dump_json()

    events = search()
    first = next(events)  # an invalid request is refused before anything is sent
    if STREAM not in request.headers.get("accept", ""):
        *_, (_, data) = itertools.chain([first], events)
        return Response(data, media_type="application/json")
    return StreamingResponse(_lines(first, events), headers=STREAM_HEADERS, media_type=STREAM)


round_design.__annotations__["given"] = body_of(QUESTION, "Steps")
router.add_api_route(
    "/jobs/{number}/designs/{design}/rounded",
    round_design,
    methods=["POST"],
    response_model=RoundedModel,
    responses=_ROUNDED_RESPONSES,
)


async def _lines(first: _Event, events: _Events) -> AsyncIterator[bytes]:
    """Return events as a stream, and end the search if the client stops reading."""
    with contextlib.closing(events):
        event: _Event | None = first
        while event is not None:
            yield format_sse_event(data_str=event[1], event=event[0])
            event = await run_sync(next, events, None)
