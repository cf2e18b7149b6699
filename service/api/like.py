"""Design most like one of a front that also meets further conditions: the answer of `slidercrank like --json`."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from pydantic import Field

from ..questions.discovery import WIDER
from ..runs.result import json_ready
from .computing import LongRoute
from .fronts import OfDesign
from .input_parameters import body_of
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(route_class=LongRoute, tags=["designs"], responses=problem_responses(409))
QUESTION = WIDER["like"]
_EXAMPLE = {"status": "done", "message": "1 design, 4120 evaluated", "distance": 0.21, "moved": {"rod_mm": -12.5}}


class LikeModel(OfDesign):
    """Design like one of a front. like: what `slidercrank like --json` prints; without a design status and message."""

    like: dict[str, Any] = Field(examples=[_EXAMPLE])


def find_like(found: FrontDep, design: DesignNumber, given: Any, units: UnitsAsked = "metric") -> LikeModel:
    """Find the design most like one of a front that also meets further conditions; nothing is saved."""
    found.row(design)
    answer = QUESTION.ask(found.front, given.model_dump(), row=design - 1)
    return LikeModel(job=found.job.id, number=design, like=json_ready(answer.record(units)))


find_like.__annotations__["given"] = body_of(QUESTION, "LikeWhere")
router.add_api_route("/jobs/{number}/designs/{design}/like", find_like, methods=["POST"])
