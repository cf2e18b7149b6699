"""Single designs: their curves and requirements, also with other lengths while a user changes them."""

from dataclasses import replace
from typing import Annotated, Literal

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ...model.errors import InputError
from ..designs.changed_design import (
    design_with_numbers,
    judged_variation,
    lengths_meeting_equalities,
    nearest_lengths_meeting_equalities,
)
from ..designs.columns import all_columns
from ..designs.design_curves import LEAST, MOST
from ..designs.judged_requirements import (
    Requirement,
    faults_in_words,
    quantity_names,
    ranges_as_requirements,
    requirements_of,
    speed_rpm,
    violations_in_words,
    violations_of,
)
from ..questions.design_analysis import with_undefined_values
from ..questions.discovery import DESIGN_QUESTIONS
from ..runs.result import json_ready
from ..store.bookmarks_and_wishes import bookmarks_of
from .computing import QuickRoute
from .cycle import CurvesModel, CycleModel, design_curves_model
from .fronts import Cells, ColumnModel, OfDesign, Violated, Violations, column_models
from .problem_documents import problem_responses
from .settings import PLAIN_DIGITS, StoreDep
from .stored_fronts import LONGEST, Allowed, DesignNumber, FrontDep, Length, RequestedDesign, requested_design

router = APIRouter(route_class=QuickRoute, tags=["designs"], responses=problem_responses(409))

_MOST_NUMBERS = 20


class RequirementsModel(OfDesign):
    """Requirements of a job on a design, for the choices of the design.

    name: name of the design: that of its bookmark, or its number. bookmark: number of its bookmark, if any. ranges:
    minimum and maximum of crank, rod, offset and the extra variables, by column. speed_rpm: crank speed, positive
    counter-clockwise. lacking: questions that need what the machine does not have. names: names of quantities as in
    job files, by column. tolerances: whether the machine has any.
    """

    name: str = Field(examples=["Round numbers", "design 3"])
    bookmark: int | None = Field(examples=[1])
    ranges: dict[str, tuple[float, float]] = Field(examples=[{"crank_mm": (20.0, 60.0)}])
    requirements: list[Requirement]
    slow_stroke: str | None = Field(None, description="the stroke that must be the slow one", examples=["outward"])
    speed_rpm: float = Field(examples=[300.0])
    tolerances: bool
    lacking: list[str] = Field(examples=[["pump"]])
    names: dict[str, str] = Field(examples=[{"peak_torque_Nm": "peak_torque"}])


class OtherLengths(BaseModel, extra="forbid", strict=True):
    """Lengths for a design on a front. values: other extra variables, by column, within their ranges.

    angles: number of curve samples, evenly spaced; 0 for none.

    hold: the changed length; the others then follow, so that rules with exact values still hold; null leaves all
    lengths as given. nearest: if nothing holds for the changed length, take the nearest length for which the rules hold
    instead of an error. allow: allowed deviations from requirements, by column.
    """

    crank_mm: Length = Field(examples=[40.0])
    rod_mm: Length = Field(examples=[64.0])
    offset_mm: float = Field(ge=-LONGEST, le=LONGEST, allow_inf_nan=False, examples=[20.0])
    values: dict[Annotated[str, Field(max_length=500)], Annotated[float, Field(allow_inf_nan=False)]] = Field(
        {}, max_length=200, examples=[{}]
    )
    angles: int = Field(180, ge=0, le=MOST)
    hold: Literal["crank", "rod", "offset"] | None = None
    allow: Allowed = {}
    nearest: bool = False


