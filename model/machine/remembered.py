"""Answers about a machine, kept while the same one is asked about."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar

from .mechanism import Mechanism

Given = ParamSpec("Given")
Answer = TypeVar("Answer")


def remembered(
    function: Callable[Concatenate[Mechanism, Given], Answer],
) -> Callable[Concatenate[Mechanism, Given], Answer]:
    """Keep what a function says of the machine that was last asked about: a search asks thousands of times.

    Its other arguments are hashable, and its answers are not written to.
    """
    last: tuple[Mechanism | None, dict[object, Answer]] = (None, {})

    @wraps(function)
    def known(mechanism: Mechanism, /, *given: Given.args, **named: Given.kwargs) -> Answer:
        nonlocal last
        before, answers = last
        if before is not mechanism:
            answers = {}
            last = mechanism, answers
        key = (given, *named.items())
        if key not in answers:
            answers[key] = function(mechanism, *given, **named)
        return answers[key]

    return known
