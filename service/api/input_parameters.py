"""Parameters of an address for what a question is asked with."""

from __future__ import annotations

import inspect
from collections.abc import Collection, Iterable
from typing import Annotated, Any

from fastapi import Depends, Query, Request

from ...model.errors import InputError
from ..questions.inputs import Input

_REQUEST = inspect.Parameter("request", inspect.Parameter.KEYWORD_ONLY, annotation=Request)


def parameter_of(one: Input, before: str = "") -> inspect.Parameter:
    """Return the parameter of an input. before: what its description begins with."""
    kind = float if one.words is None else one.words
    examples = [round(one.unit.factor * one.read(one.example, one.name), 9)] if one.example else None
    query = Query(**_limits(one), description=f"{before}{one.help}", examples=examples)
    return inspect.Parameter(
        one.key,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if one.required else None,
        annotation=Annotated[kind if one.required else kind | None, query],
    )


def _limits(one: Input) -> dict[str, Any]:
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
                raise InputError(f"{one.name} has its unit in its name here; got {one.name}; call it {one.key}")
        typed = ((one, given[one.key]) for one in inputs)
        return {one.name: one.typed(value) for one, value in typed if value is not None}

    named.__signature__ = inspect.Signature([_REQUEST, *parameters])  # type: ignore[attr-defined]
    return Depends(named)
