"""Wishes: finds the optimal design nearest to desired values by a new search."""

from typing import Any, Literal

from fastapi import APIRouter
from pydantic import BaseModel, Field

from ..designs.columns import all_columns
from ..jobs.front_wish_history import wishes_by_objective
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..questions.wish.analysis import wish_result
from ..store.bookmarks_and_wishes import note_wish, wishes_of
from .computing import LongRoute
from .fronts import Cells, ColumnModel, column_models
from .input_parameters import body_model_of_question
from .problem_documents import problem_responses
from .settings import StoreDep, UnitsParameter
from .stored_fronts import FrontDep

router = APIRouter(route_class=LongRoute, tags=["fronts"], responses=problem_responses(409))

QUESTION = FRONT_OR_JOB_QUESTIONS["wish"]
_DESIGN = Field(None, ge=1, le=2**31, description="reference for improve, keep and worsen, by its number")
WishesGiven = body_model_of_question(QUESTION, "WishesGiven", design=(int | None, _DESIGN))


class WishModel(BaseModel):
    """Wish for an objective.

    value: desired value, or the limit to which it may worsen, in the unit of the objective.
    """

    wish: Literal["value", "improve", "keep", "limit"]
    value: float | None = Field(examples=[45.0])


class WishRecordModel(BaseModel):
    """Wish recorded for a front. wishes: by objective. design: reference design of the classes. at: s since 1970."""

    number: int = Field(examples=[3])
    wishes: dict[str, WishModel]
    design: int | None = Field(examples=[None])
    at: float


class WishesModel(BaseModel):
    """Wishes recorded for the front of a job, newest first."""

    job: int = Field(examples=[7])
    made: list[WishRecordModel]


class OutcomeModel(BaseModel):
    """Wish for an objective and its outcome, in the unit of the objective.

    wish: its kind. wished: desired value, or the limit to which it may worsen. before: value of the reference design.
    short: shortfall from the desired value. changed: worsening from the
    reference; both are negative if better. met: whether the wish is met. A number that does not apply is null.
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
    """Design that comes nearest to the wishes.

    number: reference design of the classes. possible: whether every wish is met. sentences: the answer in words.
    achievement: value of the achievement function. objectives: empty if there is no design. design: as a row of the
    front, with its stationarity residual; null if no design stays within the allowed worsening.
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
    """Find the optimal design nearest to desired objective values, or to changes requested from a design.

    The wish is recorded with those of the job.
    """
    if given.design is not None:
        stored_front.row_of_design(given.design)
    solved = wish_result(
        stored_front.wish_starts.design_nearest_to_wishes(
            given.at, row=None if given.design is None else given.design - 1
        ),
        given.at,
    )
    record: dict[str, Any] = solved.record(units)
    note_wish(
        store, stored_front.job.id, wishes_by_objective(stored_front.front, solved.search_result.wishes), given.design
    )
    columns = column_models(all_columns(record["design"] or ()))
    return WishedModel(job=stored_front.job.id, columns=columns, **record)


make_wish.__annotations__["given"] = WishesGiven
router.add_api_route("/jobs/{number}/wish", make_wish, methods=["POST"])


@router.get("/jobs/{number}/wishes")
def list_wishes(stored_front: FrontDep, store: StoreDep) -> WishesModel:
    """List the wishes recorded for the front of a job, newest first."""
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
