"""Jobs before anything runs: their schema, and what is understood of one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import BaseModel, Field

from ...optimise.problem.problem import Problem
from .job_requests import Asked, asked_for, given_problem
from .problems import problem_responses
from .settings import SettingsDep
from .throttle import READING

router = APIRouter(tags=["jobs"])


class Understood(BaseModel):
    """A job in words, as it was understood."""

    name: str = Field(examples=["Feeder"])
    given: list[str] = Field(examples=[["crank speed 2400 rpm (counter-clockwise)"]])
    tolerances: list[str] = Field(examples=[["crank 0.05 mm"]])
    costs: list[str] = Field(examples=[[]])
    variables: list[str] = Field(examples=[["crank 20 to 60 mm"]])
    rules: list[str] = Field(examples=[["rod to offset 3.2"]])
    objectives: list[str] = Field(examples=[["minimise peak torque"]])
    unknowns: int = Field(examples=[3])
    degrees_of_freedom: int = Field(examples=[2])
    eliminated: list[str] = Field(examples=[["rod_to_offset"]])
    warnings: list[str] = Field(description="of what may not have been meant", examples=[[]])
    notes: list[str] = Field(description="of what is often forgotten", examples=[[]])
    search: str = Field(examples=["auto, at most 100 designs, seed 1"])


@router.get("/schema")
def show_schema() -> dict[str, Any]:
    """Give the JSON Schema (draft 2020-12) of a job, with a description and examples for every key."""
    from ...optimise.job import job_schema

    return job_schema()


@router.post("/check", responses=problem_responses(415))
def check_job(asked: Annotated[Asked, Depends(asked_for)], settings: SettingsDep) -> Understood:
    """Check a job and say in words what was understood; nothing is queued. It comes as for a submission."""
    with READING:
        return understood(given_problem(asked.tables, settings.allowed_quantities), asked.tables)


def understood(problem: Problem, tables: Mapping[str, Any]) -> Understood:
    """Return a problem in words, as it was understood from the tables that state it."""
    from ...optimise.job.notes import notes_of
    from ..text.summary import summarise

    return Understood(**summarise(problem), notes=notes_of(tables))
