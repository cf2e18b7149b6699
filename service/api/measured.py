"""Measured curves beside the computed ones of a design of a front."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from pydantic import BaseModel, Field

from ..designs.measured_file import read_measured
from ..designs.shown_units import record_in
from ..runs.result import finite
from ..topics.measured import MEASURED
from .fronts import OfDesign
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep
from .throttle import SIMULATING

router = APIRouter(tags=["designs"], responses=problem_responses(409))

_EXAMPLE = {
    "rows": 3,
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

    measured: dict[str, Any] = Field(examples=[_EXAMPLE])


@router.post("/jobs/{number}/designs/{design}/measured")
def compare_measured(
    found: FrontDep, design: DesignNumber, given: MeasuredCurves, units: UnitsAsked = "metric"
) -> MeasuredModel:
    """Compare measured curves with those of a design: deviations, and the shifts that fit best."""
    stored = found.design(design)
    with SIMULATING.turn():
        samples = read_measured(given.csv, stored.mechanism, stored.linkage)
        topic = MEASURED.of(stored.mechanism, stored.linkage, {"measured": samples})
        record = finite(topic.numbers(lambda: False))
    return MeasuredModel(job=found.job.id, number=design, measured=record_in(record, units))
