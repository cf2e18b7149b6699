"""Comparison of runs in words: differences between their jobs, and where each is better."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ...model.errors import InputError
from ..designs.front_comparison import comparison_sentences
from ..jobs.differences import differences
from ..render.blocks import Block, Sentence, Table, column, heading, sentence
from .blocks import AnswerBlock, answer_blocks
from .computing import LongRoute
from .models import LARGEST, PLAIN_DIGITS, UnitsParameter
from .problems import problem_responses
from .settings import StoreDep
from .stored_fronts import FrontsDep

router = APIRouter(route_class=LongRoute, tags=["fronts"], responses=problem_responses(409))

MOST = 6
_Number = Annotated[int, Query(ge=1, le=LARGEST), PLAIN_DIGITS]


class DifferenceModel(BaseModel):
    """A place at which jobs differ. values: what each job has there, null for nothing."""

    place: str = Field(examples=["variables.rod"])
    values: list[str | None] = Field(examples=[["50 mm to 250 mm", "50 mm to 300 mm"]])


class ComparisonModel(BaseModel):
    """Runs against each other. sentences: who is better where; only of runs with designs. blocks: all of it."""

    jobs: list[int] = Field(examples=[[1, 2]])
    differences: list[DifferenceModel]
    sentences: list[str] = Field(examples=[["run 2 matches or beats every design of run 1, to 2 % of each range"]])
    blocks: list[AnswerBlock]


@router.get("/comparison")
def compare_runs(
    job: Annotated[list[_Number], Query(min_length=2, max_length=MOST, description="its number; repeatable")],
    store: StoreDep,
    fronts: FrontsDep,
    units: UnitsParameter = "metric",
) -> ComparisonModel:
    """Say what differs between the jobs of runs, and which of their fronts is better where."""
    if len(set(job)) < len(job):
        raise InputError(f"a run may be named only once; got {', '.join(map(str, job))}; leave out repeated ones")
    places = differences([store.tables(number) for number in job])
    results = [(f"run {number}", fronts.get(number).result) for number in job]
    solved = [(name, result) for name, result in results if result.designs]
    names, results_with_designs = [name for name, _ in solved], [result for _, result in solved]
    sentences = comparison_sentences(names, results_with_designs, units) if len(solved) > 1 else []
    return ComparisonModel(
        jobs=job,
        differences=[DifferenceModel(place=place, values=list(values)) for place, values in places],
        sentences=sentences,
        blocks=answer_blocks([*map(_spoken, sentences), *_differing(job, places)]),
    )


def _spoken(words: str) -> Sentence:
    return sentence("{text}", text=f"{words[:1].upper()}{words[1:]}.")


def _differing(jobs: Sequence[int], places: Sequence[tuple[str, Sequence[str | None]]]) -> list[Block]:
    """Return the differences between jobs as a table."""
    title = heading("What differs between the jobs")
    if not places:
        return [title, sentence("The jobs are the same but for their names.")]
    columns = (column(head, left=True) for head in ("Place in the job", *(f"run {number}" for number in jobs)))
    return [
        title,
        Table(tuple(columns), tuple((place, *(value or "–" for value in values)) for place, values in places)),
    ]
