"""Options of the command line for what a question is asked with."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any, get_origin

import typer

from ..questions.inputs import Input
from ..questions.plain_input import Plain
from ..questions.wider import Watch, WiderQuestion
from ..text.screen import waiting

_Command = Callable[..., None]


def option_of(one: Input) -> inspect.Parameter:
    """Return the option of an input, a text or a word that typer knows."""
    if isinstance(one, Plain):
        return _plain_option(one)
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


def _plain_option(one: Plain) -> inspect.Parameter:
    """Return the option of a number, or of texts, of which it may be repeated."""
    kind: Any = one.type if get_origin(one.type) is None else list[str]
    optional = not (one.required or one.usual)
    return inspect.Parameter(
        one.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if one.required else one.value,
        annotation=Annotated[
            kind | None if optional else kind,
            typer.Option(one.flag, metavar=one.metavar, min=one.least, help=one.help),
        ],
    )


def options_of(question: WiderQuestion, *, optional: bool = False) -> tuple[inspect.Parameter, ...]:
    """Return the options of all inputs. optional: whether the command has another way of being asked."""
    found = tuple(map(option_of, question.inputs))
    return tuple(one.replace(default=None) for one in found) if optional else found


def helped(question: WiderQuestion, more: str = "") -> Callable[[_Command], _Command]:
    """Return a decorator that gives a command the help of its question, and more of what the command itself does."""

    def with_help(command: _Command) -> _Command:
        command.__doc__ = f"{question.help} {more}".rstrip()
        return command

    return with_help


@contextmanager
def watching(text: str, cancelled: Callable[[], bool] = lambda: False) -> Iterator[Watch]:
    """Enter a context that shows an activity while an answer is searched, and where the search is."""
    with waiting(text) as status:
        yield Watch(cancelled=cancelled, tell=lambda words: None if status is None else status.update(words))
