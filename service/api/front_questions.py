"""Questions about one or several fronts, answered as by the commands `like`, `round`, `certify` and `compare`."""

import contextlib
import itertools
import json
from collections.abc import AsyncIterator, Generator
from typing import Annotated, Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import StreamingResponse
from fastapi.sse import format_sse_event
from pydantic import BaseModel, Field
from pydantic_core import to_json

from ..questions.compare.runs import ComparedRun
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..questions.front_or_job_question import Answer
from ..render.formatting import plain_blocks
from ..runs.result import json_ready
from .blocks import AnswerBlock, block_models
from .computing import LongRoute
from .events import STREAM, STREAM_HEADERS
from .fronts import OfDesign
from .input_parameters import body_model_of_question, inputs_from_query, parameter_of_input
from .problem_documents import problem_responses
from .settings import LARGEST, PLAIN_DIGITS, StoreDep, UnitsParameter
from .stored_fronts import DesignNumber, FrontDep, FrontsDep, StoredFront

router = APIRouter(route_class=LongRoute, responses=problem_responses(409))
LIKE, ROUND, CERTIFY, COMPARE = (FRONT_OR_JOB_QUESTIONS[name] for name in ("like", "round", "certify", "compare"))
MOST = 6
"""Maximum number of runs in a comparison."""
_LIKE_EXAMPLE = {"status": "done", "message": "1 design, 4120 evaluated", "distance": 0.21, "moved": {"rod_mm": -12.5}}


class LikeModel(OfDesign):
    """Design that resembles one on a front.

    like: output of `slidercrank like --json`; only status and message if there is no design.

    blocks: the answer as sentences and tables.
    """

    like: dict[str, Any] = Field(examples=[_LIKE_EXAMPLE])
    blocks: list[AnswerBlock]


def find_similar_design(
    stored_front: FrontDep, design: DesignNumber, given: Any, units: UnitsParameter = "metric"
) -> LikeModel:
    """Find the design most similar to one on a front that also meets further conditions; nothing is saved."""
    stored_front.row_of_design(design)
    nearest = LIKE.ask(stored_front.front, given.model_dump(), row=design - 1)
    record, blocks = json_ready(nearest.record(units)), block_models(nearest.blocks)
    return LikeModel(job=stored_front.job.id, number=design, like=record, blocks=blocks)


find_similar_design.__annotations__["given"] = body_model_of_question(LIKE, "LikeWhere")
router.add_api_route("/jobs/{number}/designs/{design}/like", find_similar_design, methods=["POST"], tags=["designs"])

CertificateInputs = Annotated[
    dict[str, Any], inputs_from_query(CERTIFY.inputs, map(parameter_of_input, CERTIFY.inputs))
]
_CERTIFY_EXAMPLE = {"status": "proven", "epsilon_asked": 0.01, "epsilon": 0.0098, "boxes": 41_210, "open_boxes": 0}


class CertificateModel(BaseModel):
    """Upper bound, with proof, on the distance between a front and the true one.

    proven: whether the requested accuracy is proven. sentences: the proof in words, in metric units. certificate:
    output of `slidercrank certify --json`. blocks: the sentences as data.
    """

    job: int = Field(examples=[7])
    proven: bool
    sentences: list[str] = Field(examples=[["proven: for every feasible design, one of the 100 designs is worse ..."]])
    certificate: dict[str, Any] = Field(examples=[_CERTIFY_EXAMPLE])
    blocks: list[AnswerBlock]


@router.get("/jobs/{number}/certificate", tags=["fronts"], response_model=CertificateModel)
def certify_front(stored_front: FrontDep, given: CertificateInputs) -> Response:
    """Prove how far a front can be from the true one; without designs, prove that no design is feasible."""
    name = " ".join(map(repr, given.values()))

    def make() -> tuple[tuple[str], bytes]:
        return (name,), to_json(_certificate_model(stored_front, given))

    return Response(stored_front.cached_item(name, "certificate", make), media_type="application/json")


def _certificate_model(stored_front: StoredFront, inputs: dict[str, Any]) -> CertificateModel:
    certificate = CERTIFY.ask(stored_front.front, inputs)
    sentences = [block.sentence for block in plain_blocks(certificate.blocks)]
    return CertificateModel(
        job=stored_front.job.id,
        proven=certificate.is_satisfied,
        sentences=sentences if stored_front.result.designs else [certificate.message],
        certificate=json_ready({"run": stored_front.result.run} | certificate.record("metric")),
        blocks=block_models(certificate.blocks),
    )


ComparisonInputs = Annotated[dict[str, Any], inputs_from_query(COMPARE.inputs, map(parameter_of_input, COMPARE.inputs))]
_Number = Annotated[int, Query(ge=1, le=LARGEST), PLAIN_DIGITS]
_COMPARE_EXAMPLE = {"tolerance": 1e-6, "union_hypervolume": 0.71, "coverage": [[1.0, 0.4], [0.1, 1.0]]}


class DifferenceModel(BaseModel):
    """Path at which jobs differ. values: value in each job, null if absent."""

    place: str = Field(examples=["variables.rod"])
    values: list[str | None] = Field(examples=[["50 mm to 250 mm", "50 mm to 300 mm"]])


