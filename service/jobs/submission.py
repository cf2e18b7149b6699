"""Submission of a job to the store: reads and checks its tables and functions.

These functions run where a job is solved, so the operator of the workers must allow them, with `serve` and `worker
--allow-quantity`. The API rejects all others immediately; `submit` does not know the workers, and leaves this check to
them.
"""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Unpack

from ...model.errors import JobError
from ...objectives.units import quote
from ..runs.result import json_text
from ..store import NO_LIMITS, Artefact, Job, Limits, Queueing, Store

if TYPE_CHECKING:
    from ...optimise.engine.engine import Engine
    from ...optimise.problem.problem import Problem

LONGEST_CALL = 300.0
"""Maximum time per function call in a job of the service, s, whatever limit the job sets."""
LONGEST_WAIT = 10.0
"""Maximum time per function call while a request waits for it, s."""


def parse_with_allowed_functions(
    tables: Mapping[str, Any],
    allowed: Collection[str],
    values: Mapping[str, Any] | None = None,
    *,
    require_feasible: bool = True,
) -> Problem:
    """Return the problem of a job whose functions, "module:function", are all in `allowed`; no function is called.

    values: replacements for numbers in the job, by path. require_feasible: whether to reject a job that no design can
    meet. Raises `JobError`.
    """
    from ...optimise.job import parse_job
    from ...optimise.job.job_file import require_few_values_and_no_nulls

    require_few_values_and_no_nulls(tables)
    require_allowed_functions(tables, allowed)
    return parse_job(tables, values, require_feasible=require_feasible)


def require_allowed_functions(tables: Mapping[str, Any], allowed: Collection[str]) -> None:
    """Raise `JobError` for a job that names a function that is not allowed."""
    for name, function in functions_of(tables).items():
        if function not in allowed:
            raise _function_not_allowed_error(name, function, allowed)


def functions_of(tables: Mapping[str, Any]) -> dict[str, str]:
    """Return the functions that a job names, by quantity name. Raises `JobError` for an invalid function name."""
    from ...objectives.own.quantity import FUNCTION

    parts, functions = tables.get("quantity", {}), {}
    write = 'write it like { function = "mymodule:myfunction" }'
    if not isinstance(parts, Mapping):
        raise JobError(f"quantity: must be a table of tables, each with a function; got {quote(parts)}; leave it out")
    for name, part in parts.items():
        if not isinstance(part, Mapping):
            raise JobError(f"quantity.{name[:60]}: must be a table of keys; got {quote(part)}; {write}")
        if "formula" in part and "function" not in part:
            continue  # runs nothing
        function = part.get("function")
        if not (isinstance(function, str) and FUNCTION.fullmatch(function)):
            value_text = f"got {quote(function)}" if "function" in part else "it is missing"
            raise JobError(
                f"quantity.{name[:60]}.function: must name a module and a function in it; {value_text}; {write}"
            )
        functions[name] = function
    return functions


def _function_not_allowed_error(name: str, function: str, allowed: Collection[str]) -> JobError:

    remedy = f"choose from {', '.join(sorted(allowed))}, have it allowed" if allowed else "have it allowed"
    return JobError(
        f"quantity.{name[:60]}: only functions that the operator allows may run here; got {quote(function)}; {remedy} "
        f"(serve, worker or mcp with --allow-quantity {function[:200]}), or solve the job with `slidercrank optimise`"
    )


def with_time_limit_per_call(problem: Problem, seconds: float) -> Problem:
    """Return a problem with a time limit per call, s, for its custom functions."""
    from ...objectives.own.quantity import with_time_limit

    return (
        replace(problem, own=tuple(with_time_limit(quantity, seconds) for quantity in problem.own))
        if problem.own
        else problem
    )


@contextlib.contextmanager
def end_custom_processes_on_exit(problem: Problem, engine: Engine | None = None) -> Iterator[None]:
    """End the custom function processes of a problem on exit: otherwise they run until the problem is freed.

    engine: engine that may also have called them; its processes end too, and new ones start when needed.
    """
    from ...objectives.own.quantity import close_custom_functions, runs_custom_function

    try:
        yield
    finally:
        for quantity in problem.own:
            close_custom_functions(quantity)
        if engine is not None and any(map(runs_custom_function, problem.own)):
            engine.close()


def submit(
    store: Store,
    tables: Mapping[str, Any],
    *,
    limits: Limits = NO_LIMITS,
    source: Artefact | None = None,
    allowed_quantities: Collection[str] = (),
    **queueing: Unpack[Queueing],
) -> Job:
    """Queue a job given as the tables of a job file, and return it; see `Store.submit` for other arguments.

    source: original job file, "job.toml" or "job.json"; by default it is written from the tables. allowed_quantities:
    functions, "module:function", that the job may use as custom quantities.

    Raises `JobError` for an invalid job, or one that names functions that are not allowed.
    """
    return store.submit(
        tables,
        name=parse_with_allowed_functions(tables, allowed_quantities).name,
        limits=limits,
        files=[source or job_json(tables)],
        **queueing,
    )


def job_json(tables: Mapping[str, Any]) -> Artefact:
    """Return the file "job.json" for a job given by its tables."""
    return Artefact(name="job.json", media_type="application/json", content=json_text(tables).encode())
