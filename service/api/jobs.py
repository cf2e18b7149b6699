"""Jobs: list, show, cancel, resume and delete them, and get their files."""

import contextlib
import re
from collections.abc import Iterator
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi import Path as InPath
from pydantic import Field
from pydantic_core import to_json
from starlette.exceptions import HTTPException

from ...model.errors import InputError, NotFound
from ..page.router import content_tag, response_with_etag
from ..store import State
from ..store.job_rows import Order
from .front_files import download_response, export_formats
from .models import FrontPointsList, JobFiles, JobPage, JobStateModel
from .problem_documents import json_with_etag_options, problem_responses
from .settings import LARGEST, PLAIN_DIGITS, JobNumber, StoreDep

router = APIRouter(tags=["jobs"])
_FILE: dict[int | str, dict[str, Any]] = {
    200: {"description": "The file", "content": {"*/*": {"schema": {"type": "string", "format": "binary"}}}}
}
_MOST_FRONTS = 100
_Number = Annotated[int, Field(ge=1, le=LARGEST), PLAIN_DIGITS]
FileName = Annotated[str, InPath(max_length=255, description="one of the files of the job", examples=["job.toml"])]


@router.get("/jobs", response_model=JobPage)
def list_jobs(
    store: StoreDep,
    state: Annotated[list[State], Query(description="states of the jobs to list")] = [],  # noqa: B006 - FastAPI copies it
    name: Annotated[str, Query(max_length=200, description="part of the name of the jobs to list")] = "",
    before: Annotated[
        int | None,
        Query(ge=1, le=LARGEST, description="number of a job; only those that follow it are listed"),
        PLAIN_DIGITS,
    ] = None,
    limit: Annotated[int, Query(ge=1, le=1000, description="maximum number of jobs"), PLAIN_DIGITS] = 100,
    sort: Annotated[
        Order, Query(description="state: waiting and running ones first; decided: jobs with a decision first")
    ] = "newest",
) -> dict[str, Any]:
    """Return jobs with a few fields each: `/jobs/{number}` returns all fields of one, `/front-points` small fronts."""
    jobs = store.jobs(states=state, name=name, before=before, limit=limit + 1, order=sort)
    page = jobs[:limit]
    rows = [job.record() if job.state == "running" else {**job.record(), "progress": None} for job in page]
    return {
        "jobs": rows,
        "workers": str(store.count_workers_and_waiting_jobs()),
        "next": page[-1].id if len(jobs) > limit else None,
    }


@router.get("/front-points", **json_with_etag_options(FrontPointsList, "The points"))
def list_front_points(
    request: Request,
    store: StoreDep,
    job: Annotated[
        list[_Number], Query(min_length=1, max_length=_MOST_FRONTS, description="the numbers of jobs", examples=[[1]])
    ],
) -> Response:
    """Return some designs on the fronts of jobs; for running jobs, of their fronts so far."""
    jobs = store.jobs(numbers=set(job), limit=_MOST_FRONTS)
    content = to_json(
        {"fronts": [{"job": stored_job.id, **stored_job.front_points()} for stored_job in reversed(jobs)]}
    )
    return response_with_etag(
        request, f'"{content_tag(content)}"', lambda: Response(content, media_type="application/json")
    )


@router.get("/jobs/{number}", response_model=JobStateModel)
def show_job(number: JobNumber, store: StoreDep) -> dict[str, Any]:
    """Return the state of a job."""
    return store.job(number).record()


@router.delete("/jobs/{number}", status_code=HTTPStatus.NO_CONTENT, responses=problem_responses(409))
def delete_job(number: JobNumber, store: StoreDep) -> None:
    """Delete an ended job and all its data."""
    with _conflict_on_refusal():
        store.delete(number)


@router.post("/jobs/{number}/cancel", response_model=JobStateModel)
def cancel_job(number: JobNumber, store: StoreDep) -> dict[str, Any]:
    """Cancel a job; its results are kept, and it can be resumed. An ended job does not change."""
    return store.cancel(number).record()


@router.post("/jobs/{number}/resume", response_model=JobStateModel, responses=problem_responses(409))
def resume_job(number: JobNumber, store: StoreDep) -> dict[str, Any]:
    """Queue a cancelled or failed job again, to continue where it stopped."""
    with _conflict_on_refusal():
        return store.resume(number).record()


@router.get("/jobs/{number}/job")
def show_tables(number: JobNumber, store: StoreDep) -> dict[str, Any]:
    """Return the tables of a job, as in its job file."""
    return store.job_tables(number)


@router.get("/jobs/{number}/files", response_model=JobFiles)
def list_files(number: JobNumber, store: StoreDep) -> dict[str, Any]:
    """Return the names of a job's files, and the export formats of its front."""
    return {"files": store.artefact_names(number), "exports": export_formats()}


@router.get("/jobs/{number}/files/{name}", response_class=Response, responses=_FILE)
def fetch_file(number: JobNumber, name: FileName, store: StoreDep) -> Response:
    """Return a file of a job, as it was sent or created."""
    file = store.artefact(number, name)
    # Always a download: files sent with a job must not run in a browser that has the token.
    return download_response(file.content, file.media_type, re.sub(r"[^A-Za-z0-9._-]", "_", file.name))


@contextlib.contextmanager
def _conflict_on_refusal() -> Iterator[None]:
    """Report an operation that is not allowed in the job's state as a conflict."""
    try:
        yield
    except NotFound:
        raise
    except InputError as error:
        raise HTTPException(HTTPStatus.CONFLICT, str(error)) from None
