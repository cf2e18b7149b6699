"""Questions about a design of a front: those that are commands too, and measured curves.

Each answer is what the command of the same name prints with --json.
"""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import BaseModel, Field, create_model

from ..designs.measured_file import read_measured
from ..designs.shown_units import record_in
from ..designs.turning import require_turning
from ..questions.answers import Answering
from ..questions.discovery import COMMANDS, OF_DESIGNS
from ..questions.measured import MEASURED
from ..questions.question import Command
from ..runs.result import json_ready
from .computing import LongRoute, QuickRoute
from .fronts import OfDesign
from .input_parameters import inputs_in_address, parameter_of
from .models import UnitsAsked
from .problems import problem_responses
from .stored_fronts import DesignNumber, FrontDep

router = APIRouter(
    route_class=QuickRoute, prefix="/jobs/{number}/designs/{design}", tags=["designs"], responses=problem_responses(409)
)


def _add(name: str, says: Command) -> None:
    """Add the endpoint of a question that is a command."""
    question = OF_DESIGNS[name]
    answer: Any = (Annotated[dict[str, Any], Answering(lambda: [question.answer_type])], ...)
    told = f"What `slidercrank {says.called or name} --json` prints of a design of a front."
    model = create_model(f"{name.capitalize()}Model", __base__=OfDesign, __doc__=told, **{name: answer})

    def endpoint(found: FrontDep, design: DesignNumber, given: Any, units: UnitsAsked = "metric") -> OfDesign:
        stored, words = found.design(design), {one.name: one.key for one in question.inputs}
        asked = question.asked(stored.mechanism, stored.linkage, stored.part, given, words)
        return model(job=found.job.id, number=design, **{name: record_in(json_ready(asked.numbers()), units)})

    endpoint.__name__, endpoint.__doc__ = says.endpoint, says.help
    inputs = inputs_in_address(question.inputs, map(parameter_of, question.inputs))
    endpoint.__annotations__["given"] = Annotated[dict[str, str], inputs]
    router.add_api_route(
        f"/{name}",
        endpoint,
        response_model=model,
        route_class_override=LongRoute if says.sizes else QuickRoute,
    )


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
