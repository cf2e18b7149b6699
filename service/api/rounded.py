"""Rounded neighbours of a design of a front that keep every requirement, and what each costs."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import BaseModel, Field

from ..designs.rounding import rounded_record, rounded_record_in, steps_of
from ..runs.result import finite
from .fronts import OfDesign
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep
from .throttle import SIMULATING

router = APIRouter(tags=["designs"], responses=problem_responses(409))

_MOST_STEPS, _MOST_TOLD = 50, 100
_EXAMPLE = {
    "met": True,
    "message": "311 of 2016 rounded designs within 16 steps keep every requirement",
    "steps": {"crank_mm": 0.5},
    "within_steps": 16,
    "judged": 2016,
    "kept": 311,
    "given": {"crank_mm": 73.33253, "peak_torque_Nm": 12.1},
    "designs": [
        {
            "crank_mm": 73.5,
            "peak_torque_Nm": 12.12,
            "change_peak_torque_Nm": 0.02,
            "change_peak_torque_percent": 0.17,
            "loss_percent": 0.2,
            "tightest": "transmission_angle",
            "missed": [],
        }
    ],
    "notes": ["rod has no step and stays as it is"],
}


class Steps(BaseModel, extra="forbid", strict=True):
    """Steps that a design is to be rounded to."""

    to: Annotated[list[Annotated[str, Field(max_length=200)]], Field(min_length=1, max_length=_MOST_STEPS)] = Field(
        description='step of crank, rod and offset, such as "0.5 mm" or "1/32 in", or of one number: "rod=1 mm"',
        examples=[["0.5 mm", "rod=1 mm"]],
    )
    count: int = Field(5, ge=1, le=_MOST_TOLD, description="designs to tell at most", examples=[5])


class RoundedModel(OfDesign):
    """Rounded neighbours of a design of a front. rounded: what `slidercrank round --json` prints."""

    rounded: dict[str, Any] = Field(examples=[_EXAMPLE])


@router.post("/jobs/{number}/designs/{design}/rounded")
def round_design(found: FrontDep, design: DesignNumber, given: Steps, units: UnitsAsked = "metric") -> RoundedModel:
    """Find the best designs of round numbers near a design that keep every requirement, and what each costs.

    Where none keeps all, the nearest are told with what they miss; `met` is then false.
    """
    found.row(design)
    steps = steps_of(given.to, found.front.part(design - 1), key="to")
    with SIMULATING.turn():
        rounded = found.front.rounded(design - 1, steps, count=given.count)
        record = finite(rounded_record_in(units, rounded_record(rounded), rounded))
    return RoundedModel(job=found.job.id, number=design, rounded=record)
