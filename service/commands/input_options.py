"""Options of the command line for what a question is asked with."""

from __future__ import annotations

import inspect
from typing import Annotated, Any

import typer

from ..questions.inputs import Input


def option_of(one: Input) -> inspect.Parameter:
    """Return the option of an input, a text or a word that typer knows."""
    metavar = one.name.upper() if one.loose else None
    if one.kind is not None:
        metavar = one.kind.plain.upper().replace(" ", "_")
    kind: Any = str if one.loose else one.words or str
    return inspect.Parameter(
        one.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if one.required else None,
        annotation=Annotated[
            kind if one.required else kind | None, typer.Option(one.flag, metavar=metavar, help=one.remark)
        ],
    )
