"""Command-line options for the inputs of a question."""

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any, get_origin

import typer

from ..questions.front_or_job_question import FrontOrJobQuestion, SearchListener
from ..questions.inputs import Input, PlainInput
from ..text.screen import show_activity

_Command = Callable[..., None]


def option_of_input(item: Input) -> inspect.Parameter:
    """Return the command-line option for an input."""
    least, has_default = None, False
    if isinstance(item, PlainInput):
        kind: Any = item.type if get_origin(item.type) is None else list[str]
        default, metavar, least, text = item.value, item.metavar, item.least, item.help
        has_default = bool(item.usual)
    else:
        kind = str if item.loose else item.words or str
        default, metavar, text = None, item.name.upper() if item.loose else None, item.remark
        if item.kind is not None:
            metavar = item.kind.name_without_article.upper().replace(" ", "_")
    return inspect.Parameter(
        item.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if item.required else default,
        annotation=Annotated[
            kind if item.required or has_default else kind | None,
            typer.Option(item.flag, metavar=metavar, min=least, help=text),
        ],
    )


def options_of_question(question: FrontOrJobQuestion, *, optional: bool = False) -> tuple[inspect.Parameter, ...]:
    """Return the options for all inputs. optional: whether the command works without them."""
    options = tuple(map(option_of_input, question.inputs))
    return tuple(option.replace(default=None) for option in options) if optional else options


def with_question_help(question: FrontOrJobQuestion, addition: str = "") -> Callable[[_Command], _Command]:
    """Return a decorator that adds the help of a question, and a text specific to the command."""

    def with_help(command: _Command) -> _Command:
        command.__doc__ = f"{question.help} {addition}".rstrip()
        return command

    return with_help


@contextmanager
def search_listener(text: str, cancelled: Callable[[], bool] = lambda: False) -> Iterator[SearchListener]:
    """Enter a context that shows activity and progress during a search."""
    with show_activity(text) as status:
        yield SearchListener(cancelled=cancelled, report=lambda words: None if status is None else status.update(words))
