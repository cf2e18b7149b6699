"""Single designs: their numbers, curves, requirements and trade-offs; other lengths, and designs of no front."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.quantity import Quantity
from ..designs.columns import all_columns
from ..designs.cycle_table import LEAST, MOST
from ..designs.holding import held
from ..designs.requirements import names_of, ranges_of, requirements_of, speed_rpm
from ..designs.trade_offs import trade_offs_of
from ..designs.turning import require_turning
from ..designs.variation import variation_of, with_numbers
from ..designs.violations import violated_by, violations_in_words
from ..runs.result import json_ready
from ..text.options import Dimensions, speed_option
from ..topics.design_analysis import analysis_of, determined, numbers_of, numbers_of_swing
from ..topics.discovery import ALL, TOPICS, chosen_topics
from .cycle import CurvesModel, CycleModel, cycle_model
from .fronts import Cells, ColumnModel, OfDesign, Violated, Violations, column_models
from .job_requests import given_problem
from .models import PLAIN_DIGITS, UnitsAsked
from .problems import problem_responses
from .settings import SettingsDep
from .stored_fronts import LONGEST, DesignNumber, FrontDep, Length
from .throttle import READING, SIMULATING

router = APIRouter(tags=["designs"], responses=problem_responses(409))

LONGEST_TOPICS = 30.0
"""s, for the topics of one design."""
_MOST_NUMBERS = 20

Show = Annotated[
    list[Annotated[str, Field(max_length=500)]],
    Query(max_length=20, description=f"add a topic, or several: {', '.join(TOPICS)}, or {ALL}; repeatable"),
]
_EXAMPLE = {"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0, "time_ratio": 1.7, "slow_stroke": "inward"}


class AnalysisModel(BaseModel):
    """All numbers of a design.

    analysis: what `slidercrank analyse --json` prints: every quantity, of every topic an object, and as `violated` by
    how much the design goes beyond allowable values. notes: what is left out, and why.
    """

    analysis: dict[str, Any] = Field(examples=[_EXAMPLE])
    notes: list[str] = Field(examples=[[]])


class StoredAnalysisModel(OfDesign, AnalysisModel):
    """All numbers of a design of a front."""


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


class RequirementModel(BaseModel):
    """A quantity that must lie between two values, in its unit; null leaves a side open.

    column: its key in the designs. slack: the key of the distance to the nearer bound, less than 0 where it is broken.
    """

    quantity: str = Field(examples=["transmission_angle"])
    column: str = Field(examples=["least_transmission_angle_deg"])
    title: str = Field(examples=["least transmission angle"])
    unit: str = Field(examples=["deg"])
    lower: float | None = Field(examples=[40.0])
    upper: float | None = Field(examples=[None])
    slack: str = Field(examples=["slack_least_transmission_angle_deg"])


class RequirementsModel(OfDesign):
    """The requirements of a job on a design, with the choices that the design made.

    ranges: least and greatest of crank, rod, offset and the numbers that vary besides, by column. speed_rpm: of its
    crank, positive counter-clockwise.
    names: of quantities, as in job files, by column. tolerances: whether the machine has any.
    """

    ranges: dict[str, tuple[float, float]] = Field(examples=[{"crank_mm": (20.0, 60.0)}])
    requirements: list[RequirementModel]
    slow_stroke: str | None = Field(None, description="the stroke that must be the slow one", examples=["outward"])
    speed_rpm: float = Field(examples=[300.0])
    tolerances: bool
    names: dict[str, str] = Field(examples=[{"peak_torque_Nm": "peak_torque"}])


class TradeOffsModel(OfDesign):
    """Trade-offs of a design: the cost of one objective in the others, in words.

    note: why there is nothing, or empty.
    """

    trade_offs: list[str] = Field(examples=[["1 deg more least transmission angle costs 0.8 N m more peak torque"]])
    note: str = Field(examples=[""])


class OtherLengths(BaseModel, extra="forbid", strict=True):
    """Lengths for a design of a front. values: other numbers that vary, by column, within their ranges.

    angles: of its curves, evenly spaced; 0 for none.

    hold: the length that was moved, so that the others follow and the rules that ask for exact values still hold; null
    to take the lengths as they are.
    """

    crank_mm: Length = Field(examples=[40.0])
    rod_mm: Length = Field(examples=[64.0])
    offset_mm: float = Field(ge=-LONGEST, le=LONGEST, allow_inf_nan=False, examples=[20.0])
    values: dict[Annotated[str, Field(max_length=500)], Annotated[float, Field(allow_inf_nan=False)]] = Field(
        {}, max_length=200, examples=[{}]
    )
    angles: int = Field(180, ge=0, le=MOST)
    hold: Literal["crank", "rod", "offset"] | None = None


class WhatIfModel(OfDesign):
    """A design with other lengths, beside its front.

    design: every quantity and the slacks; undefined: why some of them have no value, by column. broken: columns of the
    requirements that it does not meet. outside: columns of lengths that leave their range. dominated_by: numbers of
    designs of the front that are as good in every objective and better in one; dominates: of those that it beats so;
    the greatest difference first, at most 20. violated, violations: as of a design of the front. cycle: null if no
    curves were asked for.
    """

    columns: list[ColumnModel]
    design: Cells = Field(examples=[{"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0, "peak_torque_Nm": 1.8}])
    undefined: dict[str, str] = Field(examples=[{"position_error_mm": "a position error comes from tolerances"}])
    broken: list[str] = Field(examples=[["stroke_mm"]])
    outside: list[str] = Field(examples=[[]])
    violated: Violated
    violations: Violations
    dominated_by: list[int] = Field(examples=[[12, 4]])
    dominated_by_count: int = Field(examples=[2])
    dominates: list[int] = Field(examples=[[]])
    dominates_count: int = Field(examples=[0])
    cycle: CycleModel | None


@router.get("/jobs/{number}/designs/{design}/analysis")
def analyse_design(found: FrontDep, design: DesignNumber, show: Show = []) -> StoredAnalysisModel:  # noqa: B006
    """Analyse a design of a front anew, for its job, with the choices and the varying numbers that it has."""
    topics = chosen_topics(show, job=True)
    stored = found.design(design)
    if stored.part.motion is not None:
        if topics:
            require_turning(stored.part, f"the analysis {', '.join(topics)}")
        row, undefined = numbers_of_swing(stored)
        record = json_ready(row | {"violated": violated_by(stored.mechanism, row), "undefined": undefined})
        return StoredAnalysisModel(job=found.job.id, number=design, analysis=record, notes=[])
    record, notes = _with_topics(stored.mechanism, stored.linkage, topics, stored.part.own, lenient=ALL in show)
    return StoredAnalysisModel(job=found.job.id, number=design, analysis=record, notes=notes)


@router.get("/jobs/{number}/designs/{design}/curves")
def show_curves(
    found: FrontDep,
    design: DesignNumber,
    angles: Annotated[
        int,
        Query(ge=LEAST, le=MOST, description="number of evenly spaced crank angles, or of times for a swing"),
        PLAIN_DIGITS,
    ] = 360,
) -> CurvesModel:
    """Give slider motion, drive, transmission angle and joint forces over the cycle: see the answer's description."""
    return CurvesModel(job=found.job.id, number=design, **dict(cycle_model(found.design(design), angles)))


