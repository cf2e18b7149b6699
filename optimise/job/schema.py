"""JSON Schema (draft 2020-12) of a job."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from pydantic import BaseModel


@lru_cache(maxsize=16)
def schema_of(job: type[BaseModel]) -> dict[str, Any]:
    """Return the JSON Schema of a job, without nulls; do not change it, because it is cached."""
    schema = job.model_json_schema(mode="validation")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_without_null(schema)}


def _without_null(node: Any) -> Any:
    """Return a schema without nulls, because optional keys are omitted instead."""
    if isinstance(node, list):
        return [_without_null(item) for item in node]
    if not isinstance(node, dict):
        return node
    entries = {key: _without_null(item) for key, item in node.items()}
    if entries.get("default", 0) is None or isinstance(entries.get("default"), dict):
        del entries["default"]
    choices = [choice for choice in entries.get("anyOf", ()) if choice != {"type": "null"}]
    if len(choices) == 1 and len(entries["anyOf"]) == 2:
        del entries["anyOf"]
        return {**choices[0], **entries}
    return {**entries, "anyOf": choices} if choices else entries
