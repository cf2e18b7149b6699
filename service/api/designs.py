"""Designs of a front: filtered, sorted, page by page, or one."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ..designs.columns import find_columns
from ..designs.selection import chosen_rows
from ..runs.result import finite
from .fronts import Cells, ColumnModel, Where, column_model
from .models import Whole
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(tags=["fronts"], responses=problem_responses(409))

MOST_ROWS = 1000

_EXAMPLE: Cells = {"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0, "peak_torque_Nm": 1.8, "slow_stroke": "inward"}


class DesignsModel(BaseModel):
    """A page of designs. numbers: of each in its front, counted from 1, as on the command line."""

    job: int = Field(examples=[7])
    count: int = Field(description="how many designs the front has", examples=[100])
    chosen: int = Field(description="how many of them meet the conditions", examples=[12])
    offset: int = Field(description="how many of those were passed over", examples=[0])
    columns: list[ColumnModel]
    numbers: list[int] = Field(examples=[[3]])
    designs: list[Cells] = Field(examples=[[_EXAMPLE]])


class DesignModel(BaseModel):
    """A design with all its numbers."""

    job: int = Field(examples=[7])
    number: int = Field(examples=[3])
    columns: list[ColumnModel]
    design: Cells = Field(examples=[_EXAMPLE])


@router.get("/jobs/{number}/designs")
def list_designs(
    found: FrontDep,
    where: Where = [],  # noqa: B006 - the framework copies it
    sort: Annotated[
        str | None,
        Query(max_length=200, description="a quantity or column: best first for an objective, else smallest first"),
    ] = None,
    reverse: Annotated[bool, Query(description="turn the order round")] = False,
    columns: Annotated[
        str | None, Query(max_length=2000, description="quantities or columns, separated by commas; all if left out")
    ] = None,
    offset: Annotated[Whole, Query(ge=0, le=2**31, description="pass over so many designs")] = 0,
    limit: Annotated[Whole, Query(ge=1, le=MOST_ROWS, description="at most so many designs")] = 100,
) -> DesignsModel:
    """Give the designs that meet all conditions, in the order of the front unless sorted."""
    result = found.result
    shown = found.columns
    if columns is not None and result.designs:
        shown = list({column.key: column for column in find_columns(columns, list(result.designs[0]))}.values())
    chosen = chosen_rows(result, where, sort=sort, reverse=reverse)
    page = chosen[offset : offset + limit]
    return DesignsModel(
        job=found.job.id,
        count=len(result.designs),
        chosen=len(chosen),
        offset=offset,
        columns=[column_model(column) for column in shown],
        numbers=[row + 1 for row in page],
        designs=[{column.key: finite(result.designs[row][column.key]) for column in shown} for row in page],
    )


@router.get("/jobs/{number}/designs/{design}")
def show_design(found: FrontDep, design: DesignNumber) -> DesignModel:
    """Give all numbers of a design, by its number in the front."""
    row = found.row(design)
    return DesignModel(
        job=found.job.id, number=design, columns=[column_model(column) for column in found.columns], design=finite(row)
    )
