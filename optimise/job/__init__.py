"""Job files: what an engineer states, read, checked and turned into a `Problem`.

`load_job` reads a file (TOML or JSON), `parse_job` the same as a dict, `job_schema` describes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ...model.errors import InputError, JobError
from ..problem import Problem
from ..units import shown
from .file import read, require_plain
from .messages import LONGEST, MOST, explain
from .model import Job
from .varying import with_values

__all__ = ["Job", "job_schema", "load_job", "parse_job"]


def load_job(path: str | PathLike[str], values: Mapping[str, Any] | None = None) -> Problem:
    """Return the problem that a job file states, .toml or .json.

    values: numbers to put in place of those that the file gives, by their paths ("mechanism.slider.mass").
    Raises JobError, naming file, key, rule, value and remedy, for a file that cannot be read, does not follow the
    schema, or contradicts itself.
    """
    try:
        return parse_job(read(Path(path)), values)
    except JobError as error:
        name = str(path)
        raise JobError(f"{name if name.isprintable() else shown(name)}: {error}") from None


def parse_job(data: Mapping[str, Any], values: Mapping[str, Any] | None = None) -> Problem:
    """Return the problem that a job states, given as the tables of a job file. Raises JobError like `load_job`."""
    require_plain(data)
    try:
        job = Job.model_validate(data)
        return (with_values(job, values, "values") if values else job).problem()
    except ValidationError as error:
        found = explain(error, _schema())
        count = f"{len(found)} problems" if len(found) < LONGEST else "very many problems"
        heading = [count] if len(found) > 1 else []
        more = ["... and more"] if len(found) > MOST else []
        raise JobError("\n  ".join([*heading, *found[:MOST], *more])) from None
    except JobError:
        raise
    except InputError as error:
        raise JobError(str(error)) from None


def job_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a job, with a description and examples for every key."""
    return deepcopy(_schema())


@cache
def _schema() -> dict[str, Any]:
    schema = Job.model_json_schema(mode="validation")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_without_null(schema)}


def _without_null(node: Any) -> Any:
    """Return a schema without its nulls: a key that is not wanted is left out."""
    if isinstance(node, list):
        return [_without_null(item) for item in node]
    if not isinstance(node, dict):
        return node
    kept = {key: _without_null(item) for key, item in node.items()}
    if kept.get("default", 0) is None or isinstance(kept.get("default"), dict):
        del kept["default"]
    choices = [choice for choice in kept.get("anyOf", ()) if choice != {"type": "null"}]
    if len(choices) == 1 and len(kept["anyOf"]) == 2:
        del kept["anyOf"]
        return {**choices[0], **kept}
    return {**kept, "anyOf": choices} if choices else kept
