"""Options of the command line for what a question is asked with."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any, get_origin

import typer

from ..questions.front_or_job_question import FrontOrJobQuestion, SearchListener
from ..questions.inputs import Input
from ..questions.typed_input import TypedInput
from ..text.screen import show_activity

_Command = Callable[..., None]


def option_of(one: Input) -> inspect.Parameter:
    """Return the option of an input, a text or a word that typer knows."""
    if isinstance(one, TypedInput):
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


def _plain_option(one: TypedInput) -> inspect.Parameter:
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


def options_of(question: FrontOrJobQuestion, *, optional: bool = False) -> tuple[inspect.Parameter, ...]:
    """Return the options of all inputs. optional: whether the command has another way of being asked."""
    options = tuple(map(option_of, question.inputs))
    return tuple(option.replace(default=None) for option in options) if optional else options


def with_question_help(question: FrontOrJobQuestion, addition: str = "") -> Callable[[_Command], _Command]:
    """Return a decorator that gives a command the help of its question, and more of what the command itself does."""

    def with_help(command: _Command) -> _Command:
        command.__doc__ = f"{question.help} {addition}".rstrip()
        return command

    return with_help


@contextmanager
def search_listener(text: str, cancelled: Callable[[], bool] = lambda: False) -> Iterator[SearchListener]:
    """Enter a context that shows an activity while an answer is searched, and where the search is."""
    with show_activity(text) as status:
        yield SearchListener(cancelled=cancelled, report=lambda words: None if status is None else status.update(words))