class WhatIfModel(OfDesign):
    """Design with other lengths, compared with its front. name, bookmark: as in `RequirementsModel`.

    design: every quantity and the slacks; undefined: why some of them have no value, by column. broken: columns of
    unmet requirements. outside: columns of lengths outside their range. faults: both in words. allowed: allowed
    deviations; deviations: those within them, in words. dominated_by: numbers of
    the front designs that dominate this one; dominates: of those that it dominates; largest difference first, at most
    20. violated, violations: as for a design on the front. cycle: null if no curves were requested.
    """

    name: str = Field(examples=["design 3, changed"])
    bookmark: int | None = Field(examples=[None])
    columns: list[ColumnModel]
    design: Cells = Field(examples=[{"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0, "peak_torque_Nm": 1.8}])
    undefined: dict[str, str] = Field(examples=[{"position_error_mm": "a position error comes from tolerances"}])
    broken: list[str] = Field(examples=[["stroke_mm"]])
    outside: list[str] = Field(examples=[[]])
    faults: list[str] = Field(examples=[["misses stroke"]])
    allowed: Allowed
    deviations: list[str] = Field(examples=[["stroke 180.008 mm, within the allowed ±0.05 mm"]])
    violated: Violated
    violations: Violations
    dominated_by: list[int] = Field(examples=[[12, 4]])
    dominated_by_count: int = Field(examples=[2])
    dominates: list[int] = Field(examples=[[]])
    dominates_count: int = Field(examples=[0])
    cycle: CycleModel | None


@router.get("/jobs/{number}/designs/{design}/curves")
def show_curves(
    stored_front: FrontDep,
    design: DesignNumber,
    angles: Annotated[
        int,
        Query(ge=LEAST, le=MOST, description="number of evenly spaced crank angles, or of times for a swing"),
        PLAIN_DIGITS,
    ] = 360,
) -> CurvesModel:
    """Return slider motion, drive, transmission angle and joint forces over the cycle; see the answer's description."""
    return CurvesModel(
        job=stored_front.job.id, number=design, **dict(design_curves_model(stored_front.design(design), angles))
    )


@router.get("/jobs/{number}/designs/{design}/requirements")
def show_requirements(stored_front: FrontDep, design: DesignNumber, store: StoreDep) -> RequirementsModel:
    """Return the ranges and constraints that apply to a design, including default minimum values."""
    stored = stored_front.design(design)
    requested = requested_design(stored_front, design, None, bookmarks_of(store, stored_front.job.id))
    return RequirementsModel(
        job=stored_front.job.id,
        number=design,
        name=requested.display_name,
        bookmark=requested.bookmark and requested.bookmark.number,
        ranges={bounds.column: (bounds.lower, bounds.upper) for bounds in ranges_as_requirements(stored.part)},
        requirements=requirements_of(stored.part),
        slow_stroke=stored.part.slow_stroke,
        speed_rpm=speed_rpm(stored.mechanism),
        names=quantity_names(stored.part),
        tolerances=stored.mechanism.tolerances.are_stated,
        lacking=[
            name
            for name, question in DESIGN_QUESTIONS.items()
            if question.premise and not question.premise.is_met(stored.part, stored.mechanism)
        ],
    )


@router.post("/jobs/{number}/designs/{design}/what-if")
def change_lengths(stored_front: FrontDep, design: DesignNumber, request: OtherLengths, store: StoreDep) -> WhatIfModel:
    """Analyse a design with other lengths and extra variables but the same choices (what-if analysis)."""
    if 0 < request.angles < LEAST:
        raise InputError(
            f"curves must have {LEAST} to {MOST} crank angles, or 0 for none; got {request.angles}; ask for a number "
            "in this range"
        )
    lengths = (request.crank_mm / 1e3, request.rod_mm / 1e3, request.offset_mm / 1e3)
    stored = stored_front.design(design)
    stored = design_with_numbers(stored, stored.values[:3], request.values)
    if request.hold is not None:
        lengths = (nearest_lengths_meeting_equalities if request.nearest else lengths_meeting_equalities)(
            stored, lengths, request.hold
        )
    stored = design_with_numbers(stored, lengths)
    requested = RequestedDesign(stored_front, design, stored, True, bookmarks_of(store, stored_front.job.id))
    allow = request.allow or dict(requested.bookmark.allowed if requested.bookmark else {})
    stored = replace(stored, allowed=allow)
    changed = judged_variation(stored, stored_front.result, stored_front.minimised_objectives)
    row, undefined = with_undefined_values(
        changed.row, stored.mechanism, stored.linkage, stored.part.own, stored.part.motion
    )
    cycle = design_curves_model(stored, request.angles) if request.angles else None
    violated = violations_of(stored.mechanism, row)
    return WhatIfModel(
        job=stored_front.job.id,
        number=design,
        name=requested.display_name,
        bookmark=requested.bookmark and requested.bookmark.number,
        columns=column_models(all_columns(changed.row)),
        design=json_ready(row),
        undefined=undefined,
        broken=changed.broken,
        outside=changed.outside,
        faults=faults_in_words(row, changed.broken, changed.outside),
        allowed=allow,
        deviations=changed.deviations,
        violated=json_ready(violated),
        violations=violations_in_words(violated, row),
        dominated_by=[row + 1 for row in changed.dominated_by[:_MOST_NUMBERS]],
        dominated_by_count=len(changed.dominated_by),
        dominates=[row + 1 for row in changed.dominates[:_MOST_NUMBERS]],
        dominates_count=len(changed.dominates),
        cycle=cycle,
    )
