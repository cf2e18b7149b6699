"""Fronts as files: CSV, JSON, Parquet."""

import io
from typing import Any

from fastapi import APIRouter, Response
from pydantic_core import to_json

from ...model.optional_packages import import_extra, is_installed
from ..designs.display_units import convert_result, convert_rows
from ..designs.selection import numbered_rows
from ..runs.result import csv_text
from ..runs.run_folder import slug
from .computing import QuickRoute
from .problem_documents import problem_responses
from .settings import UnitsParameter
from .stored_fronts import FrontDep, StoredFront

router = APIRouter(route_class=QuickRoute, tags=["fronts"], responses=problem_responses(409))


SEALED = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox"
"""Security policy for a file that a browser may open as a document of this origin: no scripts, no requests."""


def export_formats() -> list[str]:
    """Return the file endings available for a front: Parquet only if pyarrow is installed."""
    return ["csv", "json", *(["parquet"] if is_installed("pyarrow") else [])]


def file_endpoint_options(media_type: str, *refusals: int) -> dict[str, Any]:
    """Return the options of an endpoint that returns a file. Further statuses are those of its refusals."""
    responses = {200: {"content": {media_type: {}}}, **problem_responses(*refusals)}
    return {"response_class": Response, "responses": responses}


def download_response(content: str | bytes, media_type: str, name: str, *, policy: str = "") -> Response:
    """Return a file for a browser to save under a name. policy: security policy (CSP) if a browser opens it anyway."""
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    if policy:
        headers["Content-Security-Policy"] = policy
    return Response(content, media_type=media_type, headers=headers)


def _front_file_response(stored_front: StoredFront, ending: str, media_type: str, content: str | bytes) -> Response:
    return download_response(content, media_type, f"{slug(stored_front.result.name)}-{stored_front.job.id}.{ending}")


@router.get("/jobs/{number}/export.csv", **file_endpoint_options("text/csv"))
def export_csv(stored_front: FrontDep, units: UnitsParameter = "metric") -> Response:
    """Return every design with its number and all its quantities at full precision.

    Text cells that a spreadsheet would read as a formula begin with an apostrophe. Infinity is written inf.
    """
    content = csv_text(numbered_rows(convert_rows(stored_front.result.designs, units)), spreadsheet=True)
    return _front_file_response(stored_front, "csv", "text/csv; charset=utf-8", content)


@router.get("/jobs/{number}/export.json", **file_endpoint_options("application/json"))
def export_json(stored_front: FrontDep, units: UnitsParameter = "metric") -> Response:
    """Return the whole front as `slidercrank export --json` does, but on one line."""
    result = convert_result(stored_front.result, units, None if units == "metric" else stored_front.problem)
    content = to_json(result.record(), inf_nan_mode="null")  # takes a tenth of the time of the `json` module
    return _front_file_response(stored_front, "json", "application/json", content)


@router.get("/jobs/{number}/export.parquet", **file_endpoint_options("application/vnd.apache.parquet", 501))
def export_parquet(stored_front: FrontDep, units: UnitsParameter = "metric") -> Response:
    """Return every design with all its quantities as a column-oriented table; needs pyarrow on the server."""
    import pandas as pd

    import_extra("pyarrow", "fronts as Parquet need")

    out = io.BytesIO()
    pd.DataFrame(convert_rows(stored_front.result.designs, units)).to_parquet(out, engine="pyarrow", index=False)
    return _front_file_response(stored_front, "parquet", "application/vnd.apache.parquet", out.getvalue())
