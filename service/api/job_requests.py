"""Jobs sent by clients: JSON with options or a job file, its content, its problem."""

from base64 import b64decode
from collections.abc import Collection, Mapping
from dataclasses import astuple, dataclass
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import Header, Request
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field, ValidationError
from starlette.exceptions import HTTPException

from ...model.errors import InputError, JobError
from ...optimise.problem.problem import Problem
from ..jobs.submission import LONGEST_WAIT, parse_with_allowed_functions, with_time_limit_per_call
from ..store import NO_LIMITS, Artefact, Limits
from .settings import LARGEST, Settings
from .strict_input import PARSED_BODY, read_body_in_turn, read_json, require_shallow_and_portable

JSON, TOML = "application/json", "application/toml"
EXAMPLE = {
    "name": "Feeder",
    "mechanism": {
        "speed": "60 rpm",
        "crank": {"mass": "1 kg", "inertia": "0.01 kg m^2"},
        "rod": {"mass": "1 kg", "inertia": "0.01 kg m^2"},
        "slider": {"mass": "2 kg"},
    },
    "variables": {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": ["0 mm", "100 mm"]},
    "constraints": {"stroke": {"equals": "280 mm"}},
    "objectives": {"time_ratio": "maximise", "transmission_angle": "maximise"},
    "optimiser": {"designs": 20, "seed": 1},
}
"""Job that can be solved."""
Priority = Annotated[int, Field(ge=-1000, le=1000, description="priority; jobs with higher ones are solved first")]
IdempotencyKey = Annotated[
    str | None,
    Header(
        min_length=1,
        max_length=255,
        pattern="^[!-~]+$",
        description="key of this submission: a repetition with the same key adds no job and returns the earlier one",
        examples=["4c7a1f0e-feeder"],
    ),
]
"""Header of a submission."""


class RequestedLimits(BaseModel, extra="forbid", strict=True):
    """Limits that a client requests for a job; those of the service replace omitted ones."""

    seconds: float | None = Field(None, gt=0, le=LARGEST, description="time limit of the search, s", examples=[600])
    evaluations: int | None = Field(
        None, gt=0, le=LARGEST, description="maximum number of designs that the search evaluates"
    )
    memory_bytes: int | None = Field(None, gt=0, le=LARGEST, description="memory limit of the worker, bytes")


class Submission(BaseModel, extra="forbid", strict=True):
    """Job with its limits and priority."""

    job: dict[str, Any] = Field(description="the tables of a job file, see GET /api/v1/schema", examples=[EXAMPLE])
    files: dict[str, str] = Field(
        default={},
        max_length=100,
        description="contents of the files that the job names, by name: text, or bytes as data:text/csv;base64,...",
        examples=[{"trace.csv": "crank angle (deg),force (N)\n0,-200\n180,0\n"}],
    )
    priority: Priority = 0
    limits: RequestedLimits = RequestedLimits()
    origin: int | None = Field(
        None,
        ge=1,
        le=LARGEST,
        description="number of the original job if this is a modified copy; omitted once the original is deleted",
        examples=[1],
    )


class Clone(BaseModel, extra="forbid", strict=True):
    """Changes to make in a copy of a job."""

    changes: dict[str, Any] = Field(
        default_factory=dict,
        description="changes to the tables of the job, as a JSON merge patch (RFC 7396): null removes a key",
        examples=[{"name": "Feeder, heavier", "mechanism": {"slider": {"mass": "2.5 kg"}}}],
    )
    priority: Priority | None = Field(None, description="priority; by default, the job's")
    limits: RequestedLimits | None = Field(None, description="limits; by default, the job's")


@dataclass(frozen=True, kw_only=True)
class RequestedJob:
    """Parsed submission. source: the job file, if one was sent. origin: number of the job that was copied."""

    tables: Mapping[str, Any]
    priority: int = 0
    limits: Limits = NO_LIMITS
    source: Artefact | None = None
    origin: int | None = None


async def job_in_request(request: Request) -> RequestedJob:
    """Return the submission in a request; a dependency.

    Raises the errors that are answered with status 400, 415 or 422.
    """
    body = await request.body()
    settings: Settings = request.app.state.settings
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind == TOML:
        source = Artefact(name="job.toml", media_type=TOML, content=body)
        tables = await read_body_in_turn(request.app, body, tables_of_toml, body, settings.most_depth)
        return RequestedJob(tables=tables, limits=settings.limits, source=source)
    if kind != JSON:
        raise HTTPException(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            f"a job must be sent as {JSON} or {TOML}; got {kind[:100] or 'no type'!r}; use one of these content types",
        )
    try:
        content = (
            request.scope[PARSED_BODY] if PARSED_BODY in request.scope else read_json(body, settings.most_depth)
        )  # without a body
        stated = Submission.model_validate(content)
    except ValidationError as error:
        errors = error.errors(include_url=False)
        raise RequestValidationError([{**details, "loc": ("body", *details["loc"])} for details in errors]) from None
    limits = job_limits_within_service_limits(stated.limits, settings.limits)
    tables = await read_body_in_turn(request.app, body, tables_with_sent_files, stated) if stated.files else stated.job
    return RequestedJob(tables=tables, priority=stated.priority, limits=limits, origin=stated.origin)


def tables_of_toml(body: bytes, most_depth: int) -> dict[str, Any]:
    """Return the tables of a job file in TOML. Raises `JobError`."""
    from ...optimise.job.job_file import toml_tables

    try:
        text = body.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise JobError("a job file must be UTF-8 text; got other bytes; save it as UTF-8") from None
    tables = toml_tables(text)
    try:
        require_shallow_and_portable(tables, most_depth)
    except InputError as error:
        raise JobError(str(error)) from None
    return tables


def tables_with_sent_files(stated: Submission) -> dict[str, Any]:
    """Return the tables of a job with the contents of the sent files inserted. Raises `JobError`."""
    from ...optimise.job import with_file_contents

    contents: dict[str, str | bytes] = {}
    for name, content in stated.files.items():
        mark, _, encoded = content.partition(";base64,")
        try:
            contents[name] = b64decode(encoded, validate=True) if mark.startswith("data:") and encoded else content
        except ValueError:
            raise JobError(f"files.{name[:60]}: must be text or base64; got neither; send it again") from None
    return with_file_contents(stated.job, contents)


def job_limits_within_service_limits(requested: RequestedLimits, allowed: Limits) -> Limits:
    """Return the limits of a job: the requested values, or else the maxima of the service.

    Raises `InputError` for values beyond the maxima.
    """
    limits = Limits(seconds=requested.seconds, evaluations=requested.evaluations, memory=requested.memory_bytes)
    for name, requested_value, highest in zip(
        RequestedLimits.model_fields, astuple(limits), astuple(allowed), strict=True
    ):
        if requested_value is not None and highest is not None and requested_value > highest:
            raise InputError(
                f"limits.{name}: must be at most {highest} here; got {requested_value}; ask for less, or leave it out"
            )
    return limits.stricter(allowed)


def problem_of_tables(
    tables: Mapping[str, Any],
    allowed: Collection[str],
    values: Mapping[str, Any] | None = None,
    *,
    require_feasible: bool = True,
) -> Problem:
    """Return the problem that a job defines.

    allowed: functions, "module:function", that it may use as custom quantities. values: replacements for numbers in the
    job, by path. require_feasible: whether to reject an infeasible job. Raises `JobError`, also for a job that
    names a missing file.
    """
    return with_time_limit_per_call(
        parse_with_allowed_functions(tables, allowed, values, require_feasible=require_feasible), LONGEST_WAIT
    )


def merge_patch(value: Any, changes: Any) -> Any:
    """Return a value with changes applied (RFC 7396): tables key by key, null removes, other values replace."""
    if not isinstance(changes, Mapping):
        return changes
    table = dict(value) if isinstance(value, Mapping) else {}
    for key, change in changes.items():
        if change is None:
            table.pop(key, None)
        else:
            table[key] = merge_patch(table.get(key), change)
    return table
