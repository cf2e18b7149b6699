"""Limits on which designs of a front rest, and the run again with wider ones."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter
from pydantic import BaseModel, Field

from ..designs.binding import binding_limits, widened
from ..designs.nearby import SHARE, nearby
from .jobs import SUBMITTED, QueueDep
from .problems import problem_responses
from .settings import StoreDep
from .stored_fronts import LONGEST, FrontDep, Length

router = APIRouter(tags=["fronts"])
_COPIED = {**SUBMITTED, "responses": problem_responses(409, 415, 429)}

_OF = Annotated[str, Field(max_length=500, description="its place in the job", examples=["variables.rod"])]
_Side = Literal["lower", "upper"]


class LimitModel(BaseModel):
    """A limit on which designs rest, in its unit. designs: their numbers. wider: a value to try.

    words: in metric units. wider is null where the job says the limit in a way that another number cannot replace.
    """

    of: _OF
    side: _Side = Field(examples=["upper"])
    column: str = Field(examples=["rod_mm"])
    title: str = Field(examples=["rod"])
    unit: str = Field(examples=["mm"])
    value: float = Field(examples=[400.0])
    wider: float | None = Field(examples=[490.0])
    words: str = Field(examples=["rod at most 400 mm"])
    designs: list[int] = Field(examples=[[1, 2, 7]])


class BindingModel(BaseModel):
    """The limits on which designs of a front rest, those with most designs first."""

    job: int = Field(examples=[7])
    count: int = Field(description="of all designs", examples=[100])
    limits: list[LimitModel]


class OtherLimit(BaseModel, extra="forbid", strict=True):
    """Another value for a limit of a job, in the unit of the limit."""

    of: _OF
    side: _Side = Field(examples=["upper"])
    value: float = Field(allow_inf_nan=False, examples=[490.0])


class Widening(BaseModel, extra="forbid", strict=True):
    """The limits that are wider in a copy of a job."""

    limits: list[OtherLimit] = Field(min_length=1, max_length=50)


class Nearby(BaseModel, extra="forbid", strict=True):
    """Lengths that a copy of a job varies around. share: of each length, on either side."""

    crank_mm: Length = Field(examples=[40.0])
    rod_mm: Length = Field(examples=[64.0])
    offset_mm: float = Field(ge=-LONGEST, le=LONGEST, allow_inf_nan=False, examples=[20.0])
    share: float = Field(SHARE, gt=0.0, le=0.9, allow_inf_nan=False, examples=[0.1])


@router.get("/jobs/{number}/binding", responses=problem_responses(409))
def list_binding(found: FrontDep, store: StoreDep) -> BindingModel:
    """Give the limits of a job on which designs of its front rest: what a wider one may gain."""
    limits = binding_limits(found.problem, found.result, store.tables(found.job.id))
    told = [
        LimitModel(
            words=limit.words,
            designs=list(limit.designs),
            **{name: value for name, value in vars(limit).items() if name not in ("size", "designs")},
        )
        for limit in limits
    ]
    return BindingModel(job=found.job.id, count=len(found.result.designs), limits=told)


@router.post("/jobs/{number}/widened", **_COPIED)
def run_widened(found: FrontDep, asked: Widening, queue: QueueDep) -> dict[str, Any]:
    """Queue a copy of a job with wider limits; the copy knows the job that it came from."""
    wider = [(one.of, one.side, one.value) for one in asked.limits]
    return queue.put_copy(found.job, widened(found.problem, queue.store.tables(found.job.id), wider))


@router.post("/jobs/{number}/nearby", **_COPIED)
def run_nearby(found: FrontDep, asked: Nearby, queue: QueueDep) -> dict[str, Any]:
    """Queue a copy of a job that searches around given lengths, also outside of its ranges."""
    lengths = (asked.crank_mm, asked.rod_mm, asked.offset_mm)
    tables = nearby(found.problem, queue.store.tables(found.job.id), lengths, share=asked.share)
    return queue.put_copy(found.job, tables)
