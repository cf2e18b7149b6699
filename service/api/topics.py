"""Topics of single designs, each by its name: numbers, text and figure, as `analyse --show` has them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Path, Response
from pydantic import BaseModel, Field
from pydantic_core import to_json

from ...model.errors import NotFound
from ...objectives.kinds import System
from ..questions.answers import Answering
from ..questions.discovery import INPUTS, TOPIC_OF, TOPICS
from ..questions.question import Question, QuestionOfDesign
from ..runs.result import json_ready
from .blocks import AnswerBlock, answer_blocks
from .computing import LongRoute
from .exports import SEALED, of_type
from .figures import require_figures
from .fronts import OfDesign
from .input_parameters import inputs_in_address, parameter_of
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import ShownDep, ShownDesign

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


class ToldTopic(OfDesign):
    """A topic of a design. numbers: what `analyse --json` has under its name. told: its text. blocks: that as data."""

    name: str = Field(examples=["balance"])
    numbers: Annotated[dict[str, Any], Answering(lambda: [topic.answer_type for topic in TOPICS.values()])]
    told: list[BlockModel]
    blocks: list[AnswerBlock]


@dataclass(frozen=True)
class Asked:
    """How a topic is asked for. given: inputs by name, as text with their units."""

    units: System
    given: dict[str, str]

    def of(self, topic: Question, shown: ShownDesign) -> QuestionOfDesign:
        """Return the topic of a design. Raises `InputError` for a swing, and for an input of another topic."""
        return topic.asked(shown.design.mechanism, shown.design.linkage, shown.design.part, self.given)

    def kind(self, topic: Question, what: str) -> str:
        """Return the name under which what is made of a topic is kept."""
        return f"topic {topic.name} {what} {self.units} {sorted(self.given.items())}"


_PARAMETERS = (parameter_of(one, f"for the topic {TOPIC_OF[name]}: ") for name, one in INPUTS.items())
GivenDep = Annotated[dict[str, str], inputs_in_address(INPUTS.values(), _PARAMETERS)]


def _asked(given: GivenDep, units: UnitsAsked = "metric") -> Asked:
    return Asked(units, given)


AskedDep = Annotated[Asked, Depends(_asked)]


@router.get(
    "/jobs/{number}/designs/{design}/topics/{topic}.svg",
    dependencies=[Depends(require_figures)],
    **of_type("image/svg+xml"),
)
def draw_topic_svg(shown: ShownDep, topic: Name, asked: AskedDep) -> Response:
    """Draw the figure of one topic of a design, as found or with other numbers."""
    headers = {"Content-Security-Policy": SEALED}
    return Response(_drawn(shown, topic, "svg", asked), media_type="image/svg+xml", headers=headers)


@router.get(
    "/jobs/{number}/designs/{design}/topics/{topic}.png",
    dependencies=[Depends(require_figures)],
    **of_type("image/png"),
)
def draw_topic_png(shown: ShownDep, topic: Name, asked: AskedDep) -> Response:
    """Draw the figure of one topic of a design, as found or with other numbers."""
    return Response(_drawn(shown, topic, "png", asked), media_type="image/png")


@router.get("/jobs/{number}/designs/{design}/topics/{topic}", response_model=ToldTopic)
def tell_topic(shown: ShownDep, topic: Name, asked: AskedDep) -> Response:
    """Give the numbers of one topic of a design, as found or with other numbers, and its text."""
    of = _topic(topic)

    def make() -> tuple[tuple[str], bytes]:
        from ..render.formatting import plain_blocks

        found = asked.of(of, shown)
        numbers = found.numbers()
        blocks = found.blocks(numbers)
        answer = ToldTopic(
            job=shown.found.job.id,
            number=shown.number,
            name=topic,
            numbers=found.numbers_in(json_ready(numbers), asked.units),
            told=[BlockModel(**vars(block)) for block in plain_blocks(blocks, asked.units)],
            blocks=answer_blocks(blocks),
        )
        return (shown.key,), to_json(answer)

    content = shown.found.made(shown.key, asked.kind(of, "told"), make)
    return Response(content, media_type="application/json")


def _drawn(shown: ShownDesign, name: str, kind: Literal["png", "svg"], asked: Asked) -> bytes:
    topic = _topic(name)

    def make() -> tuple[tuple[str], bytes]:
        from ..figures.style import image

        return (shown.key,), image(asked.of(topic, shown).figure(lambda: False, asked.units), kind)

    return shown.found.made(shown.key, asked.kind(topic, kind), make)


def _topic(name: str) -> Question:
    """Return a topic by its name. Raises `NotFound` with those that there are."""
    if name not in TOPICS:
        raise NotFound(f"there is no topic {name!r}; choose from {', '.join(TOPICS)}")
    return TOPICS[name]
