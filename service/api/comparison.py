"""Comparison of runs: the answer of `slidercrank compare --json`, and differences between their jobs."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ..questions.compare.runs import ComparedRun
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..runs.result import json_ready
from .blocks import AnswerBlock, block_models
from .computing import LongRoute
from .input_parameters import inputs_in_address, parameter_of
from .models import LARGEST, PLAIN_DIGITS, UnitsParameter
from .problem_documents import problem_responses
from .settings import StoreDep
from .stored_fronts import FrontsDep

router = APIRouter(route_class=LongRoute, tags=["fronts"], responses=problem_responses(409))

MOST = 6
QUESTION = FRONT_OR_JOB_QUESTIONS["compare"]
ComparisonInputs = Annotated[dict[str, Any], inputs_in_address(QUESTION.inputs, map(parameter_of, QUESTION.inputs))]
_Number = Annotated[int, Query(ge=1, le=LARGEST), PLAIN_DIGITS]
_EXAMPLE = {"tolerance": 1e-6, "union_hypervolume": 0.71, "coverage": [[1.0, 0.4], [0.1, 1.0]]}


class DifferenceModel(BaseModel):
    """A place at which jobs differ. values: what each job has there, null for nothing."""

    place: str = Field(examples=["variables.rod"])
    values: list[str | None] = Field(examples=[["50 mm to 250 mm", "50 mm to 300 mm"]])


class ComparisonModel(BaseModel):
    """Runs against each other. sentences: who is better where; only of runs with designs. blocks: all of it.

    comparison: what `slidercrank compare --json` prints; without measures unless the objectives are the same.
    """

    jobs: list[int] = Field(examples=[[1, 2]])
    differences: list[DifferenceModel]
    sentences: list[str] = Field(examples=[["run 2 matches or beats every design of run 1, to 2 % of each range"]])
    comparison: dict[str, Any] = Field(examples=[_EXAMPLE])
    blocks: list[AnswerBlock]


@router.get("/comparison")
def compare_runs(
    job: Annotated[list[_Number], Query(min_length=2, max_length=MOST, description="its number; repeatable")],
    store: StoreDep,
    fronts: FrontsDep,
    given: ComparisonInputs,
    units: UnitsParameter = "metric",
) -> ComparisonModel:
    """Say what differs between the jobs of runs, and which of their fronts is better where."""
    runs = [ComparedRun(f"run {number}", number, fronts.get(number).result, store.tables(number)) for number in job]
    answer = QUESTION.ask(runs, given)
    record = json_ready(answer.record(units))
    return ComparisonModel(
        jobs=job,
        differences=record["differences"],
        sentences=record["sentences"],
        comparison=record,
        blocks=block_models(answer.blocks),
    )
