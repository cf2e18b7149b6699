"""Fronts: the result of a job, one selected design, and its designs, filtered, sorted, by page or by column.

All data comes from the result of a job; nothing is computed.
"""

import gzip
import math
from collections.abc import Iterable, Sequence
from typing import Annotated, Any

from fastapi import APIRouter, Header, Query, Request, Response
from pydantic import BaseModel, BeforeValidator, Field
from pydantic_core import to_json

from ...model.errors import InfeasibleError, InputError
from ...optimise.job.named_files import table_in
from ..designs.columns import Column, all_columns, find_columns
from ..designs.design_selection_options import chosen_row
from ..designs.judged_requirements import front_violations_in_words, violations_in_words
from ..designs.selection import no_match_message, result_with_rows, rows_meeting_conditions
from ..page.router import response_with_etag
from ..runs.result import StoredObjective, json_ready
from .problem_documents import json_with_etag_options, problem_responses
from .settings import PLAIN_DIGITS, JobNumber, StoreDep
from .stored_fronts import DesignNumber, FrontDep, FrontsDep, StoredFront

router = APIRouter(tags=["fronts"], responses=problem_responses(409))

MOST_ROWS = 1000
_WORTHWHILE = 16_384
"""Bytes above which an answer is compressed. The fastest level takes 40 ms for 10,000 designs with 8 columns and halves
their size: worth doing once and caching, not per request."""
Cells = dict[str, float | str | None]
"""Design: numbers and words by column; null if undefined, "inf" and "-inf" for infinity."""

