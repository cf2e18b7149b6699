"""Questions about a design on a front: topics (`analyse --show`), separate commands, and measured curves.

Each answer equals the `--json` output of the command with the same name.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Literal

from fastapi import APIRouter, Depends, Path, Response
from pydantic import BaseModel, Field, create_model
from pydantic_core import to_json

from ...model.errors import NotFound
from ...objectives.kinds import System
from ..designs.display_units import convert_record
from ..designs.measured_curves_file import parse_measured_curves
from ..designs.rotating_crank import require_rotating_crank
from ..questions.design_question import BoundQuestion, QuestionCommand
from ..questions.discovery import DESIGN_QUESTIONS, INPUTS, QUESTION_COMMANDS, TOPIC_OF_INPUT, TOPICS
from ..questions.measured import MEASURED
from ..questions.record_types import RecordSchema
from ..render.formatting import PlainBlock, plain_blocks
from ..runs.result import json_ready
from .blocks import AnswerBlock, block_models
from .computing import LongRoute, QuickRoute
from .figures import figure_response, require_figures
from .front_files import file_endpoint_options
from .fronts import OfDesign
from .input_parameters import inputs_from_query, parameter_of_input
from .problem_documents import problem_responses
from .settings import UnitsParameter
from .stored_fronts import DesignNumber, FrontDep, RequestedDesign, RequestedDesignDep

if TYPE_CHECKING:
    from matplotlib.figure import Figure

router = APIRouter(
    route_class=LongRoute, prefix="/jobs/{number}/designs/{design}", tags=["designs"], responses=problem_responses(409)
)


def _figure_response(
    request: RequestedDesign, key: str, kind: Literal["png", "svg"], draw: Callable[[], Figure]
) -> Response:
    """Return the figure for a question about a design. key: name in the cache."""

    def make() -> tuple[tuple[str], bytes]:
        from ..figures.style import figure_bytes

        return (request.cache_key,), figure_bytes(draw(), kind)

    return figure_response(request.stored_front.cached_item(request.cache_key, key, make), kind)


TopicName = Annotated[
    str, Path(pattern=r"^[a-z_]+$", max_length=100, description="name from the list of topics", examples=["balance"])
]


class TopicAnswer(OfDesign):
    """Topic of a design. numbers: its part of `analyse --json`. told: its text. blocks: the text as data."""

    name: str = Field(examples=["balance"])
    numbers: Annotated[dict[str, Any], RecordSchema(lambda: [topic.record_type for topic in TOPICS.values()])]
    told: list[PlainBlock]
    blocks: list[AnswerBlock]


_PARAMETERS = (parameter_of_input(one, f"for the topic {TOPIC_OF_INPUT[name]}: ") for name, one in INPUTS.items())
TopicInputsDep = Annotated[dict[str, str], inputs_from_query(INPUTS.values(), _PARAMETERS)]


@router.get("/topics/{topic}.svg", dependencies=[Depends(require_figures)], **file_endpoint_options("image/svg+xml"))
def draw_topic_svg(
    request: RequestedDesignDep, topic: TopicName, inputs: TopicInputsDep, units: UnitsParameter = "metric"
) -> Response:
    """Draw the figure for one topic of a design, as stored or with other numbers."""
    return _topic_figure(request, topic, inputs, units, "svg")


@router.get("/topics/{topic}.png", dependencies=[Depends(require_figures)], **file_endpoint_options("image/png"))
def draw_topic_png(
    request: RequestedDesignDep, topic: TopicName, inputs: TopicInputsDep, units: UnitsParameter = "metric"
) -> Response:
    """Draw the figure for one topic of a design, as stored or with other numbers."""
    return _topic_figure(request, topic, inputs, units, "png")


@router.get("/topics/{topic}", response_model=TopicAnswer)
def show_topic(
    request: RequestedDesignDep, topic: TopicName, inputs: TopicInputsDep, units: UnitsParameter = "metric"
) -> Response:
    """Return the numbers and the text for one topic of a design, as stored or with other numbers."""
    bound_question = _topic_bound_to_design(request, topic, inputs)

    def make() -> tuple[tuple[str], bytes]:
        numbers = bound_question.numbers()
        blocks = bound_question.blocks(numbers)
        topic_model = TopicAnswer(
            job=request.stored_front.job.id,
            number=request.number,
            name=topic,
            numbers=bound_question.numbers_in_units(json_ready(numbers), units),
            told=plain_blocks(blocks, units),
            blocks=block_models(blocks),
        )
        return (request.cache_key,), to_json(topic_model)

    content = request.stored_front.cached_item(
        request.cache_key, f"topic {topic} told {units} {sorted(inputs.items())}", make
    )
    return Response(content, media_type="application/json")


def _topic_figure(
    request: RequestedDesign, topic: str, inputs: dict[str, str], units: System, kind: Literal["png", "svg"]
) -> Response:
    bound_question = _topic_bound_to_design(request, topic, inputs)
    key = f"topic {topic} {kind} {units} {sorted(inputs.items())}"
    return _figure_response(request, key, kind, lambda: bound_question.figure(lambda: False, units))


def _topic_bound_to_design(request: RequestedDesign, topic: str, inputs: dict[str, str]) -> BoundQuestion:
    """Return a topic for a design. Raises `NotFound` for an unknown name, and the errors of `for_problem`."""
    if topic not in TOPICS:
        raise NotFound(f"there is no topic {topic!r}; choose from {', '.join(TOPICS)}")
    design = request.design
    return TOPICS[topic].bind_to_problem(design.mechanism, design.linkage, design.part, inputs)


def _add_question_endpoints(name: str, says: QuestionCommand) -> None:
    """Add the endpoints of a question that is also a command: its answer and its figure."""
    question = DESIGN_QUESTIONS[name]
    numbers_field: Any = (Annotated[dict[str, Any], RecordSchema(lambda: [question.record_type])], ...)
    description = (
        f"Output of `slidercrank {says.called or name} --json` for a design of a front. blocks: its text as data."
    )
    fields: Any = {name: numbers_field, "blocks": (list[AnswerBlock], ...)}
    model = create_model(f"{name.capitalize()}Model", __base__=OfDesign, __doc__=description, **fields)

    def bind(request: RequestedDesign, inputs: dict[str, str]) -> BoundQuestion:
        design, words = request.design, {item.name: item.key for item in question.inputs}
        return question.bind_to_problem(design.mechanism, design.linkage, design.part, inputs, words)

    def show_numbers(request: RequestedDesignDep, given: Any, units: UnitsParameter = "metric") -> OfDesign:
        bound_question = bind(request, given)
        numbers = bound_question.numbers()
        blocks = block_models(bound_question.blocks(numbers), bound_question.notes(numbers))
        record = {name: convert_record(json_ready(numbers), units)}
        return model(job=request.stored_front.job.id, number=request.number, blocks=blocks, **record)

    def draw(request: RequestedDesignDep, given: Any, units: UnitsParameter = "metric") -> Response:
        def figure() -> Figure:
            from ..figures.panel_drawing import draw_figure

            bound_question = bind(request, given)
            bound_question.numbers()
            return draw_figure(bound_question.output_of("figure", units), units)

        return _figure_response(request, f"{name} svg {units} {sorted(given.items())}", "svg", figure)

    route = LongRoute if says.sizes else QuickRoute
    show_numbers.__name__, show_numbers.__doc__ = says.endpoint, says.help
    draw.__name__, draw.__doc__ = f"draw_{name}", f"Draw the result of `slidercrank {says.called or name}`."
    inputs = inputs_from_query(question.inputs, map(parameter_of_input, question.inputs))
    for endpoint in (show_numbers, draw):
        endpoint.__annotations__["given"] = Annotated[dict[str, str], inputs]
    router.add_api_route(f"/{name}", show_numbers, response_model=model, route_class_override=route)
    if says.figure:
        svg = file_endpoint_options("image/svg+xml")
        needs = [Depends(require_figures)]
        router.add_api_route(f"/{name}.svg", draw, dependencies=needs, route_class_override=route, **svg)


for _name, _says in QUESTION_COMMANDS.items():
    _add_question_endpoints(_name, _says)


class MeasuredCurves(BaseModel, extra="forbid", strict=True):
    """Measured curves, as text of a CSV file. The first line names the columns with their units."""

    csv: str = Field(
        description="text of the file: crank_angle_deg, or time_s at the job's speed, and curves such as torque_Nm",
        examples=["crank_angle_deg,slider_position_mm\n0,190.5\n120,120.2\n240,131\n"],
    )


class MeasuredModel(OfDesign):
    """Deviation of measured curves from those of a design on a front.

    measured: output of `slidercrank analyse --measured --json`; measured minus computed, by curve. The shifts of crank
    angle and value for the best fit are reported, not applied.
    """

    measured: Annotated[dict[str, Any], RecordSchema(lambda: [MEASURED.record_type])]


def compare_measured(
    stored_front: FrontDep, design: DesignNumber, measured_curves: MeasuredCurves, units: UnitsParameter = "metric"
) -> MeasuredModel:
    """Compare measured curves with those of a design: deviations, and the best-fit shifts."""
    stored = stored_front.design(design)
    require_rotating_crank(stored.part.motion, "a comparison with measured curves")
    samples = parse_measured_curves(measured_curves.csv, stored.mechanism, stored.linkage)
    topic = MEASURED.bind_to_design(stored.mechanism, stored.linkage, {"measured": samples})
    record = json_ready(topic.numbers())
    return MeasuredModel(job=stored_front.job.id, number=design, measured=convert_record(record, units))


router.add_api_route("/measured", compare_measured, methods=["POST"], route_class_override=QuickRoute)
