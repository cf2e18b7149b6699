"""Jobs that clients send: JSON with options or a job file, their content, the problem they state."""

from __future__ import annotations

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
from ..jobs.submission import LONGEST_ANSWER, bounded, parse_allowed
from ..store import NO_LIMITS, Artefact, Limits
from .models import LARGEST
from .settings import Settings
from .strict_input import GIVEN, in_turn, read_json, require_moderate

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
"""A job that can be solved."""
Priority = Annotated[int, Field(ge=-1000, le=1000, description="higher ones are solved first")]
IdempotencyKey = Annotated[
    str | None,
    Header(
        min_length=1,
        max_length=255,
        pattern="^[!-~]+$",
        description="of this submission: sent again with it, the same job is answered and none is added",
        examples=["4c7a1f0e-feeder"],
    ),
]
"""The header of a submission."""


class AskedLimits(BaseModel, extra="forbid", strict=True):
    """Limits that a client asks for a job; the service's own hold where one is left out."""

    seconds: float | None = Field(None, gt=0, le=LARGEST, description="of its search, s", examples=[600])
    evaluations: int | None = Field(None, gt=0, le=LARGEST, description="designs that its search evaluates")
    memory_bytes: int | None = Field(None, gt=0, le=LARGEST, description="of its worker")


class Submission(BaseModel, extra="forbid", strict=True):
    """A job and how it is to be solved."""

    job: dict[str, Any] = Field(description="the tables of a job file, see GET /api/v1/schema", examples=[EXAMPLE])
    files: dict[str, str] = Field(
        default={},
        max_length=100,
        description="contents of the files that the job names, by name: texts, or bytes as data:text/csv;base64,...",
        examples=[{"trace.csv": "crank angle (deg),force (N)\n0,-200\n180,0\n"}],
    )
    priority: Priority = 0
    limits: AskedLimits = AskedLimits()
    origin: int | None = Field(
        None,
        ge=1,
        le=LARGEST,
        description="the job that it is a changed copy of, left out once that is gone",
        examples=[1],
    )


class Clone(BaseModel, extra="forbid", strict=True):
    """The changes in a copy of a job."""

    changes: dict[str, Any] = Field(
        default_factory=dict,
        description="to the tables of the job, as a JSON merge patch (RFC 7396): null takes a key away",
        examples=[{"name": "Feeder, heavier", "mechanism": {"slider": {"mass": "2.5 kg"}}}],
    )
    priority: Priority | None = Field(None, description="that of the job if left out")
    limits: AskedLimits | None = Field(None, description="those of the job if left out")


@dataclass(frozen=True, kw_only=True)
class Asked:
    """A submission that was read. source: the job file, if one was sent. origin: the job that it is a copy of."""

    tables: Mapping[str, Any]
    priority: int = 0
    limits: Limits = NO_LIMITS
    source: Artefact | None = None
    origin: int | None = None


async def asked_for(request: Request) -> Asked:
    """Return the submission that a request contains; a dependency. Raises the errors that become 400, 415 or 422."""
    body = await request.body()
    settings: Settings = request.app.state.settings
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind == TOML:
        source = Artefact(name="job.toml", media_type=TOML, content=body)
        tables = await in_turn(request.app, body, tables_of, body, settings.most_depth)
        return Asked(tables=tables, limits=settings.limits, source=source)
    if kind != JSON:
        raise HTTPException(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            f"a job must be sent as {JSON} or {TOML}; got {kind[:100] or 'no type'!r}; use one of these content types",
        )
    try:
        given = request.scope[GIVEN] if GIVEN in request.scope else read_json(body, settings.most_depth)  # of no body
        stated = Submission.model_validate(given)
    except ValidationError as error:
        found = error.errors(include_url=False)
        raise RequestValidationError([{**one, "loc": ("body", *one["loc"])} for one in found]) from None
    limits = within(stated.limits, settings.limits)
    tables = await in_turn(request.app, body, filled, stated) if stated.files else stated.job
    return Asked(tables=tables, priority=stated.priority, limits=limits, origin=stated.origin)


def tables_of(body: bytes, most_depth: int) -> dict[str, Any]:
    """Return the tables of a job file in TOML. Raises `JobError`."""
    from ...optimise.job.file import toml_tables

    try:
        text = body.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise JobError("a job file must be UTF-8 text; got other bytes; save it as UTF-8") from None
    tables = toml_tables(text)
    try:
        require_moderate(tables, most_depth)
    except InputError as error:
        raise JobError(str(error)) from None
    return tables


def filled(stated: Submission) -> dict[str, Any]:
    """Return the tables of a job with the contents of the files that were sent in their place. Raises `JobError`."""
    from ...optimise.job import with_files

    contents: dict[str, str | bytes] = {}
    for name, content in stated.files.items():
        mark, _, encoded = content.partition(";base64,")
        try:
            contents[name] = b64decode(encoded, validate=True) if mark.startswith("data:") and encoded else content
        except ValueError:
            raise JobError(f"files.{name[:60]}: must be a text or base64; got a broken one; send it again") from None
    return with_files(stated.job, contents)


def within(asked: AskedLimits, most: Limits) -> Limits:
    """Return limits of a job: those asked for, else the highest of the service. Raises `InputError` for higher ones."""
    limits = Limits(seconds=asked.seconds, evaluations=asked.evaluations, memory=asked.memory_bytes)
    for name, wanted, highest in zip(AskedLimits.model_fields, astuple(limits), astuple(most), strict=True):
        if wanted is not None and highest is not None and wanted > highest:
            raise InputError(
                f"limits.{name}: must be at most {highest} here; got {wanted}; ask for less, or leave it out"
            )
    return limits.within(most)


def given_problem(
    tables: Mapping[str, Any],
    allowed: Collection[str],
    values: Mapping[str, Any] | None = None,
    *,
    require_feasible: bool = True,
) -> Problem:
    """Return the problem that a job states.

    allowed: functions, "module:function", that it may name as quantities. values: numbers to put in place of those
    that it gives, by their paths. require_feasible: whether a job that no design can meet is refused. Raises
    `JobError`, also for a job that names a file that was not sent.
    """
    return bounded(parse_allowed(tables, allowed, values, require_feasible=require_feasible), LONGEST_ANSWER)


def merged(value: Any, changes: Any) -> Any:
    """Return a value with changes applied (RFC 7396): tables key by key; null removes a key; all else replaces it."""
    if not isinstance(changes, Mapping):
        return changes
    kept = dict(value) if isinstance(value, Mapping) else {}
    for key, change in changes.items():
        if change is None:
            kept.pop(key, None)
        else:
            kept[key] = merged(kept.get(key), change)
    return kept
