"""Analyses of single designs, from a front or not, with topics and trade-offs."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import BaseModel, Field

from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import unit_text
from ...objectives.quantity import Quantity
from ..designs.judged_requirements import violations_of
from ..designs.rotating_crank import require_rotating_crank
from ..designs.trade_offs import trade_offs_of
from ..questions.design_analysis import analysis_of, quantities_of_design, quantities_of_swing
from ..questions.discovery import ALL, TOPICS, chosen_topics
from ..questions.record_types import RecordSchema
from ..runs.result import json_ready
from ..text.options import Dimensions, speed_option
from .blocks import AnswerBlock, sentence_blocks
from .computing import LongRoute
from .fronts import OfDesign
from .job_requests import problem_of_tables
from .problem_documents import problem_responses
from .settings import SettingsDep, UnitsParameter
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(route_class=LongRoute, tags=["designs"], responses=problem_responses(409))


Show = Annotated[
    list[Annotated[str, Field(max_length=500)]],
    Query(max_length=20, description=f"add a topic, or several: {', '.join(TOPICS)}, or {ALL}; repeatable"),
]
_TOPICS = RecordSchema(lambda: [topic.record_type for topic in TOPICS.values()], names=TOPICS)
_ALONG = "Near this design, along the front, with the active requirements held:"
_NOTHING_TO_GAIN = "At this design no objective can be improved at the expense of the others."


class AnalysisModel(BaseModel):
    """All numbers for a design.

    analysis: output of `slidercrank analyse --json`: every quantity, an object per topic, and in `violated` the excess
    beyond each allowable value. notes: omissions, with reasons.
    """

    analysis: Annotated[dict[str, Any], _TOPICS]
    notes: list[str] = Field(examples=[[]])


class StoredAnalysisModel(OfDesign, AnalysisModel):
    """All numbers for a design on a front."""


class WhatIf(BaseModel, extra="forbid"):
    """Job, and the dimensions of a design. Dimensions fixed by the job may be omitted.

    values: replacements for numbers in the job, by path. show: topics to add.
    """

    job: dict[str, Any] = Field(description="the tables of a job file")
    crank: str | None = Field(None, max_length=100, examples=["40 mm"])
    rod: str | None = Field(None, max_length=100, examples=["64 mm"])
    offset: str | None = Field(None, max_length=100, examples=["20 mm"])
    speed: str | None = Field(None, max_length=100, examples=["300 rpm"])
    values: dict[str, float | str] = Field({}, examples=[{"mechanism.slider.mass": "1.2 kg"}])
    show: list[str] = Field([], max_length=20, examples=[["balance"]])


class TradeOffsModel(OfDesign):
    """Trade-offs of a design: the cost of each objective in terms of the others, in words.

    note: why there are no trade-offs, or empty. blocks: the whole answer.
    """

    trade_offs: list[str] = Field(examples=[["1 deg more least transmission angle costs 0.8 N m more peak torque"]])
    note: str = Field(examples=[""])
    blocks: list[AnswerBlock]


@router.get("/jobs/{number}/designs/{design}/analysis")
def analyse_design(stored_front: FrontDep, design: DesignNumber, show: Show = []) -> StoredAnalysisModel:  # noqa: B006
    """Analyse a design on a front again for its job, with its choices and extra variables."""
    topics = chosen_topics(show, job=True, word="show")
    stored = stored_front.design(design)
    if stored.part.motion is not None:
        if topics:
            require_rotating_crank(stored.part.motion, f"the topic {', '.join(topics)}")
        row, undefined = quantities_of_swing(stored)
        record = json_ready(row | {"violated": violations_of(stored.mechanism, row), "undefined": undefined})
        return StoredAnalysisModel(job=stored_front.job.id, number=design, analysis=record, notes=[])
    record, notes = _analysis_record_and_notes(
        stored.mechanism, stored.linkage, topics, stored.part.own, lenient=ALL in show
    )
    return StoredAnalysisModel(job=stored_front.job.id, number=design, analysis=record, notes=notes)


@router.post("/analyse")
def analyse_given_dimensions(request: WhatIf, settings: SettingsDep) -> AnalysisModel:
    """Analyse a design that need not be on any front (what-if analysis)."""
    topics = chosen_topics(request.show, job=True, word="show")
    problem = problem_of_tables(request.job, settings.allowed_quantities, request.values, require_feasible=False)
    require_rotating_crank(problem.motion, "an analysis")
    mechanism = problem.mechanism.nominal
    if request.speed is not None:
        mechanism = replace(mechanism, speed=speed_option(request.speed, "speed"))
    linkage = Dimensions(request.crank, request.rod, request.offset).linkage(problem, str)
    record, notes = _analysis_record_and_notes(mechanism, linkage, topics, problem.own, lenient=ALL in request.show)
    return AnalysisModel(analysis=record, notes=notes)


@router.get("/jobs/{number}/designs/{design}/trade-offs")
def show_trade_offs(stored_front: FrontDep, design: DesignNumber, units: UnitsParameter = "metric") -> TradeOffsModel:
    """Return the first-order trade-off rates between objectives at a design, with its active constraints held."""
    stored = stored_front.design(design)
    try:
        sentences, note = trade_offs_of(stored_front.front, design - 1, stored, units), ""
    except InputError as error:
        sentences, note = [], str(error)
    paragraphs = [_ALONG, *(unit_text(f"{text}.") for text in sentences)] if sentences else [note or _NOTHING_TO_GAIN]
    return TradeOffsModel(
        job=stored_front.job.id, number=design, trade_offs=sentences, note=note, blocks=sentence_blocks(paragraphs)
    )


def _analysis_record_and_notes(
    mechanism: Mechanism, linkage: Linkage, topics: tuple[str, ...], custom: Sequence[Quantity], *, lenient: bool
) -> tuple[dict[str, Any], list[str]]:
    """Return the record of a design with its topics, ready for JSON, and its notes."""
    row, undefined = quantities_of_design(mechanism, linkage, custom)
    analysed = analysis_of(
        row, mechanism, linkage, topics, cancelled=lambda: False, lenient=lenient, undefined=undefined
    )
    return json_ready(analysed.record()), analysed.notes + analysed.refused
