"""Address or body parameters for the inputs of a question."""

import inspect
from collections.abc import Collection, Iterable
from typing import Annotated, Any, get_origin

from fastapi import Depends, Query, Request
from pydantic import ConfigDict, Field, create_model

from ...model.errors import InputError
from ..questions.front_or_job_question import FrontOrJobQuestion
from ..questions.inputs import Input, PlainInput

_REQUEST = inspect.Parameter("request", inspect.Parameter.KEYWORD_ONLY, annotation=Request)


def parameter_of_input(item: Input, prefix: str = "") -> inspect.Parameter:
    """Return the parameter for an input. prefix: start of its description."""
    kind = float if item.words is None else item.words
    examples = [round(item.unit.factor * item.read(item.example, item.name), 9)] if item.example else None
    query = Query(**_value_limits(item), description=f"{prefix}{item.help}", examples=examples)
    default = item.served_value if isinstance(item, PlainInput) else None
    return inspect.Parameter(
        item.key,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if item.required else default,
        annotation=Annotated[kind | None if default is None and not item.required else kind, query],
    )


def body_model_of_question(question: FrontOrJobQuestion, name: str, **more: Any) -> Any:
    """Return the body model for the inputs of a question. more: further fields for `create_model`."""
    fields: dict[str, Any] = {item.name: _body_field(item) for item in question.inputs if isinstance(item, PlainInput)}
    description = f"Inputs of `{question.name}`. {question.help.partition(chr(10))[0]}"
    return create_model(name, __config__=ConfigDict(extra="forbid", strict=True), __doc__=description, **fields, **more)


_Text = Annotated[str, Field(max_length=500)]
_Value = Annotated[str, Field(max_length=200)]
_TYPES: dict[Any, Any] = {list: list[_Text], dict: dict[_Text, _Value]}


def _body_field(item: PlainInput) -> tuple[Any, Any]:
    """Return type and field for an input in a body."""
    default = ... if item.required else item.value if get_origin(item.type) is None else []
    examples = None if item.sent is None else [item.sent]
    field = Field(default, description=item.help, examples=examples, **_value_limits(item))
    return _TYPES.get(get_origin(item.type), item.type), field


def _value_limits(item: Input) -> dict[str, Any]:
    if isinstance(item, PlainInput):
        return dict(item.limits)
    if item.kind is None:
        return {}
    largest = item.unit.factor * item.kind.limit
    least: dict[str, Any] = {"any": {"ge": -largest}, "positive": {"gt": 0.0}, "zero or more": {"ge": 0.0}}[item.sign]
    return (
        least
        | ({"le": largest} if item.upper_limit is None else {"lt": item.unit.factor * item.upper_limit})
        | {"allow_inf_nan": False}
    )


def inputs_from_query(inputs: Collection[Input], parameters: Iterable[inspect.Parameter]) -> Any:
    """Return the dependency that reads the inputs of an address by name, as text with units.

    It raises `InputError` for an input without its unit, since the unit would otherwise be lost.
    """

    def texts_by_name(request: Request, **given: float | str | None) -> dict[str, str]:
        for item in inputs:
            if item.name != item.key and item.name in request.query_params:
                raise InputError(
                    f"{item.name} must have its unit in its name here; got {item.name}; call it {item.key}"
                )
        typed = ((item, given[item.key]) for item in inputs)
        return {item.name: item.with_unit(value) for item, value in typed if value is not None}

    texts_by_name.__signature__ = inspect.Signature([_REQUEST, *parameters])  # type: ignore[attr-defined]
    return Depends(texts_by_name)
