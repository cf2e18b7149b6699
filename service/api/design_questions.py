"""Questions about a design of a front: those that are commands too, and measured curves.

Each answer is what the command of the same name prints with --json.
"""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Response
from pydantic import BaseModel, Field, create_model

from ..designs.measured_file import read_measured
from ..designs.shown_units import record_in
from ..designs.turning import require_turning
from ..questions.answers import Answering
from ..questions.discovery import COMMANDS, OF_DESIGNS
from ..questions.measured import MEASURED
from ..questions.question import Command, QuestionOfDesign
from ..runs.result import json_ready
from .blocks import AnswerBlock, answer_blocks
from .computing import LongRoute, QuickRoute
from .exports import SEALED, of_type
from .figures import require_figures
from .fronts import OfDesign
from .input_parameters import inputs_in_address, parameter_of
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep, ShownDep, ShownDesign

router = APIRouter(
    route_class=QuickRoute, prefix="/jobs/{number}/designs/{design}", tags=["designs"], responses=problem_responses(409)
)


def _add(name: str, says: Command) -> None:
    """Add the endpoints of a question that is a command: its answer, and the figure that it draws."""
    question = OF_DESIGNS[name]
    answer: Any = (Annotated[dict[str, Any], Answering(lambda: [question.answer_type])], ...)
    told = f"What `slidercrank {says.called or name} --json` prints of a design of a front. blocks: its text as data."
    fields: Any = {name: answer, "blocks": (list[AnswerBlock], ...)}
    model = create_model(f"{name.capitalize()}Model", __base__=OfDesign, __doc__=told, **fields)

    def asked(shown: ShownDesign, given: dict[str, str]) -> QuestionOfDesign:
        of, words = shown.design, {one.name: one.key for one in question.inputs}
        return question.asked(of.mechanism, of.linkage, of.part, given, words)

    def tell(shown: ShownDep, given: Any, units: UnitsAsked = "metric") -> OfDesign:
        of = asked(shown, given)
        numbers = of.numbers()
        blocks = answer_blocks(of.blocks(numbers), of.notes(numbers))
        record = {name: record_in(json_ready(numbers), units)}
        return model(job=shown.found.job.id, number=shown.number, blocks=blocks, **record)

    def draw(shown: ShownDep, given: Any, units: UnitsAsked = "metric") -> Response:
        from ..figures.panels import figure_of
        from ..figures.style import image

        def make() -> tuple[tuple[str], bytes]:
            of = asked(shown, given)
            of.numbers()
            return (shown.key,), image(figure_of(of.written("figure", units), units), "svg")

        content = shown.found.made(shown.key, f"{name} svg {units} {sorted(given.items())}", make)
        return Response(content, media_type="image/svg+xml", headers={"Content-Security-Policy": SEALED})

    route = LongRoute if says.sizes else QuickRoute
    tell.__name__, tell.__doc__ = says.endpoint, says.help
    draw.__name__, draw.__doc__ = f"draw_{name}", f"Draw the figure of what `slidercrank {says.called or name}` finds."
    inputs = inputs_in_address(question.inputs, map(parameter_of, question.inputs))
    for endpoint in (tell, draw):
        endpoint.__annotations__["given"] = Annotated[dict[str, str], inputs]
    router.add_api_route(f"/{name}", tell, response_model=model, route_class_override=route)
    if says.figure:
        svg = of_type("image/svg+xml")
        needs = [Depends(require_figures)]
        router.add_api_route(f"/{name}.svg", draw, dependencies=needs, route_class_override=route, **svg)


for _name, _says in COMMANDS.items():
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

    measured: Annotated[dict[str, Any], Answering(lambda: [MEASURED.answer_type])]


@router.post("/measured")
def compare_measured(
    found: FrontDep, design: DesignNumber, given: MeasuredCurves, units: UnitsAsked = "metric"
) -> MeasuredModel:
    """Compare measured curves with those of a design: deviations, and the shifts that fit best."""
    stored = found.design(design)
    require_turning(stored.part.motion, "a comparison with measured curves")
    samples = read_measured(given.csv, stored.mechanism, stored.linkage)
    topic = MEASURED.of(stored.mechanism, stored.linkage, {"measured": samples})
    record = json_ready(topic.numbers())
    return MeasuredModel(job=found.job.id, number=design, measured=record_in(record, units))
