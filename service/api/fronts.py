"""Fronts: what a job found, without its designs, and one design chosen from it."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import BaseModel, BeforeValidator, Field

from ...model.errors import InputError, NotFound
from ..designs.columns import Column, find_column
from ..designs.picking_options import picked_row
from ..designs.selection import chosen_rows, none_meets
from ..runs.result import finite
from .models import JobNumber
from .problems import problem_responses
from .settings import StoreDep
from .stored_fronts import FrontDep

router = APIRouter(tags=["fronts"], responses=problem_responses(409))

Cells = dict[str, float | str | None]
"""A design: numbers and words by column; null for what is infinite or not defined."""

Where = Annotated[
    list[Annotated[str, Field(max_length=500)]],
    Query(
        max_length=50,
        description='only designs that meet it, such as "transmission_angle >= 40 deg" or "slow_stroke = inward"; '
        "repeatable",
    ),
]


class ObjectiveModel(BaseModel):
    """An objective. column: its key in the designs. target: in `unit`, if the sense is "target"."""

    quantity: str = Field(examples=["peak_torque"])
    sense: str = Field(examples=["minimise"])
    column: str = Field(examples=["peak_torque_Nm"])
    title: str = Field(examples=["peak drive torque"])
    unit: str = Field(examples=["N m"])
    target: float | None = None


class ColumnModel(BaseModel):
    """A column of the designs."""

    key: str = Field(examples=["peak_torque_Nm"])
    title: str = Field(examples=["peak drive torque"])
    unit: str = Field(examples=["N m"])
    group: str = Field("", description="that it is shown in; none for a curve", examples=["Drive"])
    group_place: int = Field(0, description="of the group among the others", examples=[3])


class FrontModel(BaseModel):
    """The front that a job found, without its designs."""

    job: int = Field(examples=[7])
    run: str = Field(examples=["20261121-193012-feeder"])
    name: str = Field(examples=["Feeder"])
    status: str = Field(description="done, cancelled or infeasible", examples=["done"])
    message: str = Field(examples=["100 designs, 52428 evaluated"])
    count: int = Field(description="how many designs there are", examples=[100])
    columns: list[ColumnModel]
    objectives: list[ObjectiveModel]
    hypervolume: float | None = Field(examples=[0.731])
    evaluations: int = Field(examples=[52428])
    seconds: float | None = Field(examples=[1.4])
    seed: int = Field(examples=[1])
    extremes: dict[str, int] = Field(
        description="position of the best design in each objective, counted from 0", examples=[{"peak_torque": 99}]
    )
    knee: int | None = Field(description="position of the knee, counted from 0", examples=[41])
    trade_offs: list[str] = Field(
        description="at the knee", examples=[["1 deg more least transmission angle costs 0.8 N m more peak torque"]]
    )
    strokes_differ: bool = Field(False, description="whether a stroke of a design is loaded more than the other")
    warnings: list[str] = Field([], description="of what may not have been meant, in words", examples=[[]])


class OfDesign(BaseModel):
    """Part of every answer about a design of a front. number: counted from 1."""

    job: int = Field(examples=[7])
    number: int = Field(examples=[3])


class PickedModel(OfDesign):
    """A design that was chosen. number: counted from 1."""

    number: int = Field(examples=[42])
    design: Cells = Field(examples=[{"crank_mm": 40.0, "peak_torque_Nm": 1.8, "slow_stroke": "inward"}])


@router.get("/jobs/{number}/front")
def show_front(number: JobNumber, store: StoreDep) -> FrontModel:
    """Give how a front was found and what is marked in it; its designs are at `/jobs/{number}/designs`."""
    record = finite(store.record(number))
    keys = record.pop("columns")
    return FrontModel(**record, job=number, columns=[column_model(find_column(key, keys)) for key in keys])


@router.get("/jobs/{number}/pick")
def pick_design(
    found: FrontDep,
    knee: Annotated[
        bool,
        BeforeValidator(lambda given: given == "" or given),
        Query(description="the nearest to the ideal, objectives by their range"),
    ] = False,
    topsis: Annotated[
        str | None,
        Query(max_length=2000, description='by weights of the objectives: "peak_torque=2, transmission_angle=1"'),
    ] = None,
    lexicographic: Annotated[
        str | None,
        Query(
            max_length=2000,
            description="by ranked objectives, each with what it may give up for the next: "
            '"peak_torque: 5 %, time_ratio: 0.02, transmission_angle"; % is of its range',
        ),
    ] = None,
    where: Where = [],  # noqa: B006 - the framework copies it
) -> PickedModel:
    """Choose among the designs that meet all conditions, in one of three ways."""
    result = found.result
    if not (knee or topsis is not None or lexicographic is not None):
        raise InputError("a design is chosen by knee, topsis or lexicographic; got none of them; give one")
    if not result.designs:
        raise NotFound(result.message)
    rows = chosen_rows(result, where)
    row = picked_row(result, rows, knee=knee, topsis=topsis, lexicographic=lexicographic)
    if row is None:
        raise NotFound(none_meets(result, where))
    return PickedModel(job=found.job.id, number=row + 1, design=finite(result.designs[row]))


def column_model(column: Column) -> ColumnModel:
    """Return a column as JSON has it."""
    return ColumnModel(
        key=column.key,
        title=column.title,
        unit=column.unit,
        group="" if column.group is None else column.group.value,
        group_place=0 if column.group is None else list(type(column.group)).index(column.group),
    )
