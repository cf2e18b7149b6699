"""Columns of a front, whole: what a page needs that draws every design at once."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Header, Query, Request, Response
from pydantic import BaseModel, Field

from ..designs.columns import Column, find_columns
from .fronts import ColumnModel, column_model
from .problems import problem_responses
from .stored_fronts import FrontDep, StoredFront

if TYPE_CHECKING:
    from collections.abc import Sequence

router = APIRouter(tags=["fronts"], responses=problem_responses(409))

_WORTHWHILE = 16_384
"""Bytes from which an answer is compressed. At the quickest level 10,000 designs of 8 columns take 40 ms and shrink to
half: worth it once for all who ask, not for each."""


class ColumnsModel(BaseModel):
    """All values of some columns, in the order of the front; null for what is infinite or not defined."""

    job: int = Field(examples=[7])
    count: int = Field(description="how many designs the front has", examples=[100])
    columns: list[ColumnModel]
    values: dict[str, list[float | str | None]] = Field(
        description="by the key of the column, one of every design",
        examples=[{"crank_mm": [40.0, 41.5], "slow_stroke": ["inward", "inward"]}],
    )


@router.get(
    "/jobs/{number}/columns",
    response_class=Response,
    responses={
        200: {"model": ColumnsModel, "description": "The values of every design"},
        304: {"description": "They are those of the ETag in If-None-Match"},
    },
)
def list_columns(
    request: Request,
    found: FrontDep,
    columns: Annotated[
        str | None, Query(max_length=2000, description="quantities or columns, separated by commas; all if left out")
    ] = None,
    accept_encoding: Annotated[str, Header(include_in_schema=False)] = "",
) -> Response:
    """Give columns of the designs, each as one array of all designs: a front of 10,000 in one small answer."""
    shown = found.columns
    if columns is not None and found.result.designs:
        shown = list({column.key: column for column in find_columns(columns, list(found.result.designs[0]))}.values())
    # What a job found does not change, unless it goes on: then it ends at another time.
    headers = {
        "ETag": f'"{found.job.id}-{found.job.finished}"',
        "Cache-Control": "private, no-cache",
        "Vary": "Accept-Encoding",
    }
    if found.job.finished is not None and request.headers.get("if-none-match") == headers["ETag"]:
        return Response(status_code=304, headers=headers)
    compressed = "gzip" in accept_encoding and "gzip;q=0" not in accept_encoding.replace(" ", "")
    content = _content(found, shown, compressed=compressed)
    if content.startswith(b"\x1f\x8b"):
        headers["Content-Encoding"] = "gzip"
    return Response(content, media_type="application/json", headers=headers)


def _content(found: StoredFront, shown: Sequence[Column], *, compressed: bool) -> bytes:
    """Return the answer, kept for who asks next."""
    kind = "gzip" if compressed else "plain"
    name = ",".join(column.key for column in shown)
    content = found.answer(name, kind)
    if content is None:
        content = _made(found, shown)
        if compressed and len(content) > _WORTHWHILE:
            content = gzip.compress(content, compresslevel=1, mtime=0)
        found.keep_answer(name, kind, content)
    return content


def _made(found: StoredFront, shown: Sequence[Column]) -> bytes:
    from pydantic_core import to_json

    rows = found.result.designs
    answer = {
        "job": found.job.id,
        "count": len(rows),
        "columns": [column_model(column).model_dump() for column in shown],
        "values": {column.key: [row[column.key] for row in rows] for column in shown},
    }
    return to_json(answer, inf_nan_mode="null")
