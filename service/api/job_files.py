"""Job files for forms: the shipped ones, reading one, writing one. Nothing is queued, no file of the service read."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Response
from pydantic import BaseModel, Field

from .. import presets
from .job_requests import EXAMPLE, TOML, Asked, asked_for
from .problems import problem_responses

router = APIRouter(tags=["jobs"])


class PresetModel(BaseModel):
    """A shipped job. name: as in an address of the page."""

    name: str = Field(examples=["feeder"])
    title: str = Field(examples=["Feeder with rod = 3.2 offset"])
    sentence: str = Field(examples=["Quick-return feeder, 80 to 90 mm of stroke at 2400 rpm."])
    job: dict[str, Any] = Field(description="its tables", examples=[EXAMPLE])


class PresetList(BaseModel):
    """The shipped jobs."""

    presets: list[PresetModel]


class Tables(BaseModel, extra="forbid", strict=True):
    """The tables of a job."""

    job: dict[str, Any] = Field(description="the tables of a job file", examples=[EXAMPLE])


@router.get("/presets")
def list_presets() -> PresetList:
    """Give the shipped jobs, to start from."""
    return _presets()


@cache
def _presets() -> PresetList:
    """Return the files of runs/, which every installation carries."""
    jobs = {
        file.name.removesuffix(".toml"): tomllib.loads(file.read_text(encoding="utf-8"))
        for file in files(presets).iterdir()
        if file.name.endswith(".toml")
    }
    return PresetList(
        presets=[
            PresetModel(name=name, title=job["name"], sentence=job.get("description", ""), job=job)
            for name, job in sorted(jobs.items())
        ]
    )


@router.post("/parse", responses=problem_responses(415))
def parse_file(asked: Annotated[Asked, Depends(asked_for)]) -> Tables:
    """Give the tables of a job file, which is sent as for a submission. Whether the job is valid is not checked."""
    return Tables(job=dict(asked.tables))


@router.post(
    "/toml",
    response_class=Response,
    responses={200: {"description": "A job file", "content": {TOML: {"schema": {"type": "string"}}}}},
)
def write_file(given: Tables) -> Response:
    """Give the tables of a job as a job file in TOML; reading it gives the same tables."""
    from ...optimise.job.file import require_few
    from ..jobs.job_toml import job_toml

    require_few(given.job)
    return Response(job_toml(given.job), media_type=TOML)
