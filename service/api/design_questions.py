"""Questions about a design of a front: its crank angles, a swing, measured curves.

Each answer is what the command of the same name prints with --json.
"""

from __future__ import annotations

from math import radians
from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ...model.swing.asked import AskedSwing, asked_swing
from ...model.swing.summary import summarise
from ...model.swing.words import Driver, Law, Side
from ...objectives.kinds import ACCELERATION, ANGLE, LENGTH, SPEED, TIME
from ..designs.inverse import SliderMotion, inverse_record
from ..designs.measured_file import read_measured
from ..designs.shown_units import record_in
from ..designs.turning import require_turning
from ..runs.result import json_ready
from ..swing.record import swing_record
from ..topics.measured import MEASURED
from .computing import QuickRoute
from .fronts import OfDesign
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(
    route_class=QuickRoute, prefix="/jobs/{number}/designs/{design}", tags=["designs"], responses=problem_responses(409)
)

_FARTHEST = LENGTH.metric.factor * LENGTH.limit


def _either_way(limit: float, description: str, example: float) -> Any:
    """Return a parameter of an address, a number with a sign."""
    return Query(ge=-limit, le=limit, allow_inf_nan=False, description=description, examples=[example])


Position = Annotated[float, _either_way(_FARTHEST, "from the crank pivot, along +x", 240.0)]
Velocity = Annotated[float | None, _either_way(SPEED.limit, "along +x; gives the crank speed", -1.0)]
Acceleration = Annotated[
    float | None,
    _either_way(ACCELERATION.limit, "along +x; gives the crank acceleration, and needs the velocity", 3.0),
]
SwingAngle = Annotated[
    float | None,
    _either_way(
        ANGLE.metric.factor * ANGLE.limit, "crank angle, counter-clockwise from +x; of the job if left out", 30.0
    ),
]
SwingPlace = Annotated[
    float | None,
    _either_way(_FARTHEST, "instead of crank angles: slider position, from the crank pivot along +x", 240.0),
]

_INVERSE_EXAMPLE = {
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


class InverseModel(OfDesign):
    """Crank angles of a design of a front that put the slider at a position.

    inverse: what `slidercrank inverse --json` prints. Crank speed and acceleration are null where they are not asked
    for, and at a dead centre; the note then gives the reason.
    """

    inverse: dict[str, Any] = Field(examples=[_INVERSE_EXAMPLE])


@router.get("/inverse")
def find_crank_angles(
    found: FrontDep,
    design: DesignNumber,
    slider_position_mm: Position,
    slider_velocity_m_s: Velocity = None,
    slider_acceleration_m_s2: Acceleration = None,
    units: UnitsAsked = "metric",
) -> InverseModel:
    """Find every crank angle that puts the slider of a design at a position, with crank speed and acceleration.

    Of a crank that swings they are those of its swing.
    """
    motion = SliderMotion(slider_position_mm / LENGTH.metric.factor, slider_velocity_m_s, slider_acceleration_m_s2)
    stored = found.design(design)
    record = json_ready(inverse_record(stored.mechanism, stored.linkage, stored.part.motion, motion))
    return InverseModel(job=found.job.id, number=design, inverse=record_in(record, units))


_MEASURED_EXAMPLE = {
    "rows": 3,
    "understood": ("3 rows of crank_angle_deg, slider_position_mm; first 0, 190.5; last 240, 131; separated by commas"),
    "rows_without_crank_angle": 0,
    "crank_angle_from_time": False,
    "left_out": [],
    "curves": {
        "slider_position": {
            "title": "slider position",
            "samples": 3,
            "rms_mm": 1.58,
            "mean_mm": 1.5,
            "largest_mm": 2.1,
            "largest_at_crank_angle_deg": 120.0,
            "best_crank_angle_shift_deg": -0.4,
            "best_shift_mm": -1.5,
            "left_rms_mm": 0.05,
        }
    },
}


class MeasuredCurves(BaseModel, extra="forbid", strict=True):
    """Measured curves as a CSV file has them. Its first line names the columns, each with its unit."""

    csv: str = Field(
        description="text of the file: crank_angle_deg, or time_s at the job's speed, and curves such as torque_Nm",
        examples=["crank_angle_deg,slider_position_mm\n0,190.5\n120,120.2\n240,131\n"],
    )


class MeasuredModel(OfDesign):
    """Deviation of measured curves from those of a design of a front.

    measured: of `slidercrank analyse --measured --json`; measured minus computed, by curve. What is to be added to the
    crank angles and values for the best fit is told, not applied.
    """

    measured: dict[str, Any] = Field(examples=[_MEASURED_EXAMPLE])


@router.post("/measured")
def compare_measured(
    found: FrontDep, design: DesignNumber, given: MeasuredCurves, units: UnitsAsked = "metric"
) -> MeasuredModel:
    """Compare measured curves with those of a design: deviations, and the shifts that fit best."""
    stored = found.design(design)
    require_turning(stored.part.motion, "a comparison with measured curves")
    samples = read_measured(given.csv, stored.mechanism, stored.linkage)
    topic = MEASURED.of(stored.mechanism, stored.linkage, {"measured": samples})
    record = json_ready(topic.numbers(lambda: False))
    return MeasuredModel(job=found.job.id, number=design, measured=record_in(record, units))


_SWING_EXAMPLE = {
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

Duration = Annotated[
    float | None,
    Query(gt=0.0, le=TIME.limit, allow_inf_nan=False, description="of one way; for a law other than slow"),
]
ActuatorTolerance = Annotated[
    float | None,
    Query(ge=0.0, le=_FARTHEST, allow_inf_nan=False, description="of the driven slider"),
]


class SwingModel(OfDesign):
    """A swing of a design of a front. swing: what `slidercrank swing --json` prints."""

    swing: dict[str, Any] = Field(examples=[_SWING_EXAMPLE])


_NAMES = {
    "start": "start_deg",
    "end": "end_deg",
    "slider_start": "slider_start_mm",
    "slider_end": "slider_end_mm",
    "law": "law",
}


@router.get("/swing")
def analyse_swing(
    found: FrontDep,
    design: DesignNumber,
    start_deg: SwingAngle = None,
    end_deg: SwingAngle = None,
    slider_start_mm: SwingPlace = None,
    slider_end_mm: SwingPlace = None,
    crank_side: Side | None = None,
    driver: Driver | None = None,
    law: Law | None = None,
    duration_s: Duration = None,
    actuator_tolerance_mm: ActuatorTolerance = None,
    units: UnitsAsked = "metric",
) -> SwingModel:
    """Analyse a swing of a design between two crank angles or two slider positions, forth and back.

    What is left out is as the job has it; of a job without a swing the crank drives, slowly. Driven at either end.
    """
    asked = AskedSwing(
        start=None if start_deg is None else radians(start_deg),
        end=None if end_deg is None else radians(end_deg),
        slider_start=_metres(slider_start_mm),
        slider_end=_metres(slider_end_mm),
        side=crank_side,
        driver=driver,
        law=law,
        duration=duration_s,
        actuator_tolerance=_metres(actuator_tolerance_mm),
    )
    stored = found.design(design)
    machine, swing = asked_swing(stored.mechanism, stored.part.motion, asked, _NAMES)
    record = json_ready(swing_record(machine, summarise(machine, stored.linkage, swing)))
    return SwingModel(job=found.job.id, number=design, swing=record_in(record, units))


def _metres(millimetres: float | None) -> float | None:
    return None if millimetres is None else millimetres / LENGTH.metric.factor