@router.post("/analyse")
def analyse_any(asked: WhatIf, settings: SettingsDep) -> AnalysisModel:
    """Analyse a design that need not be in any front: what if?"""
    topics = chosen_topics(asked.show, job=True)
    with READING:
        problem = given_problem(asked.job, settings.allowed_quantities, asked.values, require_feasible=False)
    require_turning(problem, "an analysis")
    mechanism = problem.mechanism.nominal
    if asked.speed is not None:
        mechanism = replace(mechanism, speed=speed_option(asked.speed))
    linkage = Dimensions(asked.crank, asked.rod, asked.offset).linkage(problem)
    record, notes = _with_topics(mechanism, linkage, topics, problem.own, lenient=ALL in asked.show)
    return AnalysisModel(analysis=record, notes=notes)


@router.get("/jobs/{number}/designs/{design}/requirements")
def show_requirements(found: FrontDep, design: DesignNumber) -> RequirementsModel:
    """Give the ranges and the constraints that hold for a design, the floors that hold without being asked included."""
    stored = found.design(design)
    asked = [RequirementModel(**vars(item), slack=item.slack) for item in requirements_of(stored.part)]
    return RequirementsModel(
        job=found.job.id,
        number=design,
        ranges={of.column: (of.lower, of.upper) for of in ranges_of(stored.part)},
        requirements=asked,
        slow_stroke=stored.part.slow_stroke,
        speed_rpm=speed_rpm(stored.mechanism),
        names=names_of(stored.part),
        tolerances=stored.mechanism.tolerances.given,
    )


