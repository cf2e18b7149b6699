"""Questions about a design of a front that are also commands, and measured curves.

Each answer equals the output of the command of the same name with --json.
"""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Response
from pydantic import BaseModel, Field, create_model

from ..designs.display_units import record_in
from ..designs.measured_file import read_measured
from ..designs.rotating_crank import require_rotating_crank
from ..questions.design_question import BoundQuestion, QuestionCommand
from ..questions.discovery import DESIGN_QUESTIONS, QUESTION_COMMANDS
from ..questions.measured import MEASURED
from ..questions.record_types import RecordSchema
from ..runs.result import json_ready
from .blocks import AnswerBlock, block_models
from .computing import LongRoute, QuickRoute
from .exports import SEALED, file_responses
from .figures import require_figures
from .fronts import OfDesign
from .input_parameters import inputs_in_address, parameter_of
from .models import UnitsParameter
from .problem_documents import problem_responses
from .stored_fronts import DesignNumber, FrontDep, RequestedDesign, RequestedDesignDep

router = APIRouter(
    route_class=QuickRoute, prefix="/jobs/{number}/designs/{design}", tags=["designs"], responses=problem_responses(409)
)


def _add(name: str, says: QuestionCommand) -> None:
    """Add the endpoints of a question that is a command: its answer and its figure."""
    question = DESIGN_QUESTIONS[name]
    numbers_field: Any = (Annotated[dict[str, Any], RecordSchema(lambda: [question.record_type])], ...)
    description = (
        f"What `slidercrank {says.called or name} --json` prints of a design of a front. blocks: its text as data."
    )
    fields: Any = {name: numbers_field, "blocks": (list[AnswerBlock], ...)}
    model = create_model(f"{name.capitalize()}Model", __base__=OfDesign, __doc__=description, **fields)

    def bind(request: RequestedDesign, inputs: dict[str, str]) -> BoundQuestion:
        design, words = request.design, {item.name: item.key for item in question.inputs}
        return question.for_problem(design.mechanism, design.linkage, design.part, inputs, words)

    def show_numbers(request: RequestedDesignDep, given: Any, units: UnitsParameter = "metric") -> OfDesign:
        bound_question = bind(request, given)
        numbers = bound_question.numbers()
        blocks = block_models(bound_question.blocks(numbers), bound_question.notes(numbers))
        record = {name: record_in(json_ready(numbers), units)}
        return model(job=request.stored_front.job.id, number=request.number, blocks=blocks, **record)

    def draw(request: RequestedDesignDep, given: Any, units: UnitsParameter = "metric") -> Response:
        from ..figures.panels import figure_of
        from ..figures.style import figure_bytes

        def make() -> tuple[tuple[str], bytes]:
            bound_question = bind(request, given)
            bound_question.numbers()
            return (request.key,), figure_bytes(figure_of(bound_question.written("figure", units), units), "svg")

        content = request.stored_front.cached(request.key, f"{name} svg {units} {sorted(given.items())}", make)
        return Response(content, media_type="image/svg+xml", headers={"Content-Security-Policy": SEALED})

    route = LongRoute if says.sizes else QuickRoute
    show_numbers.__name__, show_numbers.__doc__ = says.endpoint, says.help
    draw.__name__, draw.__doc__ = f"draw_{name}", f"Draw the figure of what `slidercrank {says.called or name}` finds."
    inputs = inputs_in_address(question.inputs, map(parameter_of, question.inputs))
    for endpoint in (show_numbers, draw):
        endpoint.__annotations__["given"] = Annotated[dict[str, str], inputs]
    router.add_api_route(f"/{name}", show_numbers, response_model=model, route_class_override=route)
    if says.figure:
        svg = file_responses("image/svg+xml")
        needs = [Depends(require_figures)]
        router.add_api_route(f"/{name}.svg", draw, dependencies=needs, route_class_override=route, **svg)


for _name, _says in QUESTION_COMMANDS.items():
    _add(_name, _says)


class MeasuredCurves(BaseModel, extra="forbid", strict=True):
    """Measured curves as a CSV file has them. Its first line names the columns, each with its unit."""

    csv: str = Field(
        description="text of the file: crank_angle_deg, or time_s at the job's speed, and curves such as torque_Nm",
        examples=["crank_angle_deg,slider_position_mm\n0,190.5\n120,120.2\n240,131\n"],
    )


class MeasuredModel(OfDesign):
    """Deviation of measured curves from those of a design of a front.

    measured: of `slidercrank analyse --measured --json`; measured minus computed, by curve. What is to be added to the
    crank angles and values for the best fit is told, not applied.
    """

    measured: Annotated[dict[str, Any], RecordSchema(lambda: [MEASURED.record_type])]


@router.post("/measured")
def compare_measured(
    stored_front: FrontDep, design: DesignNumber, measured_curves: MeasuredCurves, units: UnitsParameter = "metric"
) -> MeasuredModel:
    """Compare measured curves with those of a design: deviations, and the shifts that fit best."""
    stored = stored_front.design(design)
    require_rotating_crank(stored.part.motion, "a comparison with measured curves")
    samples = read_measured(measured_curves.csv, stored.mechanism, stored.linkage)
    topic = MEASURED.for_design(stored.mechanism, stored.linkage, {"measured": samples})
    record = json_ready(topic.numbers())
    return MeasuredModel(job=stored_front.job.id, number=design, measured=record_in(record, units))
