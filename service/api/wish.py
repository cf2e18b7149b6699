"""Choice by wishes: the optimal design nearest to wished values, found by a new search."""

from __future__ import annotations

from typing import Any, Literal

from fastapi import APIRouter
from pydantic import BaseModel, Field

from ..designs.columns import all_columns
from ..jobs.front_wish_history import stated_wishes
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..questions.wish.analysis import answered
from ..store.remarks import note_wish, wishes_of
from .computing import LongRoute
from .fronts import Cells, ColumnModel, column_models
from .input_parameters import body_of
from .models import UnitsParameter
from .problem_documents import problem_responses
from .settings import StoreDep
from .stored_fronts import FrontDep

router = APIRouter(route_class=LongRoute, tags=["fronts"], responses=problem_responses(409))

QUESTION = FRONT_OR_JOB_QUESTIONS["wish"]
_DESIGN = Field(None, ge=1, le=2**31, description="reference for improve, keep and worsen, by its number")
WishesGiven = body_of(QUESTION, "WishesGiven", design=(int | None, _DESIGN))


class WishModel(BaseModel):
    """A wish for an objective. value: that is wished, or that it may worsen to, in the unit of the objective."""

    wish: Literal["value", "improve", "keep", "limit"]
    value: float | None = Field(examples=[45.0])


class WishRecordModel(BaseModel):
    """A wish that somebody made of a front. wishes: by objective. design: that classes speak of. at: s since 1970."""

    number: int = Field(examples=[3])
    wishes: dict[str, WishModel]
    design: int | None = Field(examples=[None])
    at: float


class WishesModel(BaseModel):
    """The wishes that were made of the front of a job, the latest first."""

    job: int = Field(examples=[7])
    made: list[WishRecordModel]


class OutcomeModel(BaseModel):
    """Wish and outcome of an objective, in its unit.

    wish: its kind. wished: the value that is wished, or that it may worsen to. before: of the design that classes speak
    of. short: by how much it is worse than wished, changed: than before; below 0 where it is better. met: whether it
    is as wished, or within what is allowed. A number that does not apply is null.
    """

    quantity: str = Field(examples=["transmission_angle"])
    title: str = Field(examples=["least transmission angle"])
    unit: str = Field(examples=["deg"])
    wish: Literal["value", "improve", "keep", "limit", "free"]
    met: bool
    wished: float | None = Field(examples=[45.0])
    reached: float = Field(examples=[42.9])
    before: float | None = Field(examples=[None])
    short: float | None = Field(examples=[2.1])
    changed: float | None = Field(examples=[None])


class WishedModel(BaseModel):
    """The design that comes nearest to wishes.

    number: of the design that classes speak of. possible: whether everything wished is reached. sentences: the answer
    in words. achievement: value of the achievement function. objectives: none without a design. design: as a row of the
    front, with its stationarity residual; null where no design stays within what may worsen.
    """

    job: int = Field(examples=[7])
    number: int | None = Field(examples=[None])
    possible: bool
    sentences: list[str] = Field(examples=[["no design reaches all desired values; this one comes nearest"]])
    achievement: float | None = Field(examples=[0.031])
    objectives: list[OutcomeModel]
    columns: list[ColumnModel]
    design: Cells | None = Field(examples=[{"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0, "time_ratio": 1.2}])


def make_wish(stored_front: FrontDep, given: Any, store: StoreDep, units: UnitsParameter = "metric") -> WishedModel:
    """Find the optimal design that comes nearest to wished values of the objectives, or from a design as asked.

    The wish is noted among those of the job.
    """
    if given.design is not None:
        stored_front.row(given.design)
    solved = answered(
        stored_front.wishes.wish(given.at, row=None if given.design is None else given.design - 1), given.at
    )
    record: dict[str, Any] = solved.record(units)
    note_wish(store, stored_front.job.id, stated_wishes(stored_front.front, solved.search_result.wishes), given.design)
    columns = column_models(all_columns(record["design"] or ()))
    return WishedModel(job=stored_front.job.id, columns=columns, **record)


make_wish.__annotations__["given"] = WishesGiven
router.add_api_route("/jobs/{number}/wish", make_wish, methods=["POST"])


@router.get("/jobs/{number}/wishes")
def list_wishes(stored_front: FrontDep, store: StoreDep) -> WishesModel:
    """List the wishes that were made of the front of a job, the latest first."""
    records = [
        WishRecordModel(
            number=record.number,
            wishes={
                name: WishModel.model_validate(dict(zip(("wish", "value"), wish, strict=True)))
                for name, wish in record.wishes.items()
            },
            design=record.design,
            at=record.time,
        )
        for record in wishes_of(store, stored_front.job.id)
    ]
    return WishesModel(job=stored_front.job.id, made=records)
