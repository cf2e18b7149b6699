"""Which functions of their own jobs of others may name, and how long a call of one may take."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..model.errors import JobError

if TYPE_CHECKING:
    from ..optimise.engine.engine import Engine
    from ..optimise.problem import Problem

LONGEST_CALL = 300.0
"""s, that a call takes at most in a job of the service, whatever limit the job gives it."""
LONGEST_ANSWER = 10.0
"""s, that a call takes at most while a request waits for it."""


def require_allowed(tables: Mapping[str, Any], allowed: Collection[str]) -> None:
    """Raise `JobError` if a job names a function, as [quantity], that is not one of `allowed` ("module:function")."""
    from ..optimise.units import shown

    parts = tables.get("quantity", {})
    for name, part in parts.items() if isinstance(parts, Mapping) else ():
        function = part.get("function") if isinstance(part, Mapping) else None
        if not (isinstance(function, str) and function in allowed):
            remedy = f"choose from {', '.join(sorted(allowed))}" if allowed else "leave the table out"
            raise JobError(
                f"quantity.{name[:60]}: only functions that the operator allows are run here; got {shown(function)}; "
                f"{remedy}"
            )


def bounded(problem: Problem, seconds: float) -> Problem:
    """Return a problem whose functions of its own are not called for longer than so many s at a time."""
    from ..objectives.own.quantity import bounded

    return (
        replace(problem, own=tuple(bounded(quantity, seconds) for quantity in problem.own)) if problem.own else problem
    )


@contextlib.contextmanager
def ending_own(problem: Problem, engine: Engine | None = None) -> Iterator[None]:
    """End the processes of a problem's own functions on leaving: they idle, or worse, until the problem is forgotten.

    engine: where they may have been called, too; it ends its processes, and starts others when it is next needed.
    """
    from ..objectives.own.quantity import close_own, runs_own

    try:
        yield
    finally:
        for quantity in problem.own:
            close_own(quantity)
        if engine is not None and any(map(runs_own, problem.own)):
            engine.close()
