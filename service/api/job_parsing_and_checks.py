"""Job files before a run: schema, included jobs, reading, checking and writing.

Nothing is queued, and no file on the server is read.
"""

from collections.abc import Mapping
from functools import cache
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Response
from pydantic import BaseModel, Field

from ...model.linkage.linkage import Linkage
from ...optimise.job import job_schema, parse_job
from ...optimise.problem.problem import Problem
from ..presets.jobs import DESIGNS, Design, shipped_jobs
from .computing import QuickRoute
from .cycle import OutlinesModel, outlines_model
from .job_requests import EXAMPLE, TOML, RequestedJob, job_in_request, problem_of_tables
from .problem_documents import problem_responses
from .settings import SettingsDep

router = APIRouter(route_class=QuickRoute, tags=["jobs"])


class PresetDesign(BaseModel):
    """Linkage near the knee of an included job's front. from_deg, to_deg: swing range of the crank.

    outlines: outlines of the moving parts, for a drawing.
    """

    crank_mm: float = Field(examples=[37.62])
    rod_mm: float = Field(examples=[101.71])
    offset_mm: float = Field(examples=[31.78])
    from_deg: float | None = Field(examples=[None])
    to_deg: float | None = Field(examples=[None])
    outlines: OutlinesModel


class PresetModel(BaseModel):
    """Included job. name: as in the page address. design: an example that shows the type of machine."""

    name: str = Field(examples=["feeder"])
    title: str = Field(examples=["Feeder with rod = 3.2 offset"])
    sentence: str = Field(examples=["Quick-return feeder, 80 to 90 mm of stroke at 2400 rpm."])
    job: dict[str, Any] = Field(description="tables of the job", examples=[EXAMPLE])
    design: PresetDesign


class PresetList(BaseModel):
    """The shipped jobs."""

    presets: list[PresetModel]


class Tables(BaseModel, extra="forbid", strict=True):
    """Tables of a job."""

    job: dict[str, Any] = Field(description="the tables of a job file", examples=[EXAMPLE])


class CatalogueText(BaseModel, extra="forbid", strict=True):
    """Catalogue as a table. own: names of the job's custom quantities, which it may limit."""

    table: str = Field(
        max_length=10_000_000,
        description="CSV with one row per option and units in the header",
        examples=["name,peak_torque max (N m)\nGM 40,40\nGM 90,90\n"],
    )
    own: list[str] = Field(default=[], max_length=100, examples=[["clearance"]])


class CatalogueModel(BaseModel):
    """Options of a choice, as in a job; dominated options are only named. rows: number of table rows."""

    option: list[dict[str, Any]] = Field(examples=[[{"name": "GM 40", "constraints": {}}]])
    rows: int = Field(examples=[3])


class FloorModel(BaseModel):
    """Minimum allowed value of a quantity, from the job or by default."""

    quantity: str = Field(examples=["self_locking_margin"])
    least: float = Field(description="least allowed value, in the unit", examples=[5.0])
    unit: str = Field(examples=["deg"])
    is_default: bool = Field(description="whether this is the default, used because the job sets none", examples=[True])


class ChangeModel(BaseModel):
    """Change to a job that resolves a warning. path: key in its tables. value: null removes the key."""

    sentence: str = Field(examples=["no crank within these ranges rotates fully: ..."])
    path: str = Field(examples=["variables.rod"])
    value: Any = Field(examples=[["60 mm", "125 mm"]])
    label: str = Field(examples=["Allow rods up to 125 mm"])


class Understood(BaseModel):
    """Job in words, as the service understood it."""

    name: str = Field(examples=["Feeder"])
    given: list[str] = Field(examples=[["crank speed 2400 rpm (counter-clockwise)"]])
    loads: list[str] = Field(
        description="size, sign, effect and range of each load",
        examples=[["200 N inward, resists the outward stroke, throughout"]],
    )
    files: list[str] = Field(description="summary of each file that the job names", examples=[[]])
    tolerances: list[str] = Field(examples=[["crank 0.05 mm"]])
    costs: list[str] = Field(examples=[[]])
    variables: list[str] = Field(examples=[["crank 20 to 60 mm"]])
    rules: list[str] = Field(examples=[["rod to offset 3.2"]])
    floors: list[FloorModel] = Field(description="least allowed values, of the job or by default", examples=[[]])
    objectives: list[str] = Field(examples=[["minimise peak torque"]])
    unknowns: int = Field(examples=[3])
    degrees_of_freedom: int = Field(examples=[2])
    eliminated: list[str] = Field(examples=[["rod_to_offset"]])
    warnings: list[str] = Field(description="warnings about possible mistakes", examples=[[]])
    changes: list[ChangeModel] = Field(description="changes that resolve warnings", examples=[[]])
    notes: list[str] = Field(description="notes on common omissions", examples=[[]])
    search: str = Field(examples=["auto, at most 100 designs, seed 1"])


@router.get("/presets")
@cache
def list_presets() -> PresetList:
    """Return the included jobs to start from."""
    return PresetList(
        presets=[
            PresetModel(
                name=name,
                title=job["name"],
                sentence=job.get("description", ""),
                job=job,
                design=_preset_design(job, DESIGNS[name]),
            )
            for name, job in shipped_jobs().items()
        ]
    )


def _preset_design(job: dict[str, Any], design: Design) -> PresetDesign:
    """Return the example design of an included job with its outlines for a drawing."""
    problem = parse_job(job)
    machine = problem.mechanism.nominal
    linkage = Linkage(1e-3 * design.crank_mm, 1e-3 * design.rod_mm, 1e-3 * design.offset_mm, machine.branch)
    return PresetDesign(**design._asdict(), outlines=outlines_model(machine, linkage, problem.motion))


@router.post("/parse", responses=problem_responses(415))
def parse_file(request: Annotated[RequestedJob, Depends(job_in_request)]) -> Tables:
    """Return the tables of a job file that is sent as for a submission. The validity of the job is not checked."""
    return Tables(job=dict(request.tables))


@router.post("/catalogue")
def read_catalogue(catalogue_text: CatalogueText) -> CatalogueModel:
    """Return the options of a catalogue that is sent as a table, without rows that no design can need."""
    from ...optimise.job.catalogue import read_catalogue

    catalogue = read_catalogue(catalogue_text.table, "the table", frozenset(catalogue_text.own))
    return CatalogueModel(option=catalogue.options, rows=catalogue.rows)


@router.post(
    "/toml",
    response_class=Response,
    responses={200: {"description": "A job file", "content": {TOML: {"schema": {"type": "string"}}}}},
)
def write_file(tables: Tables) -> Response:
    """Return the tables of a job as a TOML job file; reading it gives the same tables."""
    from ...optimise.job.job_file import require_few_values
    from ..jobs.job_toml import job_toml

    require_few_values(tables.job)
    return Response(job_toml(tables.job), media_type=TOML)


@router.get("/schema")
def show_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a job, with a description and examples for every key."""
    return job_schema()


@router.post("/check", responses=problem_responses(415))
def check_job(request: Annotated[RequestedJob, Depends(job_in_request)], settings: SettingsDep) -> Understood:
    """Check a job and return in words how it was understood; nothing is queued. The job is sent as for a submission."""
    return describe_problem(problem_of_tables(request.tables, settings.allowed_quantities), request.tables)


def describe_problem(problem: Problem, tables: Mapping[str, Any]) -> Understood:
    """Return a problem in words, as understood from its tables."""
    from ..text.job_in_words import job_in_words

    return Understood(**job_in_words(problem, tables))
