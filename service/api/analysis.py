"""Single designs: all their numbers, their curves over the cycle, and what-if."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ..designs.cycle_table import LEAST, MOST, cycle_table
from ..runs.result import Row, finite
from ..text.options import Dimensions, speed_option
from ..topics.design_analysis import analysis_of, numbers_of
from ..topics.discovery import ALL, TOPICS, chosen_topics
from .fronts import ColumnModel, OfDesign
from .job_requests import given_problem
from .models import Whole
from .problems import problem_responses
from .settings import SettingsDep
from .stored_fronts import DesignNumber, FrontDep
from .throttle import READING, SIMULATING

router = APIRouter(tags=["designs"], responses=problem_responses(409))

_LONGEST = 30.0  # s, for the topics of one design

Show = Annotated[
    list[Annotated[str, Field(max_length=500)]],
    Query(max_length=20, description=f"add a topic, or several: {', '.join(TOPICS)}, or {ALL}; repeatable"),
]
_EXAMPLE = {"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0, "time_ratio": 1.7, "slow_stroke": "inward"}


class AnalysisModel(BaseModel):
    """All numbers of a design.

    analysis: what `slidercrank analyse --json` prints: every quantity, and of every topic an object. notes: what is
    left out, and why.
    """

    analysis: dict[str, Any] = Field(examples=[_EXAMPLE])
    notes: list[str] = Field(examples=[[]])


class StoredAnalysisModel(OfDesign, AnalysisModel):
    """All numbers of a design of a front."""


class CycleModel(BaseModel):
    """Curves over a turn of the crank.

    columns: what the curves are. curves: values by column, all of one length; null where friction leaves a force
    undetermined. slow_stroke: outward, inward or equal.
    """

    inner_dead_centre_deg: float
    outer_dead_centre_deg: float
    slow_stroke: str = Field(examples=["inward"])
    columns: list[ColumnModel]
    curves: dict[str, list[float | None]] = Field(
        examples=[{"crank_angle_deg": [0.0, 90.0, 180.0, 270.0], "slider_position_mm": [100.8, 60.8, 20.8, 22.4]}]
    )


class CurvesModel(OfDesign, CycleModel):
    """Curves of a design of a front over a turn of the crank."""


class WhatIf(BaseModel, extra="forbid"):
    """A job, and the dimensions of a design. Dimensions that the job fixes need not be repeated.

    values: numbers of the job at other values, by their paths. show: topics to add.
    """

    job: dict[str, Any] = Field(description="the tables of a job file")
    crank: str | None = Field(None, max_length=100, examples=["40 mm"])
    rod: str | None = Field(None, max_length=100, examples=["64 mm"])
    offset: str | None = Field(None, max_length=100, examples=["20 mm"])
    speed: str | None = Field(None, max_length=100, examples=["300 rpm"])
    values: dict[str, float | str] = Field({}, examples=[{"mechanism.slider.mass": "1.2 kg"}])
    show: list[str] = Field([], max_length=20, examples=[["balance"]])


@router.get("/jobs/{number}/designs/{design}/analysis")
def analyse_design(found: FrontDep, design: DesignNumber, show: Show = []) -> StoredAnalysisModel:  # noqa: B006
    """Analyse a design of a front anew, for its job, with the choices and the varying numbers that it has."""
    topics = chosen_topics(show, job=True)
    stored = found.design(design)
    row = numbers_of(stored.mechanism, stored.values[:3], stored.part.own)
    record, notes = _with_topics(row, stored.mechanism, stored.linkage, topics, lenient=ALL in show)
    return StoredAnalysisModel(job=found.job.id, number=design, analysis=record, notes=notes)


@router.get("/jobs/{number}/designs/{design}/curves")
def show_curves(
    found: FrontDep,
    design: DesignNumber,
    angles: Annotated[Whole, Query(ge=LEAST, le=MOST, description="how many crank angles, evenly spaced")] = 360,
) -> CurvesModel:
    """Give slider motion, torque, transmission angle and joint forces over a turn of the crank, from 0 deg."""
    stored = found.design(design)
    cycle = cycle_model(stored.mechanism, stored.linkage, angles)
    return CurvesModel(job=found.job.id, number=design, **dict(cycle))


@router.post("/analyse")
def analyse_any(asked: WhatIf, settings: SettingsDep) -> AnalysisModel:
    """Analyse a design that need not be in any front: what if?"""
    topics = chosen_topics(asked.show, job=True)
    with READING:
        problem = given_problem(asked.job, settings.allowed_quantities, asked.values)
    mechanism = problem.mechanism.nominal
    if asked.speed is not None:
        mechanism = replace(mechanism, speed=speed_option(asked.speed))
    lengths = Dimensions(asked.crank, asked.rod, asked.offset).lengths(problem)
    row = numbers_of(mechanism, lengths, problem.own)
    linkage = Linkage(lengths[0], lengths[1], lengths[2], mechanism.branch)
    record, notes = _with_topics(row, mechanism, linkage, topics, lenient=ALL in asked.show)
    return AnalysisModel(analysis=record, notes=notes)


def cycle_model(mechanism: Mechanism, linkage: Linkage, angles: int) -> CycleModel:
    """Return the curves of a fully turning linkage as JSON has them."""
    inner, outer = (math.degrees(float(angle)) for angle in linkage.dead_centre_angles)
    table = cycle_table(mechanism, linkage, angles=angles)
    return CycleModel(
        inner_dead_centre_deg=inner,
        outer_dead_centre_deg=outer,
        slow_stroke=str(linkage.slow_stroke(direction=mechanism.speed or 1.0)),
        columns=[ColumnModel(key=column.key, title=column.title, unit=column.unit) for column in table],
        curves={column.key: finite(column.values) for column in table},
    )


def _with_topics(
    row: Row, mechanism: Mechanism, linkage: Linkage, topics: tuple[str, ...], *, lenient: bool
) -> tuple[dict[str, Any], list[str]]:
    """Return the record of a design with its topics, ready for JSON, and notes."""
    with SIMULATING.turn() if topics else nullcontext():
        analysed = analysis_of(row, mechanism, linkage, topics, cancelled=_over(_LONGEST), lenient=lenient)
    return finite(analysed.record()), analysed.notes


def _over(seconds: float) -> Callable[[], bool]:
    end = time.monotonic() + seconds
    return lambda: time.monotonic() > end