@router.get("/jobs/{number}/designs/{design}/trade-offs")
def show_trade_offs(found: FrontDep, design: DesignNumber, units: UnitsAsked = "metric") -> TradeOffsModel:
    """Give what one objective costs in the others at a design, to first order, its active constraints held."""
    stored = found.design(design)
    try:
        with SIMULATING.turn():
            sentences, note = trade_offs_of(found.front, design - 1, stored, units), ""
    except InputError as error:
        sentences, note = [], str(error)
    return TradeOffsModel(job=found.job.id, number=design, trade_offs=sentences, note=note)


@router.post("/jobs/{number}/designs/{design}/what-if")
def change_lengths(found: FrontDep, design: DesignNumber, asked: OtherLengths) -> WhatIfModel:
    """Analyse a design with other lengths and varying numbers, its choices kept; what if?"""
    if 0 < asked.angles < LEAST:
        raise InputError(
            f"curves have {LEAST} to {MOST} crank angles, or 0 for none; got {asked.angles}; ask for as many"
        )
    lengths = (asked.crank_mm / 1e3, asked.rod_mm / 1e3, asked.offset_mm / 1e3)
    stored = found.design(design)
    stored = with_numbers(stored, stored.values[:3], asked.values)
    stored = with_numbers(stored, lengths if asked.hold is None else held(stored, lengths, asked.hold))
    changed = variation_of(stored, found.result, found.minimised)
    row, undefined = determined(changed.row, stored.mechanism, stored.linkage, stored.part.own, stored.part.motion)
    cycle = cycle_model(stored, asked.angles) if asked.angles else None
    violated = violated_by(stored.mechanism, row)
    return WhatIfModel(
        job=found.job.id,
        number=design,
        columns=column_models(all_columns(changed.row)),
        design=json_ready(row),
        undefined=undefined,
        broken=changed.broken,
        outside=changed.outside,
        violated=json_ready(violated),
        violations=violations_in_words(violated, row),
        dominated_by=[row + 1 for row in changed.dominated_by[:_MOST_NUMBERS]],
        dominated_by_count=len(changed.dominated_by),
        dominates=[row + 1 for row in changed.dominates[:_MOST_NUMBERS]],
        dominates_count=len(changed.dominates),
        cycle=cycle,
    )


def _with_topics(
    mechanism: Mechanism, linkage: Linkage, topics: tuple[str, ...], own: Sequence[Quantity], *, lenient: bool
) -> tuple[dict[str, Any], list[str]]:
    """Return the record of a design with its topics, ready for JSON, and notes."""
    row, undefined = numbers_of(mechanism, linkage, own)
    with SIMULATING.turn() if topics else nullcontext():
        analysed = analysis_of(
            row, mechanism, linkage, topics, cancelled=over(LONGEST_TOPICS), lenient=lenient, undefined=undefined
        )
    return json_ready(analysed.record()), analysed.notes + analysed.refused


def over(seconds: float) -> Callable[[], bool]:
    """Return a function that says whether so many s have passed since now."""
    end = time.monotonic() + seconds
    return lambda: time.monotonic() > end
