"""Problem documents (RFC 9457) that explain to a client why a request was refused or failed."""

import logging
import time
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any, Literal

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException
from starlette.routing import Match

from ...model.errors import (
    InfeasibleError,
    InputError,
    MissingExtra,
    NotFound,
    QueueFull,
    RunError,
    SlidercrankError,
    StoreError,
)

_log = logging.getLogger(__name__)
MEDIA_TYPE = "application/problem+json"
_MOST = 8  # maximum number of problems listed for one request
_LONGEST = 4000  # maximum characters in a sentence
FAULT = "this is a bug in the service, not in the request; its log has the details; tell its operator"
_STATUS: tuple[tuple[type[SlidercrankError], HTTPStatus], ...] = (
    (QueueFull, HTTPStatus.SERVICE_UNAVAILABLE),
    (StoreError, HTTPStatus.SERVICE_UNAVAILABLE),
    (RunError, HTTPStatus.CONFLICT),  # the requested result does not exist yet
    (NotFound, HTTPStatus.NOT_FOUND),
    (MissingExtra, HTTPStatus.NOT_IMPLEMENTED),
    (InputError, HTTPStatus.UNPROCESSABLE_ENTITY),
)
_QUIET = 60.0  # s
_OBJECT = ("model_type", "model_attributes_type", "dict_type")
_RETRY = {"Retry-After": "5"}


class Problem(BaseModel):
    """Reason why a request was refused or failed."""

    type: Literal["about:blank", "infeasible"] = Field(
        "about:blank",
        description="infeasible for a valid request that no design can meet; about:blank if the status says everything",
    )
    title: str = Field(description="the status in words", examples=["Not Found"])
    status: int = Field(description="the HTTP status", examples=[404])
    detail: str = Field(description="rule; value; remedy", examples=["there is no job 7; list the jobs"])


def problem_response(
    status: int,
    detail: str,
    headers: Mapping[str, str] | None = None,
    kind: Literal["about:blank", "infeasible"] = "about:blank",
) -> Response:
    """Return a problem document as a response."""
    if len(detail) > _LONGEST:
        detail = f"{detail[: _LONGEST - 4]} ..."
    content = Problem(type=kind, title=HTTPStatus(status).phrase, status=status, detail=detail)
    return JSONResponse(content.model_dump(), status, dict(headers or {}), MEDIA_TYPE)


def problem_responses(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Return the `responses` of an endpoint that may answer with these statuses."""
    content = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    return {status: {"description": HTTPStatus(status).phrase, "content": content} for status in statuses}


def json_with_etag_options(model: type[BaseModel], description: str) -> dict[str, Any]:
    """Return the options of an endpoint for JSON with an ETag, or 304 if the client is up to date."""
    same = {"description": "Not modified: the ETag in If-None-Match is still current"}
    return {"response_class": Response, "responses": {200: {"model": model, "description": description}, 304: same}}


def handle_expected_errors(app: FastAPI) -> None:
    """Answer every expected exception of an application with a problem document."""
    app.add_exception_handler(SlidercrankError, _refusal_response)
    app.add_exception_handler(RequestValidationError, _invalid_request_response)
    app.add_exception_handler(HTTPException, _http_error_response)


async def _refusal_response(request: Request, error: Exception) -> Response:
    assert isinstance(error, SlidercrankError)
    status = next((status for kind, status in _STATUS if isinstance(error, kind)), HTTPStatus.INTERNAL_SERVER_ERROR)
    if status >= HTTPStatus.INTERNAL_SERVER_ERROR and is_due_for_log(request.app.state.fault_times, str(error)):
        _log.warning("%s: %s", type(error).__name__, error)
    kind: Literal["about:blank", "infeasible"] = "infeasible" if isinstance(error, InfeasibleError) else "about:blank"
    return problem_response(status, str(error), _RETRY if status == HTTPStatus.SERVICE_UNAVAILABLE else None, kind)


def is_due_for_log(last_logged: dict[str, float], sentence: str) -> bool:
    """Whether a sentence was not logged within the last minute, since many requests meet the same fault."""
    now = time.monotonic()
    if now - last_logged.get(sentence, -_QUIET) < _QUIET:
        return False
    for old in [logged for logged, at in last_logged.items() if now - at >= _QUIET]:
        del last_logged[old]
    last_logged[sentence] = now
    return True


async def _invalid_request_response(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    errors = error.errors()
    if any(isinstance(details["input"], bytes) for details in errors):  # text of other types passes unchanged
        kind = request.headers.get("content-type", "no type")[:100]
        turned = ", see POST /api/v1/parse for a job file as JSON" if "toml" in kind else ""
        sentence = f"body: must be a JSON object of type application/json; got {kind}; send it as such{turned}"
        return problem_response(HTTPStatus.UNPROCESSABLE_ENTITY, sentence)
    sentences = [f"{_location_text(details['loc'])}: {validation_message(details)}" for details in errors[:_MOST]]
    ellipsis = ["... and more"] if len(errors) > _MOST else []
    return problem_response(HTTPStatus.UNPROCESSABLE_ENTITY, "\n  ".join([*sentences, *ellipsis]))


async def _http_error_response(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    detail, headers = error.detail, error.headers
    if error.status_code == HTTPStatus.NOT_FOUND and detail == HTTPStatus.NOT_FOUND.phrase:
        detail = "nothing exists at this address; see /api/v1/openapi.json for the addresses of the API"
    elif error.status_code == HTTPStatus.METHOD_NOT_ALLOWED:
        headers = {"Allow": ", ".join(_allowed_methods(request))}
        detail = f"this address must be called with another method; got {request.method}; use {headers['Allow']}"
    return problem_response(error.status_code, detail, headers)


def _allowed_methods(request: Request) -> list[str]:
    """Return the methods of a path: the framework only names those of its first endpoint."""

    def is_known(method: str) -> bool:
        scope = {**request.scope, "method": method}
        return any(route.matches(scope)[0] is Match.FULL for route in request.app.routes)

    return [method for method in ("GET", "POST", "PUT", "PATCH", "DELETE") if is_known(method)]


def validation_message(details: Mapping[str, Any]) -> str:
    """Return the message for an error from pydantic: rule, value, remedy."""
    from ...objectives.units import quote
    from ...optimise.job.mistake_messages import broken_rule

    if details["type"] == "missing":
        return "is missing, but required; add it"
    if details["type"] == "extra_forbidden":
        return f"unknown; got {quote(details['input'])}; leave it out"
    rule = broken_rule(details) if details["type"] not in _OBJECT else "must be a JSON object, in braces"
    return f"{rule}; got {quote(details['input'])}; correct it"


def _location_text(location: Sequence[Any]) -> str:
    """Return the location of a mistake, such as "query limit" or "body priority", with long keys shortened."""
    first, *rest = [str(part) for part in location] or ["request"]
    text = ".".join(rest)
    return f"{first} {text[:100]}" if text else first
