"""A swing of a design of a front: what drives it, holds it and how far it may be off."""

from __future__ import annotations

from math import radians
from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import Field

from ...model.swing.summary import summarise
from ...model.swing.swing import Swing
from ...model.swing.words import Driver, Law
from ...objectives.kinds import ANGLE, LENGTH, TIME
from ..designs.shown_units import record_in
from ..runs.result import finite
from ..swing.record import swing_record
from .fronts import OfDesign
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(tags=["designs"], responses=problem_responses(409))

_MOST = ANGLE.metric.factor * ANGLE.limit
_EXAMPLE = {
    "crank_mm": 60.0,
    "rod_mm": 230.0,
    "offset_mm": 70.0,
    "driver": "slider",
    "swing_angle_deg": 60.0,
    "travel_mm": 62.1,
    "peak_drive_N": 240.5,
    "peak_drive_at_crank_angle_deg": 90.0,
    "energy_forth_J": 12.5,
    "notes": [],
}

CrankAngle = Annotated[
    float, Query(ge=-_MOST, le=_MOST, allow_inf_nan=False, description="counter-clockwise from +x", examples=[30.0])
]
Duration = Annotated[
    float | None,
    Query(gt=0.0, le=TIME.limit, allow_inf_nan=False, description="of one way; for a law other than slow"),
]
ActuatorTolerance = Annotated[
    float,
    Query(ge=0.0, le=LENGTH.metric.factor * LENGTH.limit, allow_inf_nan=False, description="of the driven slider"),
]


class SwingModel(OfDesign):
    """A swing of a design of a front. swing: what `slidercrank swing --json` prints."""

    swing: dict[str, Any] = Field(examples=[_EXAMPLE])


@router.get("/jobs/{number}/designs/{design}/swing")
def analyse_swing(
    found: FrontDep,
    design: DesignNumber,
    start_deg: CrankAngle,
    end_deg: CrankAngle,
    driver: Driver = "crank",
    law: Law = "slow",
    duration_s: Duration = None,
    actuator_tolerance_mm: ActuatorTolerance = 0.0,
    units: UnitsAsked = "metric",
) -> SwingModel:
    """Analyse a swing of a design between two crank angles, forth and back, driven at either end."""
    asked = Swing(
        start=radians(start_deg),
        end=radians(end_deg),
        driver=driver,
        law=law,
        duration=duration_s,
        actuator_tolerance=actuator_tolerance_mm / LENGTH.metric.factor,
    )
    stored = found.design(design)
    record = finite(swing_record(stored.mechanism, summarise(stored.mechanism, stored.linkage, asked)))
    return SwingModel(job=found.job.id, number=design, swing=record_in(record, units))