Where = Annotated[
    list[Annotated[str, Field(max_length=500)]],
    Query(
        max_length=50,
        description='only designs that meet it, such as "transmission_angle >= 40 deg" or "slow_stroke = inward"; '
        "repeatable",
    ),
]
Columns = Annotated[
    str | None, Query(max_length=2000, description="quantities or columns, separated by commas; all if left out")
]
_EXAMPLE: Cells = {"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0, "peak_torque_Nm": 1.8, "slow_stroke": "inward"}


class ColumnModel(BaseModel):
    """Column in a table of designs."""

    key: str = Field(examples=["peak_torque_Nm"])
    title: str = Field(examples=["peak drive torque"])
    unit: str = Field(examples=["N m"])
    group: str = Field("", description="group in which it is shown; none for a curve", examples=["Drive"])
    group_place: int = Field(0, description="position of the group among the others", examples=[3])


ViolatedOfAll = Annotated[
    dict[str, list[float | str]],
    Field(
        description="excess of each design over an allowable value, by column; 0 within it",
        examples=[{"pin_shear_crank_pin_MPa": [440.2, 0.0]}],
    ),
]


Violations = Annotated[
    list[str],
    Field(
        description="allowable values that are violated, a sentence each, in metric units",
        examples=[["shear of the crank pin is 642 MPa, 440 MPa more than the allowed 202 MPa (shear yield strength)"]],
    ),
]


class FrontModel(BaseModel):
    """Front found by a job, without its designs."""

    job: int = Field(examples=[7])
    run: str = Field(examples=["20261121-193012-feeder"])
    name: str = Field(examples=["Feeder"])
    status: str = Field(description="done, cancelled or infeasible", examples=["done"])
    message: str = Field(examples=["100 designs, 52428 evaluated"])
    count: int = Field(description="number of designs", examples=[100])
    columns: list[ColumnModel]
    objectives: list[StoredObjective]
    hypervolume: float | None = Field(examples=[0.731])
    evaluations: int = Field(examples=[52428])
    seconds: float | None = Field(examples=[1.4])
    seed: int = Field(examples=[1])
    extremes: dict[str, int] = Field(
        description="position of the best design in each objective, counted from 0", examples=[{"peak_torque": 99}]
    )
    knee: int | None = Field(description="position of the knee, counted from 0", examples=[41])
    trade_offs: list[str] = Field(
        description="trade-offs at the knee, in words",
        examples=[["1 deg more least transmission angle costs 0.8 N m more peak torque"]],
    )
    strokes_differ: bool = Field(
        False, description="whether one stroke of a design is more heavily loaded than the other"
    )
    warnings: list[str] = Field([], description="warnings about possible mistakes, in words", examples=[[]])
    violated: ViolatedOfAll = {}
    violations: Violations
    discrete: dict[str, Any] | None = Field(
        None,
        description="method that found designs with discrete values, and the best of each objective with "
        "continuous ones",
        examples=[{"how": "exact", "combinations": 9720, "judged": 9720, "values": {"crank": "multiples of 0.5 mm"}}],
    )
    extent_mm: tuple[float, float, float, float] | None = Field(
        None, description="left, bottom, right and top of all levers over their swings; null for other mechanisms"
    )


class OfDesign(BaseModel):
    """Fields common to all answers about a design on a front. number: counted from 1."""

    job: int = Field(examples=[7])
    number: int = Field(examples=[3])


class PickedModel(OfDesign):
    """Selected design. number: counted from 1."""

    number: int = Field(examples=[42])
    design: Cells = Field(examples=[{"crank_mm": 40.0, "peak_torque_Nm": 1.8, "slow_stroke": "inward"}])


class DesignsModel(BaseModel):
    """Page of designs. numbers: number of each design on its front, counted from 1, as on the command line."""

    job: int = Field(examples=[7])
    count: int = Field(description="number of designs on the front", examples=[100])
    chosen: int = Field(description="number of designs that meet the conditions", examples=[12])
    offset: int = Field(description="number of these designs that were skipped", examples=[0])
    columns: list[ColumnModel]
    numbers: list[int] = Field(examples=[[3]])
    designs: list[Cells] = Field(examples=[[_EXAMPLE]])
    violated: ViolatedOfAll


Violated = Annotated[
    dict[str, float | str],
    Field(
        description="excess of the design over each allowable value that it violates, by column",
        examples=[{"pin_shear_crank_pin_MPa": 440.2}],
    ),
]


class DesignModel(OfDesign):
    """Design with all its numbers."""

    columns: list[ColumnModel]
    design: Cells = Field(examples=[_EXAMPLE])
    violated: Violated
    violations: Violations


class ColumnsModel(BaseModel):
    """All values in some columns, in the order of the front; null if undefined, "inf" and "-inf" if infinite."""

    job: int = Field(examples=[7])
    count: int = Field(description="number of designs on the front", examples=[100])
    columns: list[ColumnModel]
    values: dict[str, list[float | str | None]] = Field(
        description="values by the key of the column, one for each design",
        examples=[{"crank_mm": [40.0, 41.5], "slow_stroke": ["inward", "inward"]}],
    )


@router.get("/jobs/{number}/front")
def show_front(number: JobNumber, store: StoreDep, fronts: FrontsDep) -> FrontModel:
    """Return how a front was found and its marked designs; all its designs are at `/jobs/{number}/designs`."""
    record = json_ready(store.result_record(number))
    columns = column_models(all_columns(record.pop("columns")))
    sentences = front_violations_in_words(fronts.front_of_job(number).result) if record.get("violated") else []
    is_lever = table_in(store.job_tables(number), "mechanism").get("inversion") is not None
    extent = fronts.front_of_job(number).extent_of_levers if is_lever and columns else None
    return FrontModel(**record, job=number, columns=columns, violations=sentences, extent_mm=extent)


@router.get("/jobs/{number}/pick")
def pick_design(
    stored_front: FrontDep,
    knee: Annotated[
        bool,
        BeforeValidator(lambda given: given == "" or given),
        Query(
            description="whether to choose the design nearest to the ideal, with objectives relative to their ranges"
        ),
    ] = False,
    topsis: Annotated[
        str | None,
        Query(max_length=2000, description='by weights of the objectives: "peak_torque=2, transmission_angle=1"'),
    ] = None,
    lexicographic: Annotated[
        str | None,
        Query(
            max_length=2000,
            description="objectives in order of rank, each with the amount that it may lose to improve the next: "
            '"peak_torque: 5 %, time_ratio: 0.02, transmission_angle"; % is of its range',
        ),
    ] = None,
    where: Where = [],  # noqa: B006 - the framework copies it
) -> PickedModel:
    """Select one of the designs that meet all conditions, by one of three methods."""
    result = stored_front.result
    if not (knee or topsis is not None or lexicographic is not None):
        raise InputError("a design must be chosen by knee, topsis or lexicographic; got none; give one")
    if not result.designs:
        raise InfeasibleError(result.message)
    rows = rows_meeting_conditions(result, where)
    row = chosen_row(result, rows, knee=knee, topsis=topsis, lexicographic=lexicographic)
    if row is None:
        raise InfeasibleError(no_match_message(result, where))
    return PickedModel(job=stored_front.job.id, number=row + 1, design=json_ready(result.designs[row]))


@router.get("/jobs/{number}/designs")
def list_designs(
    stored_front: FrontDep,
    where: Where = [],  # noqa: B006 - the framework copies it
    sort: Annotated[
        str | None,
        Query(
            max_length=200,
            description="quantity or column to sort by: best first for an objective, else smallest first",
        ),
    ] = None,
    reverse: Annotated[bool, Query(description="whether to reverse the order")] = False,
    columns: Columns = None,
    offset: Annotated[int, Query(ge=0, le=2**31, description="number of designs to skip"), PLAIN_DIGITS] = 0,
    limit: Annotated[int, Query(ge=1, le=MOST_ROWS, description="maximum number of designs"), PLAIN_DIGITS] = 100,
) -> DesignsModel:
    """Return the designs that meet all conditions, in the order of the front unless sorted."""
    result = stored_front.result
    chosen_columns = _requested_columns(stored_front, columns)
    chosen = rows_meeting_conditions(result, where, sort=sort, reverse=reverse)
    page = chosen[offset : offset + limit]
    return DesignsModel(
        job=stored_front.job.id,
        count=len(result.designs),
        chosen=len(chosen),
        offset=offset,
        columns=column_models(chosen_columns),
        numbers=[row + 1 for row in page],
        designs=[
            {column.key: json_ready(result.designs[row][column.key]) for column in chosen_columns} for row in page
        ],
        violated=json_ready(result_with_rows(result, page).violated),
    )


@router.get("/jobs/{number}/designs/{design}")
def show_design(stored_front: FrontDep, design: DesignNumber) -> DesignModel:
    """Return all numbers for a design, by its number on the front."""
    row = stored_front.row_of_design(design)
    violated = {key: excess for key, [excess] in result_with_rows(stored_front.result, [design - 1]).violated.items()}
    return DesignModel(
        job=stored_front.job.id,
        number=design,
        columns=column_models(stored_front.columns),
        design=json_ready(row),
        violated=json_ready(violated),
        violations=violations_in_words(violated, row),
    )


@router.get("/jobs/{number}/columns", **json_with_etag_options(ColumnsModel, "The values of every design"))
def list_columns(
    request: Request,
    stored_front: FrontDep,
    columns: Columns = None,
    accept_encoding: Annotated[str, Header(include_in_schema=False)] = "",
) -> Response:
    """Return columns of the designs, each as one array over all designs: compact even for a front of 10,000."""
    chosen_columns = _requested_columns(stored_front, columns)

    def respond() -> Response:
        compressed = "gzip" in accept_encoding and "gzip;q=0" not in accept_encoding.replace(" ", "")
        name, kind = ",".join(column.key for column in chosen_columns), "gzip" if compressed else "plain"
        content = stored_front.cached_item(
            name, kind, lambda: ([name], _columns_json(stored_front, chosen_columns, compressed=compressed))
        )
        headers = {"Content-Encoding": "gzip"} if content.startswith(b"\x1f\x8b") else None
        return Response(content, media_type="application/json", headers=headers)

    # The result of a job only changes if the job is resumed; its end time then changes too.
    tag = None if stored_front.job.finished is None else f'"{stored_front.job.id}-{stored_front.job.finished}"'
    return response_with_etag(request, tag, respond, {"Vary": "Accept-Encoding"})


def _requested_columns(stored_front: StoredFront, columns: str | None) -> Sequence[Column]:
    """Return the columns in a list of names without duplicates, or all columns if there is no list."""
    if columns is None or not stored_front.result.designs:
        return stored_front.columns
    return list({column.key: column for column in find_columns(columns, list(stored_front.result.designs[0]))}.values())


def _columns_json(stored_front: StoredFront, chosen_columns: Sequence[Column], *, compressed: bool) -> bytes:
    rows = stored_front.result.designs
    values = {column.key: [row[column.key] for row in rows] for column in chosen_columns}
    for key, cells in values.items():
        if math.inf in cells or -math.inf in cells:
            values[key] = json_ready(cells)
    record = {
        "job": stored_front.job.id,
        "count": len(rows),
        "columns": [column.model_dump() for column in column_models(chosen_columns)],
        "values": values,
    }
    content = to_json(record, inf_nan_mode="null")
    return gzip.compress(content, compresslevel=1, mtime=0) if compressed and len(content) > _WORTHWHILE else content


def column_models(columns: Iterable[Column]) -> list[ColumnModel]:
    """Return columns as JSON."""
    return [
        ColumnModel(
            key=column.key,
            title=column.title,
            unit=column.unit,
            group="" if column.group is None else column.group.value,
            group_place=0 if column.group is None else list(type(column.group)).index(column.group),
        )
        for column in columns
    ]
