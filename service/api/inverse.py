"""Crank angles of a design of a front for a position of its slider."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import Field

from ...objectives.kinds import ACCELERATION, LENGTH, SPEED
from ..designs.inverse import SliderMotion, inverse_record
from ..designs.shown_units import record_in
from ..runs.result import finite
from .fronts import OfDesign
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(tags=["designs"], responses=problem_responses(409))

_MOST = LENGTH.metric.factor * LENGTH.limit
_EXAMPLE = {
    "crank_mm": 60.0,
    "rod_mm": 230.0,
    "offset_mm": 70.0,
    "branch": "open",
    "slider_position_mm": 240.0,
    "slider_velocity_m_s": -1.0,
    "slider_acceleration_m_s2": None,
    "solutions": [
        {
            "crank_angle_deg": angle,
            "stroke": stroke,
            "crank_speed_rpm": speed,
            "crank_acceleration_rad_s2": None,
        }
        for angle, stroke, speed in ((312.364, "outward", -141.481), (80.156, "inward", 162.872))
    ],
    "note": "",
}

Position = Annotated[
    float,
    Query(ge=-_MOST, le=_MOST, allow_inf_nan=False, description="from the crank pivot, along +x", examples=[240.0]),
]
Velocity = Annotated[
    float | None,
    Query(
        ge=-SPEED.limit,
        le=SPEED.limit,
        allow_inf_nan=False,
        description="along +x; gives the crank speed",
        examples=[-1.0],
    ),
]
Acceleration = Annotated[
    float | None,
    Query(
        ge=-ACCELERATION.limit,
        le=ACCELERATION.limit,
        allow_inf_nan=False,
        description="along +x; gives the crank acceleration, and needs the velocity",
        examples=[3.0],
    ),
]


class InverseModel(OfDesign):
    """Crank angles of a design of a front that put the slider at a position.

    inverse: what `slidercrank inverse --json` prints. Crank speed and acceleration are null where they are not asked
    for, and at a dead centre; the note then gives the reason.
    """

    inverse: dict[str, Any] = Field(examples=[_EXAMPLE])


@router.get("/jobs/{number}/designs/{design}/inverse")
def find_crank_angles(
    found: FrontDep,
    design: DesignNumber,
    slider_position_mm: Position,
    slider_velocity_m_s: Velocity = None,
    slider_acceleration_m_s2: Acceleration = None,
    units: UnitsAsked = "metric",
) -> InverseModel:
    """Find every crank angle that puts the slider of a design at a position, with crank speed and acceleration."""
    motion = SliderMotion(slider_position_mm / LENGTH.metric.factor, slider_velocity_m_s, slider_acceleration_m_s2)
    record = finite(inverse_record(found.design(design).linkage, motion))
    return InverseModel(job=found.job.id, number=design, inverse=record_in(record, units))
