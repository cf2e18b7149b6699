"""Points of fronts for the small pictures of a list: of several jobs at once, kept by browsers."""

from __future__ import annotations

import hashlib
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from pydantic import Field
from pydantic_core import to_json

from .models import LARGEST, FrontPointsList, Whole
from .settings import StoreDep

router = APIRouter(tags=["jobs"])
_MOST = 100
_Number = Annotated[Whole, Field(ge=1, le=LARGEST)]


@router.get(
    "/front-points",
    response_class=Response,
    responses={
        200: {"model": FrontPointsList, "description": "The points"},
        304: {"description": "They are those of the ETag in If-None-Match"},
    },
)
def list_front_points(
    request: Request,
    store: StoreDep,
    job: Annotated[
        list[_Number], Query(min_length=1, max_length=_MOST, description="the numbers of jobs", examples=[[1]])
    ],
) -> Response:
    """Return some designs of the fronts of jobs, of those that run of their fronts so far."""
    found = store.jobs(numbers=set(job), limit=_MOST)
    content = to_json({"fronts": [{"job": one.id, **one.front_points()} for one in reversed(found)]})
    headers = {"ETag": f'"{hashlib.sha256(content).hexdigest()[:16]}"', "Cache-Control": "private, no-cache"}
    if request.headers.get("if-none-match") == headers["ETag"]:
        return Response(status_code=304, headers=headers)
    return Response(content, media_type="application/json", headers=headers)
