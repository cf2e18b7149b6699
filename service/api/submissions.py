"""Submissions: a job as sent, or a copy with changes, with wider limits, or with ranges around a design."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Response
from pydantic import BaseModel, Field
from starlette.types import Receive, Scope, Send

from ...model.errors import InputError
from ..designs.changed_design import judged_variation
from ..designs.derived_jobs import SHARE, job_near_lengths, widen_limits
from ..designs.stored_designs import StoredDesign
from ..jobs.submission import job_json
from ..store import Job
from ..store.bookmarks_and_wishes import bookmark_design
from .active_limits import LIMIT_PATH, Side
from .computing import QuickRoute, limit_submissions
from .job_requests import (
    Clone,
    IdempotencyKey,
    RequestedJob,
    job_in_request,
    job_limits_within_service_limits,
    merge_patch,
    problem_of_tables,
)
from .models import JobStateModel
from .problem_documents import problem_responses
from .settings import JobNumber, SettingsDep, StoreDep
from .stored_fronts import LONGEST, FrontDep, Length


class SubmissionRoute(QuickRoute):
    """Endpoint that submits jobs, with a maximum number of requests per minute."""

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it above the rate limit."""
        if scope["method"] in (self.methods or ()):
            limit_submissions(scope["app"])
        await super().handle(scope, receive, send)


router = APIRouter(route_class=SubmissionRoute)
_SUBMITTED: dict[str, Any] = {"status_code": HTTPStatus.CREATED, "response_model": JobStateModel}
_SENT = {**_SUBMITTED, "tags": ["jobs"], "responses": problem_responses(415, 429)}
_COPIED = {**_SUBMITTED, "tags": ["fronts"], "responses": problem_responses(409, 415, 429)}


class OtherLimit(BaseModel, extra="forbid", strict=True):
    """New value for a limit of a job, in the unit of the limit."""

    of: LIMIT_PATH
    side: Side = Field(examples=["upper"])
    value: float = Field(allow_inf_nan=False, examples=[490.0])


class Widening(BaseModel, extra="forbid", strict=True):
    """Limits to widen in a copy of a job."""

    limits: list[OtherLimit] = Field(min_length=1, max_length=50)


class Nearby(BaseModel, extra="forbid", strict=True):
    """Lengths around which a copy of a job searches. share: fraction of each length, on either side."""

    crank_mm: Length = Field(examples=[40.0])
    rod_mm: Length = Field(examples=[64.0])
    offset_mm: float = Field(ge=-LONGEST, le=LONGEST, allow_inf_nan=False, examples=[20.0])
    share: float = Field(SHARE, gt=0.0, le=0.9, allow_inf_nan=False, examples=[0.1])


@dataclass(frozen=True)
class Queue:
    """Job queue for one request. idempotency_key: key of the submission."""

    store: StoreDep
    settings: SettingsDep
    response: Response
    idempotency_key: IdempotencyKey = None

    def submit(self, request: RequestedJob, *, origin: int | None = None) -> dict[str, Any]:
        """Queue a job and return its record. origin: number of the job from which it was copied."""
        problem = problem_of_tables(request.tables, self.settings.allowed_quantities)
        files = [request.source or job_json(request.tables)]
        options: dict[str, Any] = {"priority": request.priority, "key": self.idempotency_key, "limits": request.limits}
        job = self.store.submit(request.tables, name=problem.name, files=files, origin=origin, **options)
        self.response.headers["Location"] = f"/api/v1/jobs/{job.id}"
        return job.record()

    def submit_copy_with_tables(self, job: Job, tables: Mapping[str, Any]) -> dict[str, Any]:
        """Queue a copy of a job with other tables, and return its record."""
        return self.submit(RequestedJob(tables=tables, priority=job.priority, limits=job.limits), origin=job.id)


QueueDep = Annotated[Queue, Depends()]


@router.post("/jobs", **_SENT)
def submit_job(request: Annotated[RequestedJob, Depends(job_in_request)], queue: QueueDep) -> dict[str, Any]:
    """Queue a job: JSON with priority and limits, or a job file as application/toml. Workers solve it."""
    origin_exists = request.origin is not None and queue.store.jobs(numbers={request.origin}, limit=1)
    return queue.submit(request, origin=request.origin if origin_exists else None)


@router.post("/jobs/{number}/clone", **_SENT)
def clone_job(number: JobNumber, clone: Clone, queue: QueueDep) -> dict[str, Any]:
    """Queue a copy of a job with changes."""
    job = queue.store.job(number)
    copy = RequestedJob(
        tables=merge_patch(queue.store.job_tables(number), clone.changes),
        priority=job.priority if clone.priority is None else clone.priority,
        limits=job.limits
        if clone.limits is None
        else job_limits_within_service_limits(clone.limits, queue.settings.limits),
    )
    return queue.submit(copy, origin=number)


@router.post("/jobs/{number}/widened", **_COPIED)
def submit_with_wider_limits(stored_front: FrontDep, request: Widening, queue: QueueDep) -> dict[str, Any]:
    """Queue a copy of a job with wider limits; the copy records its origin."""
    wider = [(limit.of, limit.side, limit.value) for limit in request.limits]
    return queue.submit_copy_with_tables(
        stored_front.job, widen_limits(stored_front.problem, queue.store.job_tables(stored_front.job.id), wider)
    )


@router.post("/jobs/{number}/nearby", **_COPIED)
def submit_search_nearby(stored_front: FrontDep, request: Nearby, queue: QueueDep) -> dict[str, Any]:
    """Queue a copy of a job that searches around given lengths, which may lie outside its ranges.

    The copy has a bookmark of the design with these lengths, unless the job has extra variables or choices.
    """
    lengths = (request.crank_mm, request.rod_mm, request.offset_mm)
    tables = job_near_lengths(
        stored_front.problem, queue.store.job_tables(stored_front.job.id), lengths, share=request.share
    )
    record = queue.submit_copy_with_tables(stored_front.job, tables)
    if not (stored_front.problem.choices or stored_front.problem.parts()[0].mechanism.varying):
        start = StoredDesign(stored_front.problem.part(0), tuple(length / 1e3 for length in lengths), 0)
        with suppress(InputError):  # it cannot be assembled: the search around it may still find designs
            judged_variation(start, stored_front.result, stored_front.minimised_objectives)
            name = f"Start, from run {stored_front.job.id}"
            bookmark_design(queue.store, record["id"], dimensions=start.values, name=name)
    return record
