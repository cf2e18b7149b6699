"""Tables of the fields in a JSON schema, as Markdown."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

Schema = Mapping[str, Any]
Titles = Mapping[str, str]
"""Headings of named schemas; a schema without an entry has its name as heading."""
_LONGEST = 80  # characters of an example


def definitions(shapes: Mapping[str, Schema], level: int) -> Iterator[str]:
    """Yield a section for each named schema, with its fields."""
    for name in sorted(shapes):
        yield f"{'#' * level} {name}\n"
        yield from described(shapes[name])


def described(schema: Schema, titles: Titles = MappingProxyType({})) -> Iterator[str]:
    """Yield the description of a schema and the table of its fields."""
    if schema.get("description"):
        yield f"{schema['description'].strip()}\n"
    fields: Mapping[str, Schema] = schema.get("properties", {})
    if not fields:
        yield f"{kind(schema, titles)}\n"
        return
    required = schema.get("required", ())
    yield "| key | value | meaning | default |\n|---|---|---|---|"
    for name, field in fields.items():
        default = "required" if name in required else f"`{json.dumps(field['default'])}`" if "default" in field else ""
        yield f"| `{name}` | {cell(kind(field, titles))} | {cell(meaning(field))} | {cell(default)} |"
    yield ""


def meaning(field: Schema) -> str:
    """Return the description of a field with its first example, unless that is long."""
    said = str(field.get("description", ""))
    example = json.dumps(next(iter(field.get("examples", ())), None), ensure_ascii=False)
    if example == "null" or len(example) > _LONGEST:
        return said
    return f"{said}; such as `{example}`".removeprefix("; ")


def kind(schema: Schema, titles: Titles = MappingProxyType({})) -> str:
    """Return in words which values a schema accepts."""
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[1]
        return f"[{titles.get(name, name)}](#{name.lower()})"
    for key in ("anyOf", "oneOf"):
        if key in schema:
            return " or ".join(dict.fromkeys(kind(part, titles) for part in schema[key]))
    if "allOf" in schema:
        return " and ".join(kind(part, titles) for part in schema["allOf"])
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(value)}`" for value in schema["enum"])
    found = schema.get("type", "anything")
    if found == "array":
        return f"list of {kind(schema.get('items', {}), titles)}"
    if found == "object" and isinstance(schema.get("additionalProperties"), Mapping):
        return f"table of {kind(schema['additionalProperties'], titles)}"
    if found == "string" and "pattern" in schema:
        return "text" if "\\d" not in schema["pattern"] else "number with unit"
    words = {"string": "text", "boolean": "true or false", "integer": "whole number", "object": "table"}
    return words.get(found, found) if isinstance(found, str) else " or ".join(found)


def cell(text: str) -> str:
    """Return text for a table cell."""
    return " ".join(text.split()).replace("|", "\\|")
