"""Meanings and display units of dimensions and quantities, and the topics available for designs."""

from typing import get_args, get_origin

from fastapi import APIRouter
from pydantic import BaseModel, Field

from ...objectives.formula.expression import ARGUMENTS
from ...objectives.kinds import DISPLAYED_KINDS, KINDS, metric_unit_in
from ..designs.quantity_facts import facts_of_all_quantities
from ..questions.design_question import DesignQuestion
from ..questions.discovery import DESIGN_QUESTIONS, FRONT_OR_JOB_QUESTIONS, QUESTION_COMMANDS, TOPICS
from ..questions.front_or_job_question import FrontOrJobQuestion
from ..questions.inputs import PlainInput

router = APIRouter(tags=["designs"])


class QuantityModel(BaseModel):
    """A quantity, explained.

    name: as in job files. column: key in tables and JSON. unit: unit of the column. picture: what a picture of the
    linkage highlights for it. section: section of docs/theory.md with its derivation. source: source of the equations.
    """

    name: str = Field(examples=["stroke"])
    column: str = Field(examples=["stroke_mm"])
    title: str = Field(examples=["stroke"])
    unit: str = Field(examples=["mm"])
    kind: str = Field(description="kind of its values", examples=["length"])
    group: str = Field(description="group in which it is shown", examples=["Motion"])
    sentence: str = Field(examples=["The stroke is the distance of the slider between its two dead centres."])
    advice: str = Field(description='usual values; "" if there is nothing to say')
    formula: str = Field(examples=["S = sqrt((l+r)^2 - e^2) - sqrt((l-r)^2 - e^2)"])
    section: str = Field(examples=["2. Closed forms"])
    source: str
    picture: str = Field(examples=["stroke"])
    better: str = Field(
        description='its good side, which requirements usually ask for: low or high; "" without one',
        examples=["low"],
    )
    allowed_by: str = Field(description='origin of its allowable value; "" without one', examples=[""])
    offered: list[str] = Field(description="parts of a form that offer it", examples=[["motion"]])
    motion: str = Field(
        description="motions to which it applies: turn or swing of a crank, lever, arm; empty for all",
        examples=["turn"],
    )


class FunctionModel(BaseModel):
    """Function for formulas, and its number of arguments."""

    name: str = Field(examples=["max"])
    least: int = Field(examples=[2])
    most: int = Field(examples=[20])


class QuantityList(BaseModel):
    """All quantities: dimensions, design quantities, and those of motion laws. functions: functions for formulas."""

    quantities: list[QuantityModel]
    functions: list[FunctionModel]


class UnitModel(BaseModel):
    """Unit of the API in another unit system. factor: value in it of one unit of the API."""

    unit: str = Field(examples=["in"])
    factor: float = Field(examples=[1 / 25.4])


class TypedUnit(BaseModel):
    """Unit that users may type. factor: its value in SI."""

    unit: str = Field(examples=["mm"])
    factor: float = Field(examples=[1e-3])


class KindModel(BaseModel):
    """Kind of value. units: units that a form offers, the SI unit first. si, inch: default unit in a form.

    spoken: words other than units that values of this kind may have, each with the unit that it stands for.
    """

    name: str = Field(examples=["length"])
    units: list[TypedUnit]
    spoken: dict[str, str] = Field(examples=[{"1/min": "rpm"}])
    si: str = Field(examples=["mm"])
    inch: str = Field(examples=["in"])


class UnitTable(BaseModel):
    """Units of values, for display and for input.

    inch: US customary unit for each API unit that differs. suffixes: key endings for values in an API unit, by unit.
    titles: titles of quantities whose columns are worded differently.
    """

    kinds: list[KindModel]
    inch: dict[str, UnitModel] = Field(examples=[{"mm": {"unit": "in", "factor": 1 / 25.4}}])
    suffixes: dict[str, str] = Field(examples=[{"mm": "_mm", "m/s^2": "_m_s2"}])
    titles: dict[str, str] = Field(examples=[{"rms_torque_Nm": "RMS torque over time"}])


class InputModel(BaseModel):
    """Input of a question. key: name in the address. title: label of its field. unit: of the key. usual: default.

    words: allowed words, none for a number. several: whether it is a list of texts. required: whether it is mandatory.
    example: as typed.
    """

    key: str = Field(examples=["crank_angle_deg"])
    title: str = Field(examples=["Crank angle"])
    help: str = Field(examples=["Crank angle at which the polygons are drawn."])
    unit: str = Field(examples=["deg"])
    usual: str = Field(examples=["30 deg"])
    words: list[str] = Field(examples=[[]])
    several: bool = False
    required: bool
    example: str = Field(examples=[""])