class ComparisonModel(BaseModel):
    """Comparison of runs. sentences: which run is better where; only for runs with designs. blocks: the whole answer.

    comparison: output of `slidercrank compare --json`; has no measures unless the objectives are equal.
    """

    jobs: list[int] = Field(examples=[[1, 2]])
    differences: list[DifferenceModel]
    sentences: list[str] = Field(examples=[["run 2 matches or beats every design of run 1, to 2 % of each range"]])
    comparison: dict[str, Any] = Field(examples=[_COMPARE_EXAMPLE])
    blocks: list[AnswerBlock]


@router.get("/comparison", tags=["fronts"])
def compare_runs(
    job: Annotated[list[_Number], Query(min_length=2, max_length=MOST, description="number of a job; repeatable")],
    store: StoreDep,
    fronts: FrontsDep,
    given: ComparisonInputs,
    units: UnitsParameter = "metric",
) -> ComparisonModel:
    """Compare runs: the differences between their jobs, and which front is better where."""
    runs = [
        ComparedRun(f"run {number}", number, fronts.front_of_job(number).result, store.job_tables(number))
        for number in job
    ]
    answer = COMPARE.ask(runs, given)
    record = json_ready(answer.record(units))
    return ComparisonModel(
        jobs=job,
        differences=record["differences"],
        sentences=record["sentences"],
        comparison=record,
        blocks=block_models(answer.blocks),
    )


_ROUNDED_EXAMPLE = {
    "met": True,
    "message": "311 of 2016 rounded designs within 16 steps keep every requirement within 0.1 mm of stroke",
    "steps": {"crank_mm": 0.5},
    "allowed": {"stroke_mm": 0.1},
    "within_steps": 16,
    "judged": 2016,
    "kept": 311,
    "given": {"crank_mm": 73.33253, "peak_torque_Nm": 12.1},
    "designs": [
        {
            "crank_mm": 73.5,
            "peak_torque_Nm": 12.12,
            "change_peak_torque_Nm": 0.02,
            "change_peak_torque_percent": 0.17,
            "loss_percent": 0.2,
            "tightest": "transmission_angle",
            "missed": ["stroke"],
            "misses": [
                {
                    "quantity": "stroke",
                    "title": "stroke",
                    "kind": "length",
                    "amount": 0.03,
                    "unit": "mm",
                    "side": "below",
                    "allowed": 0.1,
                }
            ],
        }
    ],
    "notes": ["rod has no step and stays unchanged"],
}


_ROUNDED_STREAM = (
    'event: progress\ndata: {"stage":"screening combinations","step":32768,"steps":262144}\n\n'
    'event: rounded\ndata: {"job":7,"number":3,"rounded":{"met":true}}\n\n'
)
_Event = tuple[str, str]
"""Kind and data of each event."""
_Events = Generator[_Event, None, None]


class RoundedModel(OfDesign):
    """Rounded neighbours of a design on a front. rounded: output of `slidercrank round --json`."""

    rounded: dict[str, Any] = Field(examples=[_ROUNDED_EXAMPLE])


_ROUNDED_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The answer; if streamed, preceded by progress events",
        "content": {STREAM: {"schema": {"type": "string"}, "example": _ROUNDED_STREAM}},
    }
}


def round_design(
    request: Request, stored_front: FrontDep, design: DesignNumber, given: Any, units: UnitsParameter = "metric"
) -> Response:
    """Find the best designs with round numbers near a design that meet every requirement, and the cost of each.

    If no design meets all requirements within the allowances, the nearest designs are listed, each with its violations;
    `met` is then false. With `Accept: text/event-stream` the progress is streamed; closing the connection ends the
    search.
    """
    stored_front.row_of_design(design)

    def search() -> _Events:
        """Yield the kind and data of each event."""
        from ..questions.round.analysis import search_rounded_neighbours

        words = {item.name: item.name for item in ROUND.inputs}
        for at in search_rounded_neighbours(
            stored_front.front, design - 1, words, **ROUND.read(given.model_dump(), design)
        ):
            if isinstance(at, Answer):
                record = json_ready(at.record(units))
            else:
                yield "progress", json.dumps(vars(at))
        yield "rounded", RoundedModel(job=stored_front.job.id, number=design, rounded=record).model_dump_json()

    events = search()
    first = next(events)  # an invalid request is rejected before anything is sent
    if STREAM not in request.headers.get("accept", ""):
        *_, (_, data) = itertools.chain([first], events)
        return Response(data, media_type="application/json")
    return StreamingResponse(_event_stream(first, events), headers=STREAM_HEADERS, media_type=STREAM)


round_design.__annotations__["given"] = body_model_of_question(ROUND, "Steps")
router.add_api_route(
    "/jobs/{number}/designs/{design}/rounded",
    round_design,
    methods=["POST"],
    tags=["designs"],
    response_model=RoundedModel,
    responses=_ROUNDED_RESPONSES,
)


async def _event_stream(first: _Event, events: _Events) -> AsyncIterator[bytes]:
    """Return events as a stream, and end the search if the client stops reading."""
    with contextlib.closing(events):
        event: _Event | None = first
        while event is not None:
            yield format_sse_event(data_str=event[1], event=event[0])
            event = await run_sync(next, events, None)
