"""Parameters of an address, or of a body, for what a question is asked with."""

from __future__ import annotations

import inspect
from collections.abc import Collection, Iterable
from typing import Annotated, Any, get_origin

from fastapi import Depends, Query, Request
from pydantic import ConfigDict, Field, create_model

from ...model.errors import InputError
from ..questions.inputs import Input
from ..questions.plain_input import Plain
from ..questions.wider import WiderQuestion

_REQUEST = inspect.Parameter("request", inspect.Parameter.KEYWORD_ONLY, annotation=Request)


def parameter_of(one: Input, before: str = "") -> inspect.Parameter:
    """Return the parameter of an input. before: what its description begins with."""
    kind = float if one.words is None else one.words
    examples = [round(one.unit.factor * one.read(one.example, one.name), 9)] if one.example else None
    query = Query(**_limits(one), description=f"{before}{one.help}", examples=examples)
    default = one.value if isinstance(one, Plain) else None
    return inspect.Parameter(
        one.key,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if one.required else default,
        annotation=Annotated[kind | None if default is None and not one.required else kind, query],
    )


def body_of(question: WiderQuestion, name: str, **more: Any) -> Any:
    """Return the model of a body with the inputs of a question. more: further fields, as `create_model` takes them."""
    fields: dict[str, Any] = {one.name: _field(one) for one in question.inputs if isinstance(one, Plain)}
    told = f"What `{question.name}` is asked with. {question.help.partition(chr(10))[0]}"
    return create_model(name, __config__=ConfigDict(extra="forbid", strict=True), __doc__=told, **fields, **more)


_Text = Annotated[str, Field(max_length=500)]
_Value = Annotated[str, Field(max_length=200)]
_TYPES: dict[Any, Any] = {list: list[_Text], dict: dict[_Text, _Value]}


def _field(one: Plain) -> tuple[Any, Any]:
    """Return type and field of an input in a body."""
    default = ... if one.required else one.value if get_origin(one.type) is None else []
    examples = None if one.sent is None else [one.sent]
    field = Field(default, description=one.help, examples=examples, **_limits(one))
    return _TYPES.get(get_origin(one.type), one.type), field


def _limits(one: Input) -> dict[str, Any]:
    if isinstance(one, Plain):
        return dict(one.limits)
    if one.kind is None:
        return {}
    most = one.unit.factor * one.kind.limit
    least: dict[str, Any] = {"any": {"ge": -most}, "positive": {"gt": 0.0}, "zero or more": {"ge": 0.0}}[one.sign]
    return (
        least | ({"le": most} if one.below is None else {"lt": one.unit.factor * one.below}) | {"allow_inf_nan": False}
    )


def inputs_in_address(inputs: Collection[Input], parameters: Iterable[inspect.Parameter]) -> Any:
    """Return the dependency that gives inputs of an address by name, as text with their units.

    It raises `InputError` for one of them without its unit, which else would be lost.
    """

    def named(request: Request, **given: float | str | None) -> dict[str, str]:
        for one in inputs:
            if one.name != one.key and one.name in request.query_params:
                raise InputError(f"{one.name} must have its unit in its name here; got {one.name}; call it {one.key}")
        typed = ((one, given[one.key]) for one in inputs)
        return {one.name: one.typed(value) for one, value in typed if value is not None}

    named.__signature__ = inspect.Signature([_REQUEST, *parameters])  # type: ignore[attr-defined]
    return Depends(named)
