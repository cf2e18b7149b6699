"""Topics of single designs, each by its name: numbers, text and figure, as in `analyse --show`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Path, Response
from pydantic import BaseModel, Field
from pydantic_core import to_json

from ...model.errors import NotFound
from ...objectives.kinds import System
from ..questions.design_question import BoundQuestion, DesignQuestion
from ..questions.discovery import INPUTS, TOPIC_OF_INPUT, TOPICS
from ..questions.record_types import RecordSchema
from ..runs.result import json_ready
from .blocks import AnswerBlock, block_models
from .computing import LongRoute
from .exports import SEALED, file_responses
from .figures import require_figures
from .fronts import OfDesign
from .input_parameters import inputs_in_address, parameter_of
from .models import UnitsParameter
from .problem_documents import problem_responses
from .stored_fronts import RequestedDesign, RequestedDesignDep

router = APIRouter(route_class=LongRoute, tags=["designs"], responses=problem_responses(409))

Name = Annotated[
    str, Path(pattern=r"^[a-z_]+$", max_length=100, description="of the list of topics", examples=["balance"])
]


class BlockModel(BaseModel):
    """A sentence, or a table where there are rows.

    heading: whether the sentence heads what follows. heads: of the columns, empty where they have none. right: whether
    a column is aligned to the right. rows: the texts of the cells.
    """

    sentence: str = Field(examples=["Motor"])
    heading: bool = Field(examples=[True])
    heads: list[str] = Field(examples=[[]])
    right: list[bool] = Field(examples=[[]])
    rows: list[list[str]] = Field(examples=[[]])


class TopicAnswer(OfDesign):
    """A topic of a design. numbers: what `analyse --json` has under its name. told: its text. blocks: that as data."""

    name: str = Field(examples=["balance"])
    numbers: Annotated[dict[str, Any], RecordSchema(lambda: [topic.record_type for topic in TOPICS.values()])]
    told: list[BlockModel]
    blocks: list[AnswerBlock]


@dataclass(frozen=True)
class TopicRequest:
    """How a topic is asked for. given: inputs by name, as text with their units."""

    units: System
    inputs: dict[str, str]

    def bind(self, topic: DesignQuestion, request: RequestedDesign) -> BoundQuestion:
        """Return the topic of a design. Raises `InputError` for a swing, and for an input of another topic."""
        return topic.for_problem(request.design.mechanism, request.design.linkage, request.design.part, self.inputs)

    def cache_kind(self, topic: DesignQuestion, content: str) -> str:
        """Return the cache name for results of a topic."""
        return f"topic {topic.name} {content} {self.units} {sorted(self.inputs.items())}"


_PARAMETERS = (parameter_of(one, f"for the topic {TOPIC_OF_INPUT[name]}: ") for name, one in INPUTS.items())
TopicInputsDep = Annotated[dict[str, str], inputs_in_address(INPUTS.values(), _PARAMETERS)]


def _topic_request(inputs: TopicInputsDep, units: UnitsParameter = "metric") -> TopicRequest:
    return TopicRequest(units, inputs)


TopicRequestDep = Annotated[TopicRequest, Depends(_topic_request)]


@router.get(
    "/jobs/{number}/designs/{design}/topics/{topic}.svg",
    dependencies=[Depends(require_figures)],
    **file_responses("image/svg+xml"),
)
def draw_topic_svg(request: RequestedDesignDep, topic: Name, topic_request: TopicRequestDep) -> Response:
    """Draw the figure of one topic of a design, as found or with other numbers."""
    headers = {"Content-Security-Policy": SEALED}
    return Response(_drawn(request, topic, "svg", topic_request), media_type="image/svg+xml", headers=headers)


@router.get(
    "/jobs/{number}/designs/{design}/topics/{topic}.png",
    dependencies=[Depends(require_figures)],
    **file_responses("image/png"),
)
def draw_topic_png(request: RequestedDesignDep, topic: Name, topic_request: TopicRequestDep) -> Response:
    """Draw the figure of one topic of a design, as found or with other numbers."""
    return Response(_drawn(request, topic, "png", topic_request), media_type="image/png")


@router.get("/jobs/{number}/designs/{design}/topics/{topic}", response_model=TopicAnswer)
def show_topic(request: RequestedDesignDep, topic: Name, topic_request: TopicRequestDep) -> Response:
    """Give the numbers of one topic of a design, as found or with other numbers, and its text."""
    question = _topic(topic)

    def make() -> tuple[tuple[str], bytes]:
        from ..render.formatting import plain_blocks

        bound_question = topic_request.bind(question, request)
        numbers = bound_question.numbers()
        blocks = bound_question.blocks(numbers)
        topic_model = TopicAnswer(
            job=request.stored_front.job.id,
            number=request.number,
            name=topic,
            numbers=bound_question.numbers_in(json_ready(numbers), topic_request.units),
            told=[BlockModel(**vars(block)) for block in plain_blocks(blocks, topic_request.units)],
            blocks=block_models(blocks),
        )
        return (request.key,), to_json(topic_model)

    content = request.stored_front.cached(request.key, topic_request.cache_kind(question, "told"), make)
    return Response(content, media_type="application/json")


def _drawn(request: RequestedDesign, name: str, kind: Literal["png", "svg"], topic_request: TopicRequest) -> bytes:
    topic = _topic(name)

    def make() -> tuple[tuple[str], bytes]:
        from ..figures.style import figure_bytes

        return (request.key,), figure_bytes(
            topic_request.bind(topic, request).figure(lambda: False, topic_request.units), kind
        )

    return request.stored_front.cached(request.key, topic_request.cache_kind(topic, kind), make)


def _topic(name: str) -> DesignQuestion:
    """Return a topic by its name. Raises `NotFound` with the available names."""
    if name not in TOPICS:
        raise NotFound(f"there is no topic {name!r}; choose from {', '.join(TOPICS)}")
    return TOPICS[name]