class TopicModel(BaseModel):
    """Question about a design. path: path below that of the design. title: heading. shows: its subject, in words.

    premise: what it needs of a machine, "" if any machine has it. command: equivalent command of the command line.
    figure: whether the path with .svg gives a figure. posted: whether the inputs form the request body.
    """

    name: str = Field(examples=["balance"])
    path: str = Field(examples=["topics/balance"])
    command: str = Field(examples=["analyse --show balance"])
    figure: bool
    posted: bool = False
    title: str = Field(examples=["Shaking forces"])
    shows: str = Field(examples=["shaking force and moment"])
    premise: str = Field("", examples=["a motor"])
    inputs: list[InputModel] = Field(examples=[[]])


class TopicList(BaseModel):
    """Topics that a design may have, in order. questions: those that are separate commands.

    fronts: questions about a front; their paths are complete, with the numbers of job and design in braces.
    """

    topics: list[TopicModel]
    questions: list[TopicModel]
    fronts: list[TopicModel]


@router.get("/units")
def list_units() -> UnitTable:
    """List the units for every kind, and the equivalents of API units in inches and pounds."""
    from ...objectives.kinds import name_unit_and_factor_of_key
    from ...objectives.registry import FACTS
    from ...objectives.units import value_of_one_si_unit_in

    inch_units = [
        (kind.metric.symbol, metric_unit_in(kind.metric.symbol, "inch")) for kind in DISPLAYED_KINDS if kind.inch
    ]
    kinds = [
        KindModel(
            name=kind.name_without_article,
            units=[TypedUnit(unit=unit, factor=1.0 / value_of_one_si_unit_in(unit)) for unit in kind.typed],
            spoken=dict(kind.spoken),
            si=kind.usual or kind.metric.symbol,
            inch=(kind.inch or kind.metric).symbol,
        )
        for kind in KINDS
        if kind.typed
    ]
    return UnitTable(
        kinds=kinds,
        inch={symbol: UnitModel(unit=unit, factor=factor) for symbol, (unit, factor) in inch_units},
        suffixes={kind.metric.symbol: kind.metric.suffix for kind in DISPLAYED_KINDS},
        titles={
            quantity.field: quantity.title
            for quantity in FACTS.values()
            if quantity.title != name_unit_and_factor_of_key(quantity.field)[0].replace("_", " ")
        },
    )


@router.get("/quantities")
def list_quantities() -> QuantityList:
    """Explain every quantity in a sentence, with its formula and contributions."""
    return QuantityList(
        quantities=[QuantityModel(**facts) for facts in facts_of_all_quantities()],
        functions=[
            FunctionModel(name=name, least=least, most=greatest) for name, (least, greatest) in ARGUMENTS.items()
        ],
    )


@router.get("/topics")
def list_topics() -> TopicList:
    """List the topics that a design may have, and the questions about a design or a front that are commands."""
    topics = [
        _topic_model(question, f"topics/{question.name}", f"analyse --show {question.name}")
        for question in TOPICS.values()
    ]
    questions = [
        _topic_model(DESIGN_QUESTIONS[name], name, says.called or name) for name, says in QUESTION_COMMANDS.items()
    ]
    fronts = [
        _topic_model(question, question.path, name)
        for name, question in FRONT_OR_JOB_QUESTIONS.items()
        if question.subject == "front"
    ]
    return TopicList(topics=topics, questions=questions, fronts=fronts)


def _topic_model(question: DesignQuestion | FrontOrJobQuestion, path: str, command: str) -> TopicModel:
    inputs = [
        InputModel(
            key=item.key,
            title=item.title or item.name.replace("_", " ").capitalize(),
            help=item.help,
            unit=item.unit.symbol,
            usual=item.served or item.usual if isinstance(item, PlainInput) else item.usual,
            words=get_args(item.words),
            several=isinstance(item, PlainInput) and get_origin(item.type) is list,
            required=item.required,
            example=item.example,
        )
        for item in question.inputs
    ]
    title = question.title or question.name.replace("_", " ").capitalize()
    return TopicModel(
        name=question.name,
        path=path,
        command=command,
        figure=isinstance(question, DesignQuestion) and (question.command is None or bool(question.command.figure)),
        posted=isinstance(question, FrontOrJobQuestion) and question.posted,
        title=title,
        shows=question.shows,
        premise=question.premise.words if isinstance(question, DesignQuestion) and question.premise else "",
        inputs=inputs,
    )
