"""Design nearest to one of a front that also meets further conditions: the answer of `slidercrank like --json`."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from pydantic import Field

from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..runs.result import json_ready
from .blocks import AnswerBlock, block_models
from .computing import LongRoute
from .fronts import OfDesign
from .input_parameters import body_of
from .models import UnitsParameter
from .problem_documents import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(route_class=LongRoute, tags=["designs"], responses=problem_responses(409))
QUESTION = FRONT_OR_JOB_QUESTIONS["like"]
_EXAMPLE = {"status": "done", "message": "1 design, 4120 evaluated", "distance": 0.21, "moved": {"rod_mm": -12.5}}


class LikeModel(OfDesign):
    """Design like one of a front. like: what `slidercrank like --json` prints; without a design status and message.

    blocks: the answer as sentences and tables.
    """

    like: dict[str, Any] = Field(examples=[_EXAMPLE])
    blocks: list[AnswerBlock]


def find_like(stored_front: FrontDep, design: DesignNumber, given: Any, units: UnitsParameter = "metric") -> LikeModel:
    """Find the design most like one of a front that also meets further conditions; nothing is saved."""
    stored_front.row(design)
    nearest = QUESTION.ask(stored_front.front, given.model_dump(), row=design - 1)
    record, blocks = json_ready(nearest.record(units)), block_models(nearest.blocks)
    return LikeModel(job=stored_front.job.id, number=design, like=record, blocks=blocks)


find_like.__annotations__["given"] = body_of(QUESTION, "LikeWhere")
router.add_api_route("/jobs/{number}/designs/{design}/like", find_like, methods=["POST"])
