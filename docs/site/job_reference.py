"""Reference for job files as Markdown, from their JSON schema: each table in a job, with an example."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

from docs.site.schema_tables import Schema, cell, described, kind, meaning
from slidercrank.optimise.job import job_schema


def job_reference() -> str:
    """Return the page: the tables in a job, then their parts."""
    schema = job_schema()
    shapes, required = schema["$defs"], schema["required"]
    titles = headings(schema)
    lines = [
        "# Job file\n",
        "Every table and key of a job file, from the schema that `slidercrank schema` prints. "
        "[Job files](../jobs.md) explains them with examples. A quantity is a number with its unit in a string, or a "
        "plain number in SI.\n",
        "| table or key | value | meaning | |\n|---|---|---|---|",
    ]
    for name, field in schema["properties"].items():
        lines.append(
            f"| `{name}` | {cell(kind(field, titles))} | {cell(meaning(field))} "
            f"| {'required' if name in required else ''} |"
        )
    lines.append("\n## Tables and their parts\n")
    examples = dict(_examples(schema))
    for name, title in titles.items():
        lines.append(f"### {title.replace('`', '')} {{#{name.lower()}}}\n")
        if name in examples:
            lines.append(f"```toml\n{examples[name]}```\n")
        lines += described(shapes[name], titles)
    return "\n".join(lines)


def headings(schema: Schema) -> dict[str, str]:
    """Return a heading for each named shape: its place in a job, in job order, with bounds and targets last."""
    places: dict[str, list[str]] = {}
    for path, ref in _places(schema):
        places.setdefault(ref, []).append(path)
    found, limits = {}, {}
    for ref in dict.fromkeys((*places, *schema["$defs"])):
        shape, paths = schema["$defs"][ref], places.get(ref, [])
        if limit := re.fullmatch(r"(\w+)(Bounds|Target)", ref):
            limits[ref] = f"{limit[2]}: {re.sub(r'(?<!^)(?=[A-Z])', ' ', limit[1]).lower()}"
            continue
        table = paths[0].partition(" ")[0]
        title = ", ".join([paths[0], *(path.removeprefix(table).strip() for path in paths[1:])])
        alike = [other for other, others in places.items() if others[0] == paths[0]]
        first = shape.get("x-load", {}).get("key") or next(
            iter(shape.get("required") or shape.get("properties", ())), ""
        )
        found[ref] = f"`{title}` with `{first}`" if len(alike) > 1 and first else f"`{title}`"
    return found | limits


def _examples(schema: Schema) -> Iterator[tuple[str, str]]:
    """Yield the name of each top-level table shape that has an example, and the example as TOML."""
    for name, field in schema["properties"].items():
        references = list(dict.fromkeys(_references(field)))
        for ref in references:
            shape = schema["$defs"][ref]
            keys = shape.get("required") or list(shape.get("properties", ()))[:1]
            required = {key: shape["properties"][key].get("examples", [None])[0] for key in keys}
            required |= shape.get("x-load", {}).get("first", {})
            example = next(iter(field.get("examples", ())), None) if len(references) == 1 else required
            example = example[0] if isinstance(example, list) else example
            if name != "quantity" and isinstance(example, Mapping) and None not in example.values():
                yield ref, _toml(_head(name, field), example)


def _places(schema: Schema) -> Iterator[tuple[str, str]]:
    """Yield the place of each named shape in a job, and its name; top-level tables first, then their contents."""
    queue = [
        (_head(name, field), ref)
        for name, field in schema["properties"].items()
        for ref in dict.fromkeys(_references(field))
    ]
    seen = set()
    for path, ref in queue:
        yield path, ref
        if ref not in seen:
            seen.add(ref)
            for key, field in schema["$defs"][ref].get("properties", {}).items():
                queue += [(f"{path} {key}", inner) for inner in dict.fromkeys(_references(field))]


def _head(name: str, field: Schema) -> str:
    return f"[[{name}]]" if field.get("type") == "array" else f"[{name}]"


def _references(field: Any) -> Iterator[str]:
    """Yield the names of the shapes that a field may have."""
    if isinstance(field, Mapping):
        if "$ref" in field:
            yield field["$ref"].rsplit("/", 1)[1]
        for key in ("anyOf", "oneOf", "allOf", "items", "additionalProperties"):
            yield from _references(field.get(key))
    elif isinstance(field, list):
        for part in field:
            yield from _references(part)


def _toml(head: str, example: Mapping[str, Any]) -> str:
    """Return a table as TOML."""
    return "".join([f"{head}\n", *(f"{key} = {_value(value)}\n" for key, value in example.items())])


def _value(value: Any) -> str:
    """Return a value as TOML."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_value(inner)}' for key, inner in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return json.dumps(value, ensure_ascii=False)
