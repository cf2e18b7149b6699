"""Active constraints among the designs of a front."""

from typing import Annotated, Literal

from fastapi import APIRouter
from pydantic import BaseModel, Field

from ..designs.derived_jobs import active_limits
from .computing import QuickRoute
from .problem_documents import problem_responses
from .settings import StoreDep
from .stored_fronts import FrontDep

router = APIRouter(route_class=QuickRoute, tags=["fronts"])

LIMIT_PATH = Annotated[
    str, Field(max_length=500, description="path of the limit in the job", examples=["variables.rod"])
]
Side = Literal["lower", "upper"]


class LimitModel(BaseModel):
    """Limit that is active for some designs, in its unit. designs: their numbers. wider: a value to try.

    words: in metric units. wider: null if the job states the limit in a form that no single number can replace.
    """

    of: LIMIT_PATH
    side: Side = Field(examples=["upper"])
    column: str = Field(examples=["rod_mm"])
    title: str = Field(examples=["rod"])
    unit: str = Field(examples=["mm"])
    value: float = Field(examples=[400.0])
    wider: float | None = Field(examples=[490.0])
    words: str = Field(examples=["rod at most 400 mm"])
    designs: list[int] = Field(examples=[[1, 2, 7]])


class ActiveLimitsModel(BaseModel):
    """Active limits of a front, those with the most designs first."""

    job: int = Field(examples=[7])
    count: int = Field(description="number of all designs", examples=[100])
    limits: list[LimitModel]


@router.get("/jobs/{number}/binding", responses=problem_responses(409))
def list_active_limits(stored_front: FrontDep, store: StoreDep) -> ActiveLimitsModel:
    """List the active limits of a front, where a wider limit may improve designs."""
    limits = active_limits(stored_front.problem, stored_front.result, store.job_tables(stored_front.job.id))
    models = [
        LimitModel(
            words=limit.limit_in_words,
            designs=list(limit.designs),
            **{name: value for name, value in vars(limit).items() if name not in ("size", "designs")},
        )
        for limit in limits
    ]
    return ActiveLimitsModel(job=stored_front.job.id, count=len(stored_front.result.designs), limits=models)
